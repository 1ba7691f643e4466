// measure = ["ensemble"]: scheme and reference run from starts of their own, and what is told apart is told by rate.
#include "bench/suite/facet.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "bench/compare/catalogue.hpp"
#include "bench/store/records.hpp"
#include "scenes/scene_file.hpp"
#include "tests/says.hpp"

namespace jvari::bench::suite {
namespace {

store::Table rows_of(const char* scheme, double rate, const OptionValues& options = {}, const OptionValues& of_reference = {}) {
    static const compare::Catalogue catalogue;
    Scene scene = read_scene("guitar_over_fret");
    scene.duration = 0.1;
    const CellSet set;
    const Trace none;
    const study::ReferenceChoice choice[] = {{&catalogue.find("exact_contact"), {0, 44100, 40, of_reference}, ""}};
    const Settings settings{rate, 44100, 40, options};
    return ensemble_rows({scene, catalogue.find(scheme), settings, none, nullptr, 0, set, choice});
}
int apart(const store::Table& t) {
    EXPECT_EQ(t.at(0, "kind"), "any");
    return static_cast<int>(t.number(0, "apart"));
}

TEST(EnsembleFacet, DoesNotTellTheReferenceFromItselfThoughNoStartIsTheSame) {
    const store::Table t = rows_of("exact_contact", 0);
    ASSERT_GT(t.rows.size(), 30u);
    EXPECT_EQ(apart(t), 0);
    int other = 0;
    for (std::size_t i = 1; i < t.rows.size(); ++i) other += t.at(i, "reference") != t.at(i, "candidate");
    EXPECT_GT(2 * other, static_cast<int>(t.rows.size()));  // medians of other runs
}

TEST(EnsembleFacet, RunsTheReferenceWithItsOptions) {
    const OptionValues matched{{"compliance", "matched"}};
    EXPECT_EQ(apart(rows_of("exact_contact", 0, matched, matched)), 0);
    EXPECT_GT(apart(rows_of("exact_contact", 0, matched)), 10);
}

TEST(EnsembleFacet, TellsASchemeThatIsAnotherString) {
    const store::Table t = rows_of("modal_quadratised_two_point_raw", 176400);
    EXPECT_GT(apart(t), 10);
    int counted = 0;
    for (std::size_t i = 1; i < t.rows.size(); ++i) counted += t.number(i, "apart") == 1;
    EXPECT_EQ(counted, apart(t));
}

TEST(EnsembleText, NamesTheRateFromWhichOnNothingIsToldApart) {
    store::Table t;
    t.columns = {"scene", "scheme", "options", "rate", "modes", "kind", "apart"};
    for (const auto& [rate, count] : {std::pair{"44100", "3"}, {"88200", "0"}, {"176400", "1"}, {"352800", "0"}, {"705600", "0"}})
        t.rows.push_back({"s", "a", "", rate, "40", "any", count});
    EXPECT_TRUE(says(ensemble_text(t), "statistically the reference from 352800 Hz on"));
    t.rows.back().back() = "1";
    EXPECT_TRUE(says(ensemble_text(t), "told from the reference at the highest rate too"));
}

}  // namespace
}  // namespace jvari::bench::suite
