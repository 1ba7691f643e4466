// The report of a folder: what its page is given, what is refused, and what fits. What the page
// makes of it is asked of its own JavaScript in tests/browser/page.mjs. The folder is made up.
#include "bench/report/report.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/compare/record/findings.hpp"
#include "bench/report/results.hpp"
#include "bench/report/vega.hpp"
#include "bench/store/encoding.hpp"
#include "bench/store/trace_file.hpp"
#include "tests/cells_from.hpp"
#include "tests/command_line.hpp"

namespace jvari::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Folder : Scratch {  // some of the files
    explicit Folder(const std::vector<std::string>& files) {
        for (const std::string& name : files)
            fs::copy_file(fs::path(JVARI_MADE_UP_RESULTS) / name, path / name);
    }
};
const std::vector<std::string> every_file{"manifest.json", "facts.csv",       "errors.csv",
                                          "cost.csv",      "convergence.csv", "maps.csv",
                                          "boundaries.csv"};

Json data_of(const std::string& page) {
    const auto from = page.find("id=\"data\">") + 10;
    return Json::parse(page.substr(from, page.find("</script>", from) - from));
}

TEST(Report, WithoutThePackagesItHasTheTablesAndSaysWhatIsMissing) {
    const Folder folder(every_file);
    const Ended o = jvari(folder, "report " + folder.path.string(), "JVARI_NODE_MODULES=/nowhere");
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_TRUE(says(o.err, "npm ci"));
    const Json data = data_of(content(folder / "report.html"));
    EXPECT_TRUE(says(data.at("missing").get<std::string>(), "npm ci"));
    EXPECT_EQ(data.at("manifest").at("suite"), "made up");
    for (const char* name : {"convergence", "maps", "boundaries"}) {
        // the file's own columns behind the problem and the series
        Json kept = data.at("tables").at(name);
        for (Json& row : kept.at("rows")) row.erase(row.begin(), row.begin() + 2);
        EXPECT_EQ(kept.at("rows"),
                  Json(bench::store::table_json(
                           bench::store::read_csv(content(folder / (std::string(name) + ".csv"))))
                           .at("rows")))
            << name;
    }
    for (const auto& entry : fs::directory_iterator(folder.path))
        EXPECT_NE(entry.path().extension(), ".svg") << entry.path();
}

TEST(Report, AFolderSaysItsValuesToAProgramInOneDocumentWithTypes) {
    const Folder folder(every_file);
    const Ended o =
        jvari(folder, "report --json " + folder.path.string(), "JVARI_NODE_MODULES=/nowhere");
    EXPECT_TRUE(says(o.out, "/results.json\"")) << o.err;
    const Json values = Json::parse(content(folder / "results.json"));
    EXPECT_EQ(values.at("manifest"), Json::parse(content(folder / "manifest.json")));
    const Json& cells = values.at("tables").at("cells");
    const auto types_in = [&cells](const std::string& name) {
        const auto& columns = cells.at("columns");
        const auto k = std::find(columns.begin(), columns.end(), name) - columns.begin();
        std::set<std::string> types;
        for (const Json& row : cells.at("rows")) types.insert(row.at(k).type_name());
        return types;
    };
    using Types = std::set<std::string>;
    EXPECT_EQ(types_in("scheme"), Types{"string"});
    EXPECT_EQ(types_in("headline_nut"), Types{"string"});
    EXPECT_EQ(types_in("trusted"), Types{"boolean"});
    EXPECT_EQ(types_in("may_win"), Types{"boolean"});
    EXPECT_EQ(types_in("cost_s_per_s"), (Types{"number", "null"}));
    EXPECT_GT(values.at("tables").at("cheapest").at("rows").size(), 0u);
    EXPECT_GT(values.at("answers").size(), 0u);
    EXPECT_TRUE(values.at("warnings").is_array());
    // the page draws these values, and of the errors those that it has a chart of
    Json own = values, page = data_of(content(folder / "report.html"));
    for (Json* of : {&own, &page}) of->at("tables").erase("errors");
    for (const auto& [name, value] : own.items()) EXPECT_EQ(page.at(name), value) << name;
}

