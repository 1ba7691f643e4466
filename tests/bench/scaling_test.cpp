// What a step costs against modes, rate and contacts, and what each element adds: the fit on costs that are known, the scenes that are
// timed.
#include "bench/compare/record/fits.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bench/compare/catalogue.hpp"
#include "bench/study/elements.hpp"
#include "bench/suite/suite_plan.hpp"
#include "scenes/scene_file.hpp"
#include "tests/suite_text.hpp"

namespace jvari {
namespace {

// A timed row: a step of `ns` between nine tenths and eleven tenths of it.
struct Timed {
    std::string scheme, element, swept;
    double rate;
    int modes, contacts;
    double ns;
};
bench::store::Table cells_of(const std::vector<Timed>& all) {
    bench::store::Table t;
    t.columns = {"cell",  "scene",  "to",          "element",      "scheme",     "options",    "rate",
                 "modes", "status", "ns_per_step", "cost_s_per_s", "cost_lower", "cost_upper", "fact_contact_points"};
    for (const Timed& c : all) {
        const double cost = 1e-9 * c.ns * c.rate;
        t.rows.push_back({"id", "a", c.swept, c.element, c.scheme, "", bench::store::text_of(c.rate), std::to_string(c.modes), "ok",
                          bench::store::text_of(c.ns), bench::store::text_of(cost), bench::store::text_of(0.9 * cost),
                          bench::store::text_of(1.1 * cost), c.contacts > 0 ? std::to_string(c.contacts) : ""});
    }
    return t;
}
TEST(Scaling, ACostThatGrowsWithAPowerHasThatPowerForItsExponent) {
    std::vector<Timed> modes, rates, contacts;
    for (const int n : {16, 32, 64, 128}) modes.push_back({"m", "", "", 44100, n, 0, 3 * std::pow(n, 1.5)});
    for (const double rate : {44100.0, 88200.0, 176400.0}) rates.push_back({"g", "", "", rate, int(rate / 441), 0, 0.01 * rate});
    for (const int n : {2, 4, 8}) contacts.push_back({"s", "", std::to_string(1e-3 * n), 44100, 100, n, 7.0 * n * n});
    for (const auto& [all, what, exponent] : {std::tuple{modes, "modes", 1.5}, {rates, "rate", 1.0}, {contacts, "contacts", 2.0}}) {
        const bench::store::Table cells = cells_of(all), t = bench::compare::scaling_of(cells, {bench::store::all_rows(cells)});
        ASSERT_EQ(t.rows.size(), all.size()) << what;
        for (std::size_t i = 0; i < all.size(); ++i) {
            EXPECT_EQ(t.at(i, "what"), what);
            EXPECT_NEAR(t.number(i, "exponent"), exponent, 1e-12) << what;
            EXPECT_NEAR(t.number(i, "exponent_half_width"), 0, 1e-12) << what;
            EXPECT_EQ(t.number(i, "ns_per_step"), all[i].ns);
            EXPECT_NEAR(t.number(i, "ns_lower"), 0.9 * all[i].ns, 1e-9 * all[i].ns);
            EXPECT_NEAR(t.number(i, "ns_upper"), 1.1 * all[i].ns, 1e-9 * all[i].ns);
        }
    }
}

TEST(Scaling, AStepsTimeIsTheProcessorsWhereThatWasTaken) {
    bench::store::Table cells = cells_of({{"m", "", "", 44100, 16, 0, 10}, {"m", "-thread", "", 44100, 16, 0, 8}});
    for (const char* column : {"processor_s_per_s", "processor_lower", "processor_upper"}) cells.columns.emplace_back(column);
    for (const double ns : {5.0, 3.0})
        for (const double part : {1.0, 0.99, 1.01}) cells.rows[ns == 5.0 ? 0 : 1].push_back(bench::store::text_of(part * ns * 44100e-9));
    const bench::store::Table t = bench::compare::scaling_of(cells, {bench::store::all_rows(cells)});
    ASSERT_EQ(t.rows.size(), 1u);
    EXPECT_NEAR(t.number(0, "ns_per_step"), 3, 1e-12);
    EXPECT_NEAR(t.number(0, "extra_ns"), 2, 1e-12);
    EXPECT_NEAR(t.number(0, "extra_lower"), 5 * 0.99 - 3 * 1.01, 1e-12);
    EXPECT_NEAR(t.number(0, "extra_upper"), 5 * 1.01 - 3 * 0.99, 1e-12);
}

TEST(Scaling, TheSweptKeyThatVariesTheContactsStandsInXAlone) {
    const bench::store::Table cells = cells_of({{"s", "", "0.002", 44100, 100, 2, 10}, {"s", "", "0.004", 44100, 100, 4, 20}});
    const bench::store::Table t = bench::compare::scaling_of(cells, {bench::store::all_rows(cells)});
    ASSERT_EQ(t.rows.size(), 2u);
    EXPECT_EQ(t.at(0, "to"), "");
    EXPECT_EQ(t.at(0, "at"), "44100 Hz, 100 modes");
    EXPECT_EQ(t.at(1, "x"), "4");
    EXPECT_EQ(t.at(1, "exponent_half_width"), "") << "two points leave no scatter to judge by";
}

TEST(Scaling, AnElementAddsWhatTheSceneCostsMoreThanWithoutIt) {
    const bench::store::Table cells =
        cells_of({{"m", "", "", 44100, 100, 0, 50}, {"m", "-thread", "", 44100, 100, 0, 40}, {"m", "+probe", "", 44100, 100, 0, 80}});
    const bench::store::Table t = bench::compare::scaling_of(cells, {bench::store::all_rows(cells)});
    ASSERT_EQ(t.rows.size(), 2u);
    EXPECT_EQ(t.at(0, "what"), "thread");
    EXPECT_NEAR(t.number(0, "extra_ns"), 10, 1e-9);
    EXPECT_NEAR(t.number(0, "extra_lower"), 0.9 * 50 - 1.1 * 40, 1e-9);  // the quartiles furthest apart
    EXPECT_NEAR(t.number(0, "extra_upper"), 1.1 * 50 - 0.9 * 40, 1e-9);
    EXPECT_EQ(t.at(1, "what"), "probe");
    EXPECT_NEAR(t.number(1, "extra_ns"), 30, 1e-9);
}

TEST(Scaling, RowsOfDifferentSetsAreNotCompared) {
    const bench::store::Table cells =
        cells_of({{"m", "", "", 44100, 100, 0, 50}, {"m", "", "", 44100, 200, 0, 90}, {"m", "-thread", "", 44100, 100, 0, 40}});
    EXPECT_EQ(bench::compare::scaling_of(cells, {{0}, {1}, {2}}).rows.size(), 0u);
    EXPECT_EQ(bench::compare::scaling_of(cells, {{0, 1}, {2}}).rows.size(), 2u);
}

TEST(Scaling, ARowThatFailedOrWasNotTimedHasNoPlaceInIt) {
    bench::store::Table cells =
        cells_of({{"m", "", "", 44100, 100, 0, 50}, {"m", "", "", 44100, 200, 0, 90}, {"m", "", "", 44100, 400, 0, 100}});
    cells.rows[1][cells.column("status")] = "diverged";
    cells.rows[2][cells.column("ns_per_step")] = "";
    EXPECT_EQ(bench::compare::scaling_of(cells, {all_rows(cells)}).rows.size(), 0u);
}

// ---- Elements

TEST(Elements, EachIsTakenAwayWithTheTapsOfItsForceAndNothingElse) {
    const Scene whole = bench::compare::load_scene("tanpura_c3_release", {"body.nut=synthetic_nut.wav"}, 0.01);
    const auto names = [](const Scene& s) {
        std::string all;
        for (const Tap& t : s.taps) all += t.name + " ";
        return all;
    };
    for (const bench::study::Element e : bench::study::elements()) {
        if (e == bench::study::Element::strings) continue;  // it has one
        const Scene s = bench::study::without(e, whole);
        EXPECT_NO_THROW(validate(s));
        EXPECT_EQ(s.strings[0].thread.has_value(), e != bench::study::Element::thread);
        EXPECT_EQ(s.strings[0].barriers.empty(), e == bench::study::Element::contact);
        EXPECT_EQ(s.strings[0].bending_stiffness == 0, e == bench::study::Element::stiffness);
        EXPECT_EQ(std::holds_alternative<NoDamping>(s.strings[0].damping), e == bench::study::Element::losses);
        EXPECT_EQ(s.body.has_value(), e != bench::study::Element::body);
        EXPECT_EQ(names(s), e == bench::study::Element::thread    ? "nut y03 bridge "
                            : e == bench::study::Element::contact ? "nut y03 thread "
                            : e == bench::study::Element::taps    ? "nut "
                                                                  : "nut y03 bridge thread ");
    }
}

TEST(Elements, WithoutItsOtherStringsAnInstrumentHasItsFirst) {
    const Scene drone = bench::compare::load_scene("tanpura_drone", {}, 0.01);
    const Scene one = bench::study::without(bench::study::Element::strings, drone);
    ASSERT_EQ(one.strings.size(), 1u);
    EXPECT_EQ(one.strings[0], drone.strings[0]);
    EXPECT_EQ(one.taps, drone.taps);
    EXPECT_EQ(bench::study::without(bench::study::Element::radiation, drone), drone);
}

TEST(Elements, ASceneThatHasNoneOfItIsRefused) {
    using enum bench::study::Element;
    const Scene one = bench::compare::load_scene("tanpura_c3_release", {}, 0.01);
    for (const bench::study::Element e : {strings, body, radiation}) EXPECT_THROW(bench::study::without(e, one), bench::store::UsageError);
    Scene untapped = bench::compare::load_scene("tanpura_drone", {}, 0.01);
    untapped.taps = {{"y", Quantity::displacement, 0, 0.5}};
    EXPECT_THROW(bench::study::without(radiation, untapped), bench::store::UsageError);
    const Scene parabola = bench::compare::load_scene("sitar_parabola", {}, 0.01);
    EXPECT_THROW(bench::study::without(bench::study::Element::thread, parabola), bench::store::UsageError);
    EXPECT_THROW(bench::study::without(bench::study::Element::contact, bench::study::without(bench::study::Element::contact, parabola)),
                 bench::store::UsageError);
}

TEST(Elements, ASetHasACellForTheSceneAndForEachChangeOfIt) {
    const std::string text = R"([[cells]]
scenes = ["tanpura_c3_release"]
schemes = ["modal_two_point"]
rates = [44100]
duration = 0.01
elements = ["thread", "contact", "stiffness", "taps", "probe"]
measure = ["errors", "cost"]
)";
    const test::Planned plan(text);
    ASSERT_EQ(plan.jobs.size(), 6u);
    EXPECT_TRUE(plan.jobs[0].point->swept.empty());
    const char* changes[] = {"", "-thread", "-contact", "-stiffness", "-taps", "+probe"};
    for (std::size_t i = 1; i < 6; ++i) {
        ASSERT_EQ(plan.jobs[i].point->swept.size(), 1u);
        EXPECT_EQ(plan.jobs[i].point->swept[0], std::pair(std::string("element"), std::string(changes[i])));
        EXPECT_NE(plan.jobs[i].id, plan.jobs[0].id);
    }
    EXPECT_EQ(sets_of(plan), std::vector<bench::store::Rows>{(bench::store::Rows{0, 1, 2, 3, 4, 5})});
}

TEST(Elements, AreRefusedWhereTheyAreUnknownOrNotTimed) {
    const std::string set = "[[cells]]\nscenes = [\"tanpura_c3_release\"]\n";
    EXPECT_EQ(test::refusal_of(set + "measure = [\"errors\", \"cost\"]\nelements = [\"tread\"]\n"),
              "a.toml:4: cells.0.elements.0: unknown element \"tread\"; did you mean \"thread\"?");
    EXPECT_EQ(test::refusal_of(set + "elements = [\"thread\"]\n"),
              "a.toml:3: cells.0.elements: measure does not ask for cost, which elements are compared by");
}

}  // namespace
}  // namespace jvari
