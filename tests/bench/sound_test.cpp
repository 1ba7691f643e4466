// Sounds: what is kept of a trace, what of it is heard, and base64 by the words of RFC 4648.
#include "bench/store/trace_file.hpp"

#include <gtest/gtest.h>
#include <sndfile.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "bench/command/player.hpp"
#include "bench/store/encoding.hpp"
#include "tests/c3.hpp"
#include "tests/says.hpp"

namespace jvari {
namespace {

std::vector<double> sine(double amplitude, double offset, int count) {
    std::vector<double> signal;
    for (int n = 0; n < count; ++n)
        signal.push_back(offset + amplitude * std::sin(2 * M_PI * 441.0 * n / 44100));
    return signal;
}

bench::command::Played played(const std::vector<double>& force, double rate) {
    return bench::command::levelled({bench::command::without_body(force, rate)});
}

// ---- What a player plays

double gain_at(double hertz) {  // of what is played, at 44.1 kHz
    std::vector<double> force;
    for (int n = 0; n < 44100; ++n) force.push_back(3 * std::sin(2 * M_PI * hertz * n / 44100));
    const bench::command::Played p = played(force, 44100);
    double most = 0;
    for (int n = 22050; n < 44100; ++n) most = std::max(most, std::abs(p.channels[0][n]));
    return 20 * std::log10(most * p.full_scale / 3);  // [dB]
}

TEST(Played, TakesTheSteadyPartAwayAndLowersTheHighs) {
    EXPECT_NEAR(gain_at(20), 10 * std::log10(0.5), 0.1);
    EXPECT_NEAR(gain_at(3183), 10 * std::log10(0.5), 0.2);  // 1/(2 pi 50 us)
    EXPECT_NEAR(gain_at(300), -0.06, 0.03);
    EXPECT_LT(gain_at(15000), -10);
    const bench::command::Played still = played(std::vector<double>(1000, 5.0), 44100);
    EXPECT_EQ(bench::command::level_text(still), "silence");
    EXPECT_EQ(still.channels[0], std::vector<double>(1000, 0.0));
    // on a steady 100 N, which is there from the start
    const bench::command::Played beside = played(sine(1, 100, 44100), 44100);
    EXPECT_NEAR(beside.full_scale, played(sine(1, 0, 44100), 44100).full_scale, 1e-9);
}

TEST(Played, StandsOneDecibelBelowFullScaleWhateverItsForce) {
    const bench::command::Played p = played(sine(1, 0, 4410), 44100),
                                 loud = played(sine(1e3, 0, 4410), 44100);
    EXPECT_NEAR(p.peak, std::pow(10, -1 / 20.0), 1e-15);
    EXPECT_NEAR(p.rms * p.full_scale, std::sqrt(0.5), 0.02);
    EXPECT_EQ(p.clipped, 0);
    EXPECT_NEAR(loud.full_scale, 1e3 * p.full_scale, 1e-9);
    for (std::size_t n = 0; n < p.channels[0].size(); ++n)
        ASSERT_NEAR(loud.channels[0][n], p.channels[0][n], 1e-12);
    bench::command::Played over = p;
    over.clipped = 3;
    EXPECT_TRUE(says(bench::command::level_text(over), "3 samples clipped"));
}

TEST(Played, ReadsBackToTheLastBit) {
    const bench::command::Played p = played(sine(1, 0, 4410), 48000);
    const auto folder =
        std::filesystem::temp_directory_path() / ("jvari-played-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    const auto path = folder / "x.wav";
    bench::command::write_audio(path, 48000, p.channels);
    SF_INFO info{};
    SNDFILE* file = sf_open(path.c_str(), SFM_READ, &info);
    ASSERT_TRUE(file);
    EXPECT_EQ(info.samplerate, 48000);
    EXPECT_EQ(info.channels, 1);
    EXPECT_EQ(info.format & SF_FORMAT_SUBMASK, SF_FORMAT_PCM_24);
    std::vector<double> back(5000);
    EXPECT_EQ(sf_readf_double(file, back.data(), 5000), 4410);
    sf_close(file);
    for (int n = 0; n < 4410; ++n) ASSERT_NEAR(back[n], p.channels[0][n], std::exp2(-23));
    std::filesystem::remove_all(folder);
}

TEST(Played, IsTheDrivingForceWhereSomethingIsDrivenElseTheForceOnTheNut) {
    EXPECT_EQ(bench::command::audible(c3_pluck()).taps.at(0).quantity, Quantity::driving_force);
    EXPECT_EQ(bench::command::audible(c3_free()).taps.at(0).quantity, Quantity::nut_force);
    EXPECT_EQ(bench::command::audible(c3_pluck()).taps.size(), 1u);
    EXPECT_FALSE(bench::command::audible(c3_pluck()).taps.at(0).string);
}

TEST(Base64, IsThatOfTheStandard) {  // RFC 4648, section 10
    const std::pair<const char*, const char*> vectors[] = {{"", ""},
                                                           {"f", "Zg=="},
                                                           {"fo", "Zm8="},
                                                           {"foo", "Zm9v"},
                                                           {"foob", "Zm9vYg=="},
                                                           {"fooba", "Zm9vYmE="},
                                                           {"foobar", "Zm9vYmFy"}};
    for (const auto& [bytes, text] : vectors) {
        EXPECT_EQ(bench::store::base64(bytes), text);
        EXPECT_EQ(bench::store::bytes_of_base64(text), bytes);
    }
    std::string all;
    for (int k = 0; k < 256; ++k) all += static_cast<char>(k);
    EXPECT_EQ(bench::store::bytes_of_base64(bench::store::base64(all)), all);
    EXPECT_THROW(bench::store::bytes_of_base64("abc"), std::runtime_error);
    EXPECT_THROW(bench::store::bytes_of_base64("ab!d"), std::runtime_error);
    // it ends at its padding
    EXPECT_THROW(bench::store::bytes_of_base64("Zg==Zg=="), std::runtime_error);
}

TEST(Sounds, APeakAndSixteenBitsGiveTheSignalBack) {
    const auto signal = sine(3e-4, 1e-4, 4410);
    const bench::store::Sound s = bench::store::sound_of(signal, 44100);
    ASSERT_EQ(s.samples.size(), signal.size());
    for (std::size_t n = 0; n < signal.size(); ++n)
        EXPECT_NEAR(s.samples[n] * s.peak / 32767, signal[n], 0.51 * s.peak / 32767);
}

TEST(Sounds, WhatCannotBeHeardIsNone) {
    EXPECT_TRUE(bench::store::sound_of(std::vector<double>{0, 0, 0}, 44100).samples.empty());
    EXPECT_TRUE(bench::store::sound_of(std::vector<double>{0, 1, NAN}, 44100).samples.empty());
    EXPECT_TRUE(bench::store::sound_of(std::vector<double>{0, 1, HUGE_VAL}, 44100).samples.empty());
    EXPECT_TRUE(bench::store::sound_of(std::vector<double>{0, 1, 2}, 44100.5).samples.empty());
}

TEST(Sounds, AFileGivesItsSamplesBack) {
    const bench::store::Sound s = bench::store::sound_of(sine(1, 0, 1000), 48000);
    const std::string wav = bench::store::wav_of(s);
    EXPECT_EQ(wav.substr(0, 4), "RIFF");
    EXPECT_EQ(wav.size(), 44u + 2000u);
    std::string name = (std::filesystem::temp_directory_path() / "jvari-sound-XXXXXX").string();
    close(mkstemp(name.data()));
    std::ofstream(name, std::ios::binary) << wav;
    const bench::store::Sound back = bench::store::read_wav(name, s.peak);
    std::filesystem::remove(name);
    EXPECT_EQ(back.samples, s.samples);
    EXPECT_EQ(back.rate, 48000);
}

}  // namespace
}  // namespace jvari
