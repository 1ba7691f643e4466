// What the charts are given to draw: every cell once, the front as the rule says, nothing that ends a script early.
#include "bench/report/charts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/compare/pareto.hpp"
#include "bench/report/page.hpp"
#include "bench/report/page_text.hpp"
#include "bench/report/vega.hpp"

namespace jvari {
namespace {

bench::report::WorkPrecision sample() {
    bench::report::WorkPrecision w;
    w.title = "a scene";
    w.cells.columns = {"scheme",     "rate",       "modes",       "status", "error_l2_50ms", "third_octave_db", "cost_s_per_s",
                       "cost_lower", "cost_upper", "ns_per_step", "dofs",   "below_floor",   "reason"};
    w.cells.rows = {{"a", "44100", "133", "ok", "1e-2", "3", "0.01", "0.009", "0.011", "100", "266", "", ""},
                    {"a", "88200", "133", "ok", "1e-3", "2", "0.02", "0.019", "0.021", "100", "266", "", ""},
                    {"b", "44100", "133", "ok", "5e-3", "4", "0.03", "0.029", "0.031", "200", "266", "", ""},
                    {"b", "88200", "133", "diverged", "inf", "", "0.05", "0.05", "0.05", "200", "266", "", "diverged at step 7"},
                    {"c", "44100", "133", "refused", "", "", "", "", "", "", "", "", "has no </script> thread"}};
    w.errors = bench::report::error_axes(w.cells, {"", "nut"}, "error_l2_50ms");
    w.costs = bench::report::cost_axes();
    w.bands = {{"", "error_l2_50ms", 1e-12, 1e-9}};
    return w;
}

TEST(Charts, TheSpecificationHoldsEveryCellThatRan) {
    const auto spec = nlohmann::json::parse(bench::report::work_precision_spec(sample()));
    const auto& cells = spec.at("datasets").at("cells");
    ASSERT_EQ(cells.size(), 4u);
    EXPECT_EQ(cells[1].at("scheme"), "a");
    EXPECT_EQ(cells[1].at("rate"), 88200);
    EXPECT_EQ(cells[1].at("error_l2_50ms"), 1e-3);
    EXPECT_EQ(cells[1].at("label"), "\u00d72");
    EXPECT_TRUE(cells[3].at("error_l2_50ms").is_null());
    EXPECT_EQ(spec.at("params")[0].at("value"), "error_l2_50ms");
    EXPECT_EQ(spec.at("params")[2].at("value").at("|error_l2_50ms").at("floor"), 1e-12);
    EXPECT_EQ(spec.at("params")[2].at("value").at("|error_l2_50ms").at("certificate"), 1e-9);
}

TEST(Charts, TheFrontIsOfSoundCellsAndOfEachChoice) {
    const auto spec = nlohmann::json::parse(bench::report::work_precision_spec(sample()));
    std::vector<double> by_time, by_octaves;
    for (const auto& f : spec.at("datasets").at("fronts")) {
        if (f.at("cost") != "cost_s_per_s") continue;
        (f.at("error") == "error_l2_50ms" ? by_time : by_octaves).push_back(f.at("x"));
    }
    EXPECT_EQ(by_time, (std::vector<double>{0.01, 0.02}));
    EXPECT_EQ(by_octaves, (std::vector<double>{0.01, 0.02}));
}

TEST(Charts, AnErrorStandsAtErrorAndCertificateTogetherAndWhatIsFlaggedIsHollow) {
    bench::report::WorkPrecision w = sample();
    w.cells.columns.insert(w.cells.columns.end(), {"certificate_l2_50ms", "flags"});
    for (auto& row : w.cells.rows) row.insert(row.end(), {"6e-4", ""});
    w.cells.rows[2].back() = "adhesion";
    const auto spec = nlohmann::json::parse(bench::report::work_precision_spec(w));
    const auto& cells = spec.at("datasets").at("cells");
    EXPECT_EQ(cells[0].at("error_l2_50ms"), 1e-2);  // 6 %: as measured
    EXPECT_EQ(cells[0].at("at_most"), "");
    EXPECT_EQ(cells[1].at("error_l2_50ms"), 1.6e-3);
    EXPECT_EQ(cells[1].at("at_most"), "error_l2_50ms");
    EXPECT_EQ(cells[2].at("flags"), "adhesion");
    for (const auto& f : spec.at("datasets").at("fronts")) {
        EXPECT_EQ(f.at("key").get<std::string>().find("|b|"), std::string::npos) << f;
        if (f.at("error") == "error_l2_50ms") {
            EXPECT_NEAR(f.at("y").get<double>(), f.at("key").get<std::string>().ends_with("|44100") ? 1e-2 : 1.6e-3, 1e-12) << f;
        }
    }
    bool hollow = false;
    for (const auto& layer : spec.at("layer"))
        for (const auto& step : layer.value("transform", nlohmann::json::array()))
            hollow = hollow || (step.contains("filter") && step["filter"].is_string() &&
                                step["filter"].get<std::string>().find("datum.flags != ''") != std::string::npos);
    EXPECT_TRUE(hollow);
}

TEST(Charts, AxesAreOfferedOnlyWhereThereIsAFiniteValueAndTheHeadlineComesFirst) {
    const bench::report::WorkPrecision w = sample();
    ASSERT_EQ(w.errors.size(), 2u);
    EXPECT_EQ(w.errors[0].column, "error_l2_50ms");
    EXPECT_EQ(w.errors[1].column, "third_octave_db");
}

TEST(Charts, NothingInThePageEndsAScriptEarly) {
    EXPECT_EQ(bench::report::inside_script("a</script>b</SCRIPT><!--"), "a<\\/script>b<\\/SCRIPT><\\!--");
    EXPECT_EQ(bench::report::inside_script("x</g,1<2"), "x</g,1<2");
    bench::report::Page page;
    page.title = "<b>";
    page.manifest = R"({"note": "<!-- </script>"})";
    page.sections = {{"cells", "Cells"}};
    page.sections[0].table = {{"reason"}, {{"</script><script>"}}};
    const std::string text = bench::report::page_of(page);
    EXPECT_NE(text.find("<title>&lt;b></title>"), std::string::npos);
    const std::string data = text.substr(text.find("id=\"data\">") + 10);
    const auto read = nlohmann::json::parse(data.substr(0, data.find("</script>")));
    EXPECT_EQ(read.at("sections")[0].at("table").at("rows")[0][0], "</script><script>");
    EXPECT_EQ(read.at("manifest").at("note"), "<!-- </script>");
    for (const char* mark : {"@TITLE@", "@STYLE@", "@SCRIPTS@", "@DATA@", "@PROGRAM@"})
        EXPECT_EQ(text.find(mark), std::string::npos) << mark;
}

TEST(Charts, TheSpecificationIsDrawnWhereThePackagesAreInstalled) {
    const bench::report::Vega vega = bench::report::find_vega();
    if (!vega.missing.empty()) GTEST_SKIP() << vega.missing;
    std::string why;
    const auto svg = bench::report::svg_of(vega, bench::report::work_precision_spec(sample()), why);
    ASSERT_TRUE(svg) << why;
    for (const char* word : {"a scene", "relative L2 error", "computing time", "\u00d72", "\u2715"})
        EXPECT_NE(svg->find(word), std::string::npos) << word;
}

TEST(Pareto, ADifferenceInsideTheSpreadDecidesNothing) {
    const std::vector<bench::compare::Point> apart{{1, 0.9, 1.1, 1e-3}, {2, 1.9, 2.1, 1e-3}};
    EXPECT_EQ(pareto_front(apart), (std::vector<bool>{true, false}));
    const std::vector<bench::compare::Point> tied{{1, 0.9, 1.6, 1e-3}, {2, 1.5, 2.1, 1e-3}};
    EXPECT_EQ(pareto_front(tied), (std::vector<bool>{true, true}));
    const std::vector<bench::compare::Point> tied_cost_less_error{{1, 0.9, 1.6, 1e-3}, {2, 1.5, 2.1, 1e-4}};
    EXPECT_EQ(pareto_front(tied_cost_less_error), (std::vector<bool>{false, true}));
    const std::vector<bench::compare::Point> unsound{{1, 1, 1, HUGE_VAL}, {NAN, NAN, NAN, 1e-9}, {3, 3, 3, 1e-3}};
    EXPECT_EQ(pareto_front(unsound), (std::vector<bool>{false, false, true}));
}

}  // namespace
}  // namespace jvari