TEST(Report, ResultsJsonAloneIsAFolderOfResults) {
    const Folder folder(every_file), alone({});
    const auto report = [](const Folder& of) {
        return jvari(of, "report " + of.path.string(), "JVARI_NODE_MODULES=/nowhere");
    };
    ASSERT_EQ(report(folder).code, 0);
    const std::string values = content(folder / "results.json");
    std::ofstream(alone / "results.json") << values;
    const Ended diff = jvari(alone, "diff " + folder.path.string() + " " + alone.path.string());
    EXPECT_EQ(diff.code, 0) << diff.err;
    EXPECT_TRUE(says(diff.out, "0 worse, 0 better, 0 moved")) << diff.out;
    EXPECT_TRUE(says(diff.out, "came back to the last digit")) << diff.out;
    ASSERT_EQ(report(alone).code, 0);
    EXPECT_EQ(content(alone / "results.json"), values);
    EXPECT_TRUE(content(alone / "report.html") == content(folder / "report.html"));
    std::ofstream(alone / "results.json") << values.substr(0, values.size() / 2);
    EXPECT_TRUE(ends(report(alone), 2, "results.json: "));
}

TEST(Report, AFolderWithoutResultsIsRefused) {
    const Scratch empty;
    EXPECT_EQ(jvari(empty, "report " + empty.path.string()).code, 2);
    std::ofstream(empty / "facts.csv") << "scheme\na\n";
    EXPECT_EQ(jvari(empty, "report " + empty.path.string()).code, 2);
    std::ofstream(empty / "manifest.json") << "{";
    EXPECT_EQ(jvari(empty, "report " + empty.path.string()).code, 2);
}

TEST(Report, ATableThatWasCutAfterItsHeaderIsRefusedAndThePageStays) {
    const Folder folder({"manifest.json", "maps.csv"});
    std::ofstream(folder / "facts.csv") << "cell,scheme,rate,status,flags\n";
    std::ofstream(folder / "report.html") << "the page";
    EXPECT_TRUE(ends(jvari(folder, "report " + folder.path.string(), "JVARI_NODE_MODULES=/nowhere"),
                     2, "facts.csv: it has no row"));
    EXPECT_EQ(content(folder / "report.html"), "the page");
}

TEST(Report, APipeInPlaceOfAFileIsRefused) {
    const Folder folder(every_file);
    EXPECT_TRUE(
        ends(shell(folder, "rm manifest.json; mkfifo manifest.json; timeout 20 $J report ."), 2,
             "manifest.json: something that is no file"));
}

TEST(Report, TextsThatAreNoUtf8AreShownAsFarAsTheyAre) {
    const Folder folder(every_file);
    std::string facts = content(folder / "facts.csv");
    for (auto at = facts.find(",three <b>,"); at != std::string::npos;
         at = facts.find(",three <b>,"))
        facts.replace(at, 11, ",one\xff,");
    std::ofstream(folder / "facts.csv", std::ios::binary) << facts;
    fs::remove(folder / "cost.csv");
    const Ended o =
        jvari(folder, "report --json " + folder.path.string(), "JVARI_NODE_MODULES=/nowhere");
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_TRUE(says(content(folder / "report.html"), "one\ufffd"));
}

TEST(Report, AManifestThatIsNestedTooDeepIsRefused) {
    const Folder folder(every_file);
    std::ofstream(folder / "manifest.json")
        << "{\"suite\": \"a\", \"x\": " << std::string(300000, '[') << std::string(300000, ']')
        << "}";
    EXPECT_EQ(jvari(folder, "report " + folder.path.string()).code, 2);
}

TEST(Report, SoundsLieBelowTheFolder) {
    const Scratch outside;
    std::ofstream(outside / "private.wav", std::ios::binary)
        << bench::store::wav_of({44100, 1, std::vector<std::int16_t>(4410, 7)});
    for (const std::string& file :
         {outside / "private.wav", "../" + outside.path.filename().string() + "/private.wav"}) {
        const Folder folder(every_file);
        std::ofstream(folder / "sounds.csv") << "scheme,rate,modes,tap,quantity,sample_rate,peak,"
                                                "file,reference_file\none,44100,1,nut,"
                                                "nut_force,44100,1,"
                                             << file << ",\n";
        const Ended o =
            jvari(folder, "report " + folder.path.string(), "JVARI_NODE_MODULES=/nowhere");
        EXPECT_TRUE(ends(o, 2, "expected one below the folder"));
    }
}

