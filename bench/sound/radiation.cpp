#include "bench/sound/radiation.hpp"

#include <fmt/core.h>
#include <samplerate.h>

#include <cmath>
#include <stdexcept>

#include "bench/store/sound.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::sound {

namespace {
constexpr double longest = 10;  // [s]
// rows of silence at both ends, for what the resampler rings ahead of a response that begins at
// once
constexpr int margin = 64;

std::vector<float> resampled(std::vector<float> x, double ratio) {
    x.insert(x.begin(), margin, 0.0f);
    x.insert(x.end(), margin, 0.0f);
    std::vector<float> y(
        static_cast<std::size_t>(std::ceil(static_cast<double>(x.size()) * ratio)) + 1);
    SRC_DATA data{};
    data.data_in = x.data();
    data.data_out = y.data();
    data.input_frames = static_cast<long>(x.size());
    data.output_frames = static_cast<long>(y.size());
    data.src_ratio = ratio;
    if (const int error = src_simple(&data, SRC_SINC_BEST_QUALITY, 1); error != 0)
        throw std::runtime_error(src_strerror(error));
    y.resize(static_cast<std::size_t>(data.output_frames_gen));
    return y;
}

struct RadiatingEnd {  // where strings pull at a body
    Quantity force;
    const char* key;  // of a scene
    std::string Body::*response;
};
constexpr RadiatingEnd ends[] = {{Quantity::driving_force, "body.bridge", &Body::bridge},
                                 {Quantity::nut_force, "body.nut", &Body::nut}};
}  // namespace

std::vector<double> impulse_response(const std::string& file, double rate, const std::string& key) {
    const auto refuse = [&](const std::string& why) {
        throw store::UsageError(
            fmt::format("{}: found \"{}\", {}; expected a .wav of one channel and at most {:g} s",
                        key, file, why, longest));
    };
    const store::Signal sound = store::read_signal(file, refuse);
    if (sound.samples.empty()) refuse("which is empty");
    if (static_cast<double>(sound.samples.size()) > longest * sound.rate) refuse("which is longer");
    std::vector<float> samples(sound.samples.begin(), sound.samples.end());
    const double ratio = rate / sound.rate;
    if (ratio != 1) {
        if (!src_is_valid_ratio(ratio))
            refuse(fmt::format("whose {} Hz cannot become {:g} Hz", sound.rate, rate));
        samples = resampled(samples, ratio);
    }
    std::vector<double> response;
    for (const float v : samples) {
        if (!std::isfinite(v)) refuse("which holds a value that is not finite");
        response.push_back(v / ratio);
    }
    return response;
}

std::vector<std::vector<double>> body_responses(const Scene& scene, double rate) {
    std::vector<std::vector<double>> all;
    for (const Tap& tap : scene.taps) {
        if (!scene.body || (tap.string && scene.strings.size() > 1)) continue;
        for (const RadiatingEnd& end : ends)
            if (tap.quantity == end.force && !((*scene.body).*end.response).empty())
                all.push_back(impulse_response((*scene.body).*end.response, rate, end.key));
    }
    return all;
}

}  // namespace jvari::bench::sound
