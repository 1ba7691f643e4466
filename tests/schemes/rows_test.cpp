// What a row holds, whatever the scheme: forces are means over its interval, the driving force is
// the sum of what touches the string, and options change no bit by block or probe. jvari check asks
// for bits of every scheme as it is by default.
#include "scenes/scene_file.hpp"
#include "tests/c3.hpp"
#include "tests/runs.hpp"

namespace jvari {
namespace {

std::vector<std::string> forms_over_c3() {  // all that take C3 over its bridge and thread
    std::vector<std::string> all{"modal_quadratised levels=3", "modal_quadratised variant=raw",
                                 "modal_quadratised levels=3 variant=raw",
                                 "modal_two_point compliance=matched",
                                 "modal_spatial_newton compliance=matched"};
    for (const auto& table : {schemes(), std::span(schemes_of_pairings())})
        for (const Descriptor& d : table)
            if (represents(d, c3_release())) all.emplace_back(d.name);
    return all;
}

class Rows : public testing::TestWithParam<std::string> {};

TEST_P(Rows, HoldTheMeansOfForcesWhoseSumDrives) {
    Scene scene = lasting(c3_release(), 220 / 44100.0);
    barrier(scene).stiffness.k = 1e5;  // so that explicit schemes stand it
    scene.taps = {{"bridge", Quantity::bridge_force, 0, 0},
                  {"thread", Quantity::thread_force, 0, 0},
                  {"driving", Quantity::driving_force, 0, 0}};
    const auto fine = play(GetParam(), scene, {176400, 176400, 60, {}}),
               coarse = play(GetParam(), scene, {176400, 44100, 60, {}});
    ASSERT_GT(largest(coarse.trace.column(0)), 0);
    for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(coarse.trace.column(k)[0], 0);
        for (long n = 1; n < coarse.trace.rows; ++n) {
            double mean = 0, size = 0;
            for (int i = -3; i <= 0; ++i) {
                mean += 0.25 * fine.trace.column(k)[4 * n + i];
                size += 0.25 * std::abs(fine.trace.column(k)[4 * n + i]);
            }
            ASSERT_NEAR(coarse.trace.column(k)[n], mean, 1e-13 * size) << "row " << n;
        }
    }
    for (long n = 0; n < fine.trace.rows; ++n)
        ASSERT_NEAR(fine.trace.column(2)[n], -fine.trace.column(0)[n] - fine.trace.column(1)[n],
                    1e-12);
}
INSTANTIATE_TEST_SUITE_P(, Rows, testing::ValuesIn(forms_over_c3()), [](const auto& one) {
    std::string name = one.param;
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    return name;
});

TEST(MatchedRows, HaveTheSameBitsWhateverTheBlockAndTheProbe) {
    const auto beside_more = [](Scene scene) {
        for (const double x : {0.02, 0.03})
            scene.strings[0].barriers.push_back(LumpedBarrier{x, 2e-3, -1e-6, {4.39e8}, 1, 0});
        return scene;
    };
    const std::vector<Scene> lumped{lasting(c3_release(), 0.02), lasting(c3_pluck(), 0.02),
                                    beside_more(lasting(c3_release(), 0.02)),
                                    beside_more(lasting(c3_pluck(), 0.02))};
    Scene profile = lasting(read_scene("sitar_parabola"), 0.02);
    profile.strings[0].thread = Thread{25e-3, 1.2e-3, 1.2e5, 1.2, 0};
    profile.strings[0].start.reset();
    profile.strings[0].pluck = Pluck{-0.4, 10e-3, 30.0, 1e-3, 30e-3, 10e-3};
    const auto same = [](const std::string& form, const Scene& scene, int modes) {
        const Settings s{88200, 44100, modes, {}};
        const auto a = play(form, scene, s),
                   b = play(form, scene, s, {.energy = true, .block_rows = 7});
        EXPECT_EQ(a.trace.tap, b.trace.tap) << form << " on " << scene.name;
    };
    for (const std::string name :
         {"modal_two_point", "modal_two_point_trapezoidal", "modal_quadratised",
          "modal_spatial_newton", "finite_difference_explicit", "finite_difference_theta",
          "finite_difference_hamiltonian"}) {
        for (const Scene& scene : lumped) same(name + " compliance=matched", scene, 50);
        if (name == "modal_spatial_newton" || name.starts_with("finite"))
            same(name + " compliance=matched points=6", profile, 60);
    }
}

}  // namespace
}  // namespace jvari