TEST(Report, ACostOfACellThatIsNotThereIsRefused) {
    const Folder record({"manifest.json", "facts.csv", "errors.csv", "cost.csv"});
    std::string cost = content(record / "cost.csv");
    cost.replace(cost.find("88200"), 5, "88300");
    std::ofstream(record / "cost.csv", std::ios::binary) << cost;
    const Ended o = jvari(record, "report " + record.path.string(), "JVARI_NODE_MODULES=/nowhere");
    EXPECT_TRUE(ends(o, 2, "cost.csv: found the cell 0000000000000002, which facts.csv has not"));
}

TEST(Report, AnErrorThatIsBoundedStandsAtItAndItsCertificateTogether) {
    bench::report::Results r;
    r.cells = cells_from(
        {{"scene", "scheme", "rate", "modes", "status", "error_l2_50ms", "certificate_l2_50ms"},
         {{"a", "b", "44100", "10", "ok", "1e-2", "6e-4"},
          {"a", "b", "88200", "10", "ok", "1e-3", "6e-4"}}});
    r.series = {"b", "b"};
    const bench::store::Table errors = bench::report::tables_of(r).at("errors");
    ASSERT_EQ(errors.rows.size(), 4u);       // of the headline, and of its tap
    EXPECT_EQ(errors.text(0, "shown"), "");  // 6 % of the first: as measured
    EXPECT_EQ(errors.text(1, "row"), "1");
    EXPECT_NEAR(errors.number(1, "shown"), 1.6e-3, 1e-12);
}

TEST(Report, ABusyMachineIsSaid) {
    bench::study::Cells cells = cells_from(
        {{"cost_s_per_s", "cost_lower", "cost_upper"},
         {{"1", "0.9", "1.1"}, {"1", "0.5", "1.1"}, {"1", "0.75", "1.25"}, {"", "", ""}}});
    EXPECT_DOUBLE_EQ(bench::compare::median_spread(cells), 0.25);
    EXPECT_TRUE(says(bench::compare::busy_text(cells), "25 %"));
    cells.resize(1);
    EXPECT_EQ(bench::compare::busy_text(cells), "");
    cells.clear();
    EXPECT_EQ(bench::compare::busy_text(cells), "");
}

TEST(Report, MatchedComplianceThatErrsMoreThanOwnIsTold) {
    bench::study::Cells cells =
        cells_from({{"cell", "scene", "scheme", "options", "rate", "modes", "status", "flags",
                     "error_l2_50ms", "error_l2_50ms_fret", "certificate_l2_50ms_fret",
                     "error_l2_50ms_y", "certificate_l2_50ms_y"},
                    {{"1", "s", "a", "compliance=own levels=2", "44100", "40", "ok", "", "0.1",
                      "0.2", "0.01", "0.1", "0"},
                     {"2", "s", "a", "compliance=matched levels=2", "44100", "40", "ok", "", "0.1",
                      "0.3", "0.01", "0.1", "0"},
                     {"3", "s", "a", "compliance=own levels=3", "44100", "40", "ok", "", "0.1",
                      "0.1", "0.01", "0.01", "0"}}});
    const std::string text = bench::compare::harm_text(cells);
    EXPECT_TRUE(says(text, "in 1 of 1 runs"));
    EXPECT_TRUE(says(text,
                     "most at fret of 30 % by a compliance=matched levels=2, 40 modes at 44.1 kHz, "
                     "where own compliance has 20 %"));
    const auto fret = [&cells]() -> double& {
        return cells[1].figures[1][bench::study::measure("error_l2_50ms")].value;
    };
    fret() = 0.26;  // sure of 0.25, which is not above 1.2 x 0.21
    EXPECT_EQ(bench::compare::harm_text(cells), "");
    fret() = 0.3, cells[0].flags = "energy";  // not to be trusted
    EXPECT_EQ(bench::compare::harm_text(cells), "");
}

