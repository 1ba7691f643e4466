#include "bench/sound/radiation.hpp"

#include <fmt/core.h>
#include <samplerate.h>

#include <cmath>
#include <stdexcept>

#include "analysis/convolution.hpp"
#include "bench/store/sound.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::sound {

namespace {
constexpr double longest = 10;  // [s]
constexpr int margin = 64;      // rows of silence at both ends, for what the resampler rings ahead of a response that begins at once

std::vector<float> resampled(std::vector<float> x, double ratio) {
    x.insert(x.begin(), margin, 0.0f);
    x.insert(x.end(), margin, 0.0f);
    std::vector<float> y(static_cast<std::size_t>(std::ceil(static_cast<double>(x.size()) * ratio)) + 1);
    SRC_DATA data{};
    data.data_in = x.data();
    data.data_out = y.data();
    data.input_frames = static_cast<long>(x.size());
    data.output_frames = static_cast<long>(y.size());
    data.src_ratio = ratio;
    if (const int error = src_simple(&data, SRC_SINC_BEST_QUALITY, 1); error != 0) throw std::runtime_error(src_strerror(error));
    y.resize(static_cast<std::size_t>(data.output_frames_gen));
    return y;
}

struct RadiatingEnd {  // where strings pull at a body
    Quantity force;
    const char* key;  // of a scene
    std::string Body::*response;
};
constexpr RadiatingEnd ends[] = {{Quantity::driving_force, "body.bridge", &Body::bridge}, {Quantity::nut_force, "body.nut", &Body::nut}};

Radiation radiation_of(const Body& body, const RadiatingEnd& end, double rate) {
    std::vector<double> response = impulse_response(body.*end.response, rate, end.key);
    try {
        return {std::move(response), rate, body.sections};
    } catch (const std::invalid_argument& e) {
        throw store::UsageError(fmt::format("body.sections: found {} for {}; {}", body.sections, end.key, e.what()));
    }
}
}  // namespace

std::vector<double> impulse_response(const std::string& file, double rate, const std::string& key) {
    const auto refuse = [&](const std::string& why) {
        throw store::UsageError(
            fmt::format("{}: found \"{}\", {}; expected a .wav or .flac of one channel and at most {:g} s", key, file, why, longest));
    };
    const store::Signal sound = store::read_signal(file, refuse);
    if (sound.samples.empty()) refuse("which is empty");
    if (static_cast<double>(sound.samples.size()) > longest * sound.rate) refuse("which is longer");
    std::vector<float> samples(sound.samples.begin(), sound.samples.end());
    const double ratio = rate / sound.rate;
    if (ratio != 1) {
        if (!src_is_valid_ratio(ratio)) refuse(fmt::format("whose {} Hz cannot become {:g} Hz", sound.rate, rate));
        samples = resampled(samples, ratio);
    }
    std::vector<double> response;
    for (const float v : samples) {
        if (!std::isfinite(v)) refuse("which holds a value that is not finite");
        response.push_back(v / ratio);
    }
    return response;
}

Radiation::Radiation(std::vector<double> response, double rate, int sections) : response_(std::move(response)) {
    if (sections == 0) return;
    sections_ = resonators_for(response_, rate, sections);
    misfit_ = misfit_db(*sections_, response_);
}

std::vector<double> Radiation::operator()(std::span<const double> force) const {
    return sections_ ? filtered(*sections_, force) : convolved(force, response_);
}

std::vector<RadiatingTap> radiating_taps(const Scene& scene, double rate) {
    std::vector<RadiatingTap> all;
    for (std::size_t k = 0; scene.body && k < scene.taps.size(); ++k) {
        const Tap& tap = scene.taps[k];
        if (tap.string && scene.strings.size() > 1) continue;
        for (const RadiatingEnd& end : ends)
            if (tap.quantity == end.force && !((*scene.body).*end.response).empty())
                all.push_back({static_cast<int>(k), radiation_of(*scene.body, end, rate)});
    }
    return all;
}

}  // namespace jvari::bench::sound
