#include "bench/store/audio_file.hpp"

#include <fmt/core.h>
#include <sndfile.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <numbers>
#include <stdexcept>

namespace jvari::bench::store {

namespace {
constexpr double steady = 20;              // [Hz]
constexpr double de_emphasis = 50e-6;      // [s]
constexpr double peak_of_full_scale = -1;  // [dB]

double decibels(double ratio) {
    return 20 * std::log10(ratio);
}
}  // namespace

bool is_audio(const std::filesystem::path& path) {
    return path.extension() == ".wav" || path.extension() == ".flac";
}

Scene audible(Scene scene) {
    const bool driven =
        std::any_of(scene.strings.begin(), scene.strings.end(), [](const String& s) { return !lacks(s, Quantity::driving_force); });
    scene.taps = {{"heard", driven ? Quantity::driving_force : Quantity::nut_force, {}, 0}};
    return scene;
}

Played played(std::span<const double> force, double rate) {
    const double keep = std::exp(-2 * std::numbers::pi * steady / rate), low = std::exp(-1 / (de_emphasis * rate));
    Played p;
    double moving = 0, heard = 0;
    for (std::size_t n = 0; n < force.size(); ++n) {
        moving = keep * (moving + (n > 0 ? force[n] - force[n - 1] : 0));
        heard = low * heard + (1 - low) * moving;
        p.samples.push_back(heard);
        p.peak = std::max(p.peak, std::abs(heard));
    }
    if (!(p.peak > 0) || !std::isfinite(p.peak)) return {std::vector<double>(force.size(), 0.0)};
    p.full_scale = p.peak / std::pow(10, peak_of_full_scale / 20);
    p.peak = 0;
    for (double& v : p.samples) {
        v /= p.full_scale;
        p.peak = std::max(p.peak, std::abs(v));
        p.rms += v * v;
        p.clipped += std::abs(v) > 1;
    }
    p.rms = std::sqrt(p.rms / static_cast<double>(p.samples.size()));
    return p;
}

std::string level_text(const Played& p) {
    if (!(p.full_scale > 0)) return "silence";
    return fmt::format("full scale {:.3g} N, peak {:.1f} dB, rms {:.1f} dB, {} samples clipped", p.full_scale, decibels(p.peak),
                       decibels(p.rms), p.clipped);
}

void write_audio(const std::filesystem::path& path, const std::string& extension, int bits, double rate, const Played& p) {
    SF_INFO info{};
    info.samplerate = static_cast<int>(std::lround(rate));
    info.channels = 1;
    info.format = (extension == ".flac" ? SF_FORMAT_FLAC : SF_FORMAT_WAV) | (bits == 16 ? SF_FORMAT_PCM_16 : SF_FORMAT_PCM_24);
    SNDFILE* file = sf_open(path.c_str(), SFM_WRITE, &info);
    if (!file) throw std::runtime_error(sf_strerror(nullptr));
    sf_command(file, SFC_SET_CLIPPING, nullptr, SF_TRUE);
    const auto count = static_cast<sf_count_t>(p.samples.size());
    errno = 0;
    const bool good = sf_writef_double(file, p.samples.data(), count) == count;
    const int reason = errno;
    if (sf_close(file) != 0 || !good) {
        const int why = good ? errno : reason;
        throw std::runtime_error(why != 0 ? std::strerror(why) : "libsndfile refuses");
    }
}

}  // namespace jvari::bench::store