TEST(Report, OfASuiteEachCellThatEndedIsHeardAndCellsOfOneSceneShareTheirReference) {
    const Scratch scratch;
    std::ofstream(scratch / "a.toml")
        << suite_of("tanpura_c3_release", "modal_two_point,modal_explicit_penalty", "44100, 88200",
                    "modes = 10\nreference_modes = 'cell'\nduration = 0.03\n"
                    "measure = ['errors', 'sound']\nsweep = { 'string.0.tension' = [30, 31] }");
    const std::string command = "suite " + scratch / "a.toml" + " --json --out " + scratch / "out",
                      none = "JVARI_NODE_MODULES=/nowhere";
    ASSERT_EQ(jvari(scratch, command, none).code, 0);
    const std::string first = content(scratch / "out/sounds.csv"),
                      page = content(scratch / "out/report.html");
    const bench::report::Results r = bench::report::read_results(scratch.path / "out");
    // of each tension the reference and two rates; the penalty force diverges
    ASSERT_EQ(r.sounds.rows.size(), 6u);
    for (std::size_t i = 0; i < 6; ++i) {
        const bool truth = i % 3 == 0;
        EXPECT_EQ(r.sounds.text(i, "scheme"), truth ? "reference" : "modal_two_point");
        EXPECT_EQ(r.sounds.text(i, "reference_file"),
                  truth ? "" : r.sounds.text(i / 3 * 3, "file"));
        EXPECT_EQ(r.sounds.text(i, "problem"), i < 3 ? "tanpura_c3_release, string.0.tension = 30"
                                                     : "tanpura_c3_release, string.0.tension = 31");
        EXPECT_EQ(bench::store::read_wav(scratch.path / "out" / r.sounds.text(i, "file"), 1)
                      .samples.size(),
                  1324u);  // rows at 0 and 30 ms too
    }
    EXPECT_NE(r.sounds.text(0, "file"), r.sounds.text(3, "file"));
    ASSERT_EQ(jvari(scratch, command + " --resume", none).code, 0);
    EXPECT_EQ(content(scratch / "out/sounds.csv"), first);
    const Json sounds = data_of(page).at("sounds");
    ASSERT_EQ(sounds.size(), 6u);
    EXPECT_EQ(sounds[0].at("row"), 0);
    EXPECT_EQ(sounds[0].at("rate"), 44100);
    EXPECT_EQ(bench::store::bytes_of_base64(sounds[0].at("samples").get<std::string>()).size(),
              2u * 1324);
}

Json a_page() {
    return {{"title", "<b>"},
            {"manifest", {{"note", "<!-- </script>"}}},
            {"tables", {{"cells", "</script><script>"}}},
            {"sounds", Json::array()},
            {"left_out", {{"cells", Json::array()}, {"sounds", Json::array()}}}};
}

TEST(Report, NothingInThePageEndsAScriptEarly) {
    EXPECT_EQ(bench::report::inside_script("a</script>b</SCRIPT><!--"),
              "a<\\/script>b<\\/SCRIPT><\\!--");
    EXPECT_EQ(bench::report::inside_script("x</g,1<2"), "x</g,1<2");
    const std::string text = bench::report::page_of(a_page(), "");
    EXPECT_TRUE(says(text, "<title>&lt;b&gt;</title>"));
    EXPECT_EQ(data_of(text).at("tables").at("cells"), "</script><script>");
    EXPECT_EQ(data_of(text).at("manifest").at("note"), "<!-- </script>");
    for (const char* mark : {"@TITLE@", "@STYLE@", "@SCRIPTS@", "@DATA@", "@PROGRAM@"})
        EXPECT_FALSE(says(text, mark)) << mark;
}

TEST(Report, WhatDoesNotFitIsLeftOutFromTheLastOnAndThePageSaysSo) {
    Json page = a_page();
    for (int k = 0; k < 10; ++k)
        page["sounds"].push_back({{"row", k}, {"samples", std::string(40000, 'x')}});
    const std::string whole = bench::report::page_of(page, "");
    EXPECT_EQ(bench::report::fitting_page_of(page, "", whole.size()), whole);
    // two sounds of 40 kB
    const Json data = data_of(bench::report::fitting_page_of(page, "", whole.size() - 70000));
    EXPECT_EQ(data.at("sounds").size(), 8u);
    EXPECT_EQ(data.at("sounds").back().at("row"), 7);
    EXPECT_TRUE(says(data.at("left_out").at("sounds")[0].get<std::string>(), "2 more sounds"));
}

