// The example plugin under tests/plugin, built out of tree against the install tree by the tests
// that this one depends on.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "schemes/registry.hpp"
#include "schemes/run.hpp"
#include "tests/c3.hpp"

namespace jvari {
extern const Descriptor modal_two_point;
namespace {

TEST(Plugin, BuiltAgainstTheInstallTreeGivesTheTraceOfTheTwoPointScheme) {
    const char* path = std::getenv("JVARI_EXAMPLE_PLUGIN");
    ASSERT_NE(path, nullptr) << "run this test through ctest";
    const auto& loaded = load_plugin(path).schemes;
    ASSERT_EQ(loaded.size(), 1u);
    EXPECT_STREQ(loaded[0].name, "plain_two_point");

    struct Case {
        Scene scene;
        double rate, bound;
    };
    // A plugin has the pluck about the instants, and its mean over a step to order two.
    for (auto [scene, rate, bound] : {Case{c3_release(), 88200, 1e-9},
                                      {c3_pluck(), 88200, 1.6e-5},
                                      {c3_pluck(), 176400, 4e-6}}) {
        scene.duration = 0.06;
        const Settings settings{rate, 44100, 133, {}};
        const auto ours = run(modal_two_point, scene, settings),
                   theirs = run(loaded[0], scene, settings);
        for (int k = 0; k < ours.trace.taps(); ++k) {
            double difference = 0, largest = 0;
            for (long n = 0; n < ours.trace.rows; ++n) {
                difference = std::max(
                    difference, std::abs(ours.trace.column(k)[n] - theirs.trace.column(k)[n]));
                largest = std::max(largest, std::abs(ours.trace.column(k)[n]));
            }
            EXPECT_LT(difference, bound * largest) << ours.trace.names[k] << " " << rate;
        }
    }
}

TEST(Plugin, AMissingOrForeignLibraryIsRefusedWithItsReason) {
    EXPECT_THROW(load_plugin("/nonexistent/plugin.so"), std::runtime_error);
    try {
        load_plugin("libm.so.6");
        FAIL();
    } catch (const std::runtime_error& e) {
        EXPECT_NE(std::string(e.what()).find("libm.so.6"), std::string::npos);
    }
}

}  // namespace
}  // namespace jvari
