// The body, one way: what is read of its responses, what they make of a force, and the made-up pair
// of the library.
#include <gtest/gtest.h>
#include <sndfile.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "bench/command/player.hpp"
#include "bench/store/usage.hpp"
#include "scenes/scene_file.hpp"
#include "tests/c3.hpp"
#include "tests/says.hpp"
#include "tests/synthetic_body.hpp"

namespace jvari {
namespace {

namespace fs = std::filesystem;
using namespace bench::command;
using namespace synthetic;

struct Folder {
    Folder() { fs::create_directories(path); }
    ~Folder() { fs::remove_all(path); }
    std::string operator/(const char* name) const { return (path / name).string(); }
    const fs::path path = fs::temp_directory_path() / ("jvari-body-" + std::to_string(getpid()));
};

double gain_at(const std::vector<double>& response, double hertz, double rate) {
    double re = 0, im = 0;
    for (std::size_t n = 0; n < response.size(); ++n) {
        re += response[n] * std::cos(2 * M_PI * hertz * static_cast<double>(n) / rate);
        im += response[n] * std::sin(2 * M_PI * hertz * static_cast<double>(n) / rate);
    }
    return std::hypot(re, im);
}

// van Walstijn et al. 2016, fig. 5
TEST(SyntheticBody, RadiatesLittleBelowItsLowestModeAndItsStrongestAnswersWithOne) {
    const auto bridge = synthetic_response(BodyEnd::bridge), nut = synthetic_response(BodyEnd::nut);
    ASSERT_EQ(bridge.size(), 2048u);
    double most = 0, most_nut = 0;
    for (double f = 100; f < 20e3; f *= 1.002)
        most = std::max(most, gain_at(bridge, f, synthetic_rate)),
        most_nut = std::max(most_nut, gain_at(nut, f, synthetic_rate));
    EXPECT_NEAR(most, 1, 0.02);
    EXPECT_NEAR(20 * std::log10(most_nut), 0, 6);
    EXPECT_LT(20 * std::log10(gain_at(bridge, 65.4, synthetic_rate) / most), -20);  // of a C2
    EXPECT_LT(20 * std::log10(gain_at(bridge, 0, synthetic_rate)), -40);
}

TEST(SyntheticBody, OfTheLibraryIsMadeByThisRecipe) {
    const Body body = read_scene("tanpura_drone").body.value();
    for (const auto& [end, name] :
         {std::pair{BodyEnd::bridge, body.bridge}, std::pair{BodyEnd::nut, body.nut}}) {
        const auto synthetic = synthetic_response(end);
        const auto there = impulse_response(name, synthetic_rate, "body");
        ASSERT_EQ(there.size(), synthetic.size());
        for (std::size_t n = 0; n < synthetic.size(); ++n)
            ASSERT_NEAR(there[n], synthetic[n], 1e-7) << name << " " << n;
    }
}

TEST(ImpulseResponse, HasTheSameGainAtAnotherRate) {
    const Folder folder;
    write_audio(folder / "h.wav", synthetic_rate, {synthetic_response(BodyEnd::bridge)});
    const auto own = impulse_response(folder / "h.wav", 44100, "body.bridge");
    for (const double rate : {48000.0, 96000.0, 44100.0 / 2}) {
        const auto other = impulse_response(folder / "h.wav", rate, "body.bridge");
        for (const double f : {150.0, 333.0, 1000.0, 4000.0})
            EXPECT_NEAR(gain_at(other, f, rate), gain_at(own, f, 44100), 1e-3) << rate << " " << f;
    }
}

TEST(ImpulseResponse, ThatCannotBeTakenSaysWhy) {
    const Folder folder;
    const auto message_of = [](const std::string& file) {
        try {
            impulse_response(file, 44100, "body.nut");
        } catch (const bench::store::UsageError& e) { return std::string(e.what()); }
        return std::string();
    };
    EXPECT_TRUE(says(message_of(folder / "nothing.wav"), "body.nut: found"));
    write_audio(folder / "two.wav", 44100, {{0.5, 0.5}, {0.5, 0.5}});
    EXPECT_TRUE(says(message_of(folder / "two.wav"), "which has 2 channels"));
    write_audio(folder / "none.wav", 44100, {{}});
    EXPECT_TRUE(says(message_of(folder / "none.wav"), "which is empty"));
    write_audio(folder / "long.wav", 1000, {std::vector<double>(11000, 0.1)});
    EXPECT_TRUE(says(message_of(folder / "long.wav"), "which is longer"));
}

Scene with_body(Scene scene, const Folder& folder) {
    scene.body = Body{folder / "bridge.wav", folder / "nut.wav", {}};
    write_audio(scene.body->bridge, 44100, {{1, 0}});
    write_audio(scene.body->nut, 44100, {{0, 0, 0.5}});
    return scene;
}

TEST(Audible, IsTheForcesThatTheBodyTakes) {
    const Folder folder;
    const Scene both = audible(with_body(c3_pluck(), folder));
    ASSERT_EQ(both.taps.size(), 2u);
    EXPECT_EQ(both.taps[0].quantity, Quantity::driving_force);
    EXPECT_EQ(both.taps[1].quantity, Quantity::nut_force);
    EXPECT_EQ(audible(with_body(c3_free(), folder)).taps.size(), 1u);  // nothing touches the bridge
    Scene bridge_alone = with_body(c3_free(), folder);
    bridge_alone.body->nut.clear();
    const Scene left = audible(bridge_alone);
    EXPECT_FALSE(left.body);
    EXPECT_EQ(left.taps.at(0).quantity, Quantity::nut_force);
}

TEST(Audible, LeftIsTheBridgeAndRightTheNut) {
    const Folder folder;
    const Scene scene = audible(with_body(c3_pluck(), folder));
    Trace trace;
    trace.names = {"bridge", "nut"};
    trace.tap_rate = 44100;
    trace.rows = trace.stride = 500;
    for (int n = 0; n < 500; ++n) trace.tap.push_back(std::sin(0.3 * n));
    for (int n = 0; n < 500; ++n) trace.tap.push_back(std::cos(0.2 * n));
    const auto left = without_steady(trace.column(0), 44100),
               nut = without_steady(trace.column(1), 44100);
    Player(folder / "x.wav", scene, 44100).write(trace);
    SF_INFO info{};
    SNDFILE* file = sf_open((folder / "x.wav").c_str(), SFM_READ, &info);
    ASSERT_EQ(info.channels, 2);
    std::vector<double> frames(static_cast<std::size_t>(2 * info.frames));
    sf_readf_double(file, frames.data(), info.frames);
    sf_close(file);
    std::vector<double> right(500, 0.0);
    for (int n = 2; n < 500; ++n) right[n] = 0.5 * nut[n - 2];
    const double full_scale = levelled({left, right}).full_scale;
    for (int n = 0; n < 500; ++n) {
        ASSERT_NEAR(frames[2 * n] * full_scale, left[n], 1e-6);
        ASSERT_NEAR(frames[2 * n + 1] * full_scale, right[n], 1e-6);
    }
}

TEST(Body, IsNothingToAScheme) {
    const Scene with = read_scene("tanpura_drone");
    ASSERT_TRUE(with.body);
    Scene without = with;
    without.body.reset();
    EXPECT_EQ(needed_by(with).bits, needed_by(without).bits);
    EXPECT_EQ(scene_hash(with), scene_hash(without));
}

}  // namespace
}  // namespace jvari