// 60 copies of the made-up cells, each a scene of its own: too many for a page of 200 kB more than
// one without tables.
TEST(Report, APageOfManyCellsKeepsItsSizeAndTheBestOfEachScheme) {
    const Folder folder(every_file);
    for (const char* name : {"facts.csv", "errors.csv", "cost.csv"}) {
        const bench::store::Table t = bench::store::read_csv(content(folder / name));
        bench::store::Table all{t.columns, {}};
        for (int k = 0; k < 60; ++k)
            for (auto row : t.rows) {
                for (const char* key : {"cell", "scene"})
                    if (const int at = t.column(key); at >= 0)
                        row[at] = fmt::format("{}_{}", row[at].text(), k);
                all.rows.push_back(row);
            }
        overwrite(folder / name, bench::store::csv(all));
    }
    const bench::report::Results results = bench::report::read_results(folder.path);
    const Json whole = bench::report::data_of(results, bench::report::tables_of(results));
    const std::size_t bare = bench::report::page_of(a_page(), "").size(), limit = bare + 200'000;
    ASSERT_GT(bench::report::page_of(whole, "").size(), limit);
    const std::string page = bench::report::fitting_page_of(results, whole, "", limit);
    EXPECT_LE(page.size(), limit);
    const Json data = data_of(page);
    const auto cells = [](const Json& of) { return of.at("tables").at("cells").at("rows").size(); };
    EXPECT_GT(cells(data), 20u);
    EXPECT_LT(cells(data), results.cells.size());
    EXPECT_TRUE(
        says(data.at("left_out").at("cells").dump(),
             fmt::format("{} of {} cells are in this page", cells(data), results.cells.size())));
    // fewer than there are schemes and problems would be needed for all of them
    const bench::report::Results some = bench::report::best_of(results, results.cells.size() / 2);
    std::set<std::string> before, after;
    for (const auto* r : {&results, &some})
        for (const auto& c : r->cells)
            (r == &some ? after : before).insert(c.problem() + "|" + c.scheme);
    EXPECT_EQ(before, after);
    // a table that fits no page goes whole
    EXPECT_LE(bench::report::fitting_page_of(results, whole, "", bare + 5000).size(), bare + 5000);
}

TEST(Report, ATableThatWouldBeTooLargeKeepsTheColumnsThatChartsNeedAndSaysSo) {
    bench::store::Table t{{"scheme", "rate", "much"}, {}};
    t.rows.assign(2000, {"a", "44100", std::string(1000, 'x')});
    Json notes = Json::array();
    EXPECT_EQ(bench::report::fitting(t, notes).columns,
              (std::vector<std::string>{"scheme", "rate"}));
    EXPECT_EQ(notes.size(), 1u);
    t.rows.resize(1000);
    EXPECT_EQ(bench::report::fitting(t, notes).columns.size(), 3u);
    EXPECT_EQ(notes.size(), 1u);
}

TEST(Pareto, ADifferenceInsideTheSpreadDecidesNothing) {
    const std::vector<bench::compare::Point> apart{{1, 0.9, 1.1, 1e-3}, {2, 1.9, 2.1, 1e-3}};
    EXPECT_EQ(pareto_front(apart), (std::vector<bool>{true, false}));
    const std::vector<bench::compare::Point> tied{{1, 0.9, 1.6, 1e-3}, {2, 1.5, 2.1, 1e-3}};
    EXPECT_EQ(pareto_front(tied), (std::vector<bool>{true, true}));
    const std::vector<bench::compare::Point> tied_cost_less_error{{1, 0.9, 1.6, 1e-3},
                                                                  {2, 1.5, 2.1, 1e-4}};
    EXPECT_EQ(pareto_front(tied_cost_less_error), (std::vector<bool>{false, true}));
    const std::vector<bench::compare::Point> unsound{
        {1, 1, 1, HUGE_VAL}, {NAN, NAN, NAN, 1e-9}, {3, 3, 3, 1e-3}};
    EXPECT_EQ(pareto_front(unsound), (std::vector<bool>{false, false, true}));
}

}  // namespace
}  // namespace jvari::test
