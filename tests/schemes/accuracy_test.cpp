// modal_two_point against the exact reference on the released C3 string: the errors that an
// independent program found, and their fall.
#include <gtest/gtest.h>

#include <cmath>

#include "reference/references.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"
#include "tests/c3.hpp"

namespace jvari {
namespace {

double relative_l2(std::span<const double> got, std::span<const double> want) {
    double difference = 0, norm = 0;
    for (std::size_t n = 0; n < want.size(); ++n) {
        difference += (got[n] - want[n]) * (got[n] - want[n]);
        norm += want[n] * want[n];
    }
    return std::sqrt(difference / norm);
}

TEST(Accuracy, TheTwoPointSchemeErrsByWhatAnIndependentProgramFound) {
    Scene scene = c3_release();
    scene.duration = 0.05;
    const Descriptor& exact = *best_reference(scene);
    ASSERT_STREQ(exact.name, "exact_contact");
    const auto truth = run(exact, scene, {0, 44100, 133, {}});
    struct {
        int multiple;
        // nut force, relative L2, 0-50 ms; a separate implementation of the scheme and of the exact
        // solution
        double error;
    } const table[] = {{1, 6.8e-2}, {4, 4.1e-3}, {16, 7.1e-4}, {64, 1.8e-4}};
    for (const auto& row : table) {
        const auto r = run(schemes()[0], scene, {44100.0 * row.multiple, 44100, 133, {}});
        EXPECT_NEAR(relative_l2(r.trace.column(0), truth.trace.column(0)), row.error,
                    0.05 * row.error)
            << "x" << row.multiple;
    }
}

}  // namespace
}  // namespace jvari
