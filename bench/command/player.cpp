#include "bench/command/player.hpp"

#include <fmt/core.h>
#include <samplerate.h>
#include <sndfile.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <numbers>
#include <stdexcept>

#include "analysis/convolution.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/trace_file.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::command {

namespace {
constexpr double longest = 10;  // [s]
// Rows of silence at both ends: the resampler rings ahead of a response that starts abruptly.
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

struct RadiatingEnd {  // end at which strings pull on a body
    Quantity force;
    const char* key;  // scene file key
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

namespace {
// [Hz]; players accept whole numbers in this range.
constexpr double slowest_played = 3000, fastest_played = 384000;
// Limit by the 32-bit byte count in a .wav file.
constexpr double most_bytes = 4e9;
constexpr double steady = 20;              // [Hz]
constexpr double de_emphasis = 50e-6;      // [s]
constexpr double peak_of_full_scale = -1;  // [dB]

double decibels(double ratio) { return 20 * std::log10(ratio); }

bool is_driven(const Scene& scene) {
    return std::any_of(scene.strings.begin(), scene.strings.end(),
                       [](const String& s) { return !lacks(s, Quantity::driving_force); });
}
}  // namespace

bool is_audio(const std::filesystem::path& path) { return path.extension() == ".wav"; }

Scene audible(Scene scene) {
    const Tap bridge{"bridge", Quantity::driving_force, {}, 0},
        nut{"nut", Quantity::nut_force, {}, 0};
    scene.taps.clear();
    if (scene.body && !scene.body->bridge.empty() && is_driven(scene)) scene.taps.push_back(bridge);
    if (scene.body && !scene.body->nut.empty()) scene.taps.push_back(nut);
    if (!scene.taps.empty()) return scene;
    // Unfilters the scene: its only response, if any, belongs to a bridge that no string touches.
    scene = unfiltered(std::move(scene));
    scene.taps = {is_driven(scene) ? bridge : nut};
    return scene;
}

Player::Player(std::filesystem::path path, const Scene& scene, double tap_rate)
    : path_(std::move(path)) {
    const std::string out = "--out " + path_.string();
    if (tap_rate != std::round(tap_rate) || tap_rate < slowest_played || tap_rate > fastest_played)
        throw store::UsageError(
            fmt::format("{}: players take a whole number of rows per second from {} to {}, not {}: "
                        "say --tap-rate",
                        out, slowest_played, fastest_played, tap_rate));
    const double bytes = scene.duration * tap_rate * static_cast<double>(scene.taps.size()) * 3;
    if (bytes > most_bytes)
        throw store::UsageError(fmt::format(
            "{}: a .wav holds at most {:.0e} bytes, this would be {:.1e}. A .csv holds them", out,
            most_bytes, bytes));
    body_ = body_responses(scene, tap_rate);
    store::must_be_writable(path_);
}

std::vector<double> without_steady(std::span<const double> force, double rate) {
    const double keep = std::exp(-2 * std::numbers::pi * steady / rate);
    std::vector<double> out;
    double moving = 0;
    for (std::size_t n = 0; n < force.size(); ++n)
        out.push_back(moving = keep * (moving + (n > 0 ? force[n] - force[n - 1] : 0)));
    return out;
}

std::vector<double> without_body(std::span<const double> force, double rate) {
    const double low = std::exp(-1 / (de_emphasis * rate));
    std::vector<double> out = without_steady(force, rate);
    double low_passed = 0;
    for (double& v : out) v = low_passed = low * low_passed + (1 - low) * v;
    return out;
}

Played levelled(std::vector<std::vector<double>> channels) {
    Played p{std::move(channels)};
    long samples = 0;
    for (const auto& channel : p.channels)
        for (const double v : channel)
            p.peak = std::isfinite(v) ? std::max(p.peak, std::abs(v)) : HUGE_VAL;
    if (!(p.peak > 0) || std::isinf(p.peak)) {
        for (auto& channel : p.channels) std::ranges::fill(channel, 0.0);
        return {std::move(p.channels)};
    }
    p.full_scale = p.peak / std::pow(10, peak_of_full_scale / 20);
    p.peak = 0;
    for (auto& channel : p.channels)
        for (double& v : channel) {
            v /= p.full_scale;
            p.peak = std::max(p.peak, std::abs(v));
            p.rms += v * v;
            p.clipped += std::abs(v) > 1;
            ++samples;
        }
    p.rms = std::sqrt(p.rms / static_cast<double>(samples));
    return p;
}

std::string level_text(const Played& p) {
    if (!(p.full_scale > 0)) return "silence";
    return fmt::format("full scale {:.3g} N, peak {:.1f} dB, rms {:.1f} dB, {} samples clipped",
                       p.full_scale, decibels(p.peak), decibels(p.rms), p.clipped);
}

namespace {
void write_frames(const std::filesystem::path& path, double rate,
                  const std::vector<std::vector<double>>& channels) {
    SF_INFO info{};
    info.samplerate = static_cast<int>(std::lround(rate));
    info.channels = static_cast<int>(channels.size());
    info.format = SF_FORMAT_WAV | SF_FORMAT_PCM_24;
    SNDFILE* file = sf_open(path.c_str(), SFM_WRITE, &info);
    if (!file) throw std::runtime_error(sf_strerror(nullptr));
    sf_command(file, SFC_SET_CLIPPING, nullptr, SF_TRUE);
    // the chunk would contain the time of writing
    sf_command(file, SFC_SET_ADD_PEAK_CHUNK, nullptr, SF_FALSE);
    const std::size_t rows = channels.front().size();
    std::vector<double> frames;
    for (std::size_t n = 0; n < rows; ++n)
        for (const auto& channel : channels) frames.push_back(channel[n]);
    errno = 0;
    const bool good = sf_writef_double(file, frames.data(), static_cast<sf_count_t>(rows)) ==
                      static_cast<sf_count_t>(rows);
    const int reason = errno;
    if (sf_close(file) != 0 || !good) {
        const int why = good ? errno : reason;
        throw std::runtime_error(why != 0 ? std::strerror(why) : "libsndfile refuses");
    }
}
}  // namespace

void write_audio(const std::filesystem::path& path, double rate,
                 const std::vector<std::vector<double>>& channels) {
    store::FreshFile fresh(path);
    try {
        write_frames(fresh.path(), rate, channels);
    } catch (const std::runtime_error& why) {
        throw store::Unwritable(fmt::format("cannot write {}: {}", path.string(), why.what()));
    }
    fresh.keep();
}

std::string Player::write(const Trace& trace) const {
    std::vector<std::vector<double>> channels;
    if (body_.empty()) channels.push_back(without_body(trace.column(0), trace.tap_rate));
    for (std::size_t k = 0; k < body_.size(); ++k)
        channels.push_back(
            convolved(without_steady(trace.column(static_cast<int>(k)), trace.tap_rate), body_[k]));
    const Played p = levelled(std::move(channels));
    write_audio(path_, trace.tap_rate, p.channels);
    return level_text(p);
}

}  // namespace jvari::bench::command
