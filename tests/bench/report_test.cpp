// The report of a folder: a section where there is data and none where there is not, each with what its files say. The folder is made up.
#include "bench/report/report.hpp"

#include <fmt/core.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "bench/compare/record/spread.hpp"
#include "bench/report/chart_data.hpp"
#include "bench/report/identity.hpp"
#include "bench/report/sections/page_sections.hpp"
#include "bench/store/sound.hpp"
#include "tests/command_line.hpp"

namespace jvari::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct MadeUp : Scratch {  // some of the files
    explicit MadeUp(const std::vector<std::string>& files) {
        for (const std::string& name : files) fs::copy_file(fs::path(JVARI_MADE_UP_RESULTS) / name, path / name);
    }
};
const std::vector<std::string> every_file{"manifest.json", "cells.csv", "dispersion.csv", "convergence.csv",
                                          "scaling.csv",   "maps.csv",  "boundaries.csv", "others.svg"};

Json data_of(const std::string& page) {
    const auto from = page.find("id=\"data\">") + 10;
    return Json::parse(page.substr(from, page.find("</script>", from) - from));
}

std::vector<std::string> choices_of(const bench::report::Chart& c, const std::string& signal) {
    std::vector<std::string> choices;
    for (const bench::report::Menu& m : c.menus)
        if (m.signal == signal)
            for (const auto& [value, text] : m.choices) choices.push_back(Json::parse(value));
    return choices;
}

Json value_of(const Json& spec, const std::string& parameter) {
    for (const Json& p : spec.at("params"))
        if (p.at("name") == parameter) return p.at("value");
    return nullptr;
}

TEST(Report, WithoutThePackagesItHasTheTablesAndSaysWhatIsMissing) {
    const MadeUp folder(every_file);
    const Outcome o = jvari(folder, "report " + folder.path.string(), "JVARI_NODE_MODULES=/nowhere");
    ASSERT_EQ(o.code, 0) << o.err;
    const Json data = data_of(content(folder / "report.html"));
    std::vector<std::string> headings;
    for (const Json& s : data.at("sections")) headings.push_back(s.at("heading"));
    EXPECT_EQ(headings, (std::vector<std::string>{"Convergence", "Cost", "How often each scheme stays sound", "Where methods fail",
                                                  "Figures", "Cells"}));
    EXPECT_NE(data.at("missing").get<std::string>().find("npm ci"), std::string::npos);
    EXPECT_EQ(data.at("manifest").at("suite"), "made up");
    for (const auto& entry : fs::directory_iterator(folder.path))
        EXPECT_TRUE(entry.path().extension() != ".svg" || entry.path().filename() == "others.svg") << entry.path();
}

TEST(Report, SectionsWithoutDataDoNotAppear) {
    const MadeUp folder({"manifest.json", "maps.csv"});
    const Outcome o = jvari(folder, "report " + folder.path.string(), "JVARI_NODE_MODULES=/nowhere");
    ASSERT_EQ(o.code, 0) << o.err;
    const Json sections = data_of(content(folder / "report.html")).at("sections");
    ASSERT_EQ(sections.size(), 1u);  // no boundaries: maps are charts alone, and nothing draws them
    EXPECT_EQ(sections[0].at("id"), "overview");
    const bench::report::Results r = bench::report::read_results(folder.path);
    EXPECT_EQ(map_section(r).charts.size(), 2u);
    for (const bench::report::Section& s :
         {bench::report::work_precision_section(r), bench::report::dispersion_section(r), bench::report::convergence_section(r),
          bench::report::cost_section(r), bench::report::spectrogram_section(r), bench::report::waveform_section(r),
          bench::report::cell_section(r)})
        EXPECT_TRUE(s.charts.empty() && s.table.rows.empty() && s.sounds.empty()) << s.id;
}

TEST(Report, AnOverviewCountsSoundRunsAmongThoseThatWereNotRefused) {
    const MadeUp folder({"manifest.json", "maps.csv"});
    const bench::report::Results r = bench::report::read_results(folder.path);
    const bench::report::Section s = bench::report::overview_section(r);
    EXPECT_EQ(s.table.rows,
              (std::vector<std::vector<std::string>>{{"one", "stiffness x rate", "13", "32"},
                                                     {"one", "exponent x modes", "9", "12"},
                                                     {"two", "stiffness x rate", "15", "29"}}));  // three of two's were refused
    EXPECT_EQ(bench::report::finding_of_maps(r), "2 of 2 schemes fail somewhere; one stays sound on 0 of its 2 maps");
}

TEST(Report, AFolderWithoutResultsIsRefused) {
    const Scratch empty;
    EXPECT_EQ(jvari(empty, "report " + empty.path.string()).code, 2);
    std::ofstream(empty / "cells.csv") << "scheme\na\n";
    EXPECT_EQ(jvari(empty, "report " + empty.path.string()).code, 2);
    std::ofstream(empty / "manifest.json") << "{";
    EXPECT_EQ(jvari(empty, "report " + empty.path.string()).code, 2);
}

TEST(Report, ATableThatWasCutAfterItsHeaderIsRefusedAndThePageStays) {
    for (const char* table : {"cells.csv", "errors.csv"}) {
        const MadeUp folder({"manifest.json", "maps.csv"});
        std::ofstream(folder / table) << "scheme,rate\n";
        std::ofstream(folder / "report.html") << "the page";
        const Outcome o = jvari(folder, "report " + folder.path.string(), "JVARI_NODE_MODULES=/nowhere");
        EXPECT_EQ(o.code, 2);
        EXPECT_NE(o.err.find(std::string(table) + ": it has no row"), std::string::npos) << o.err;
        EXPECT_EQ(content(folder / "report.html"), "the page");
    }
}

TEST(Report, APipeInPlaceOfAFileIsRefused) {
    const MadeUp folder(every_file);
    const Outcome o = shell(folder, "rm manifest.json; mkfifo manifest.json; timeout 20 $J report .");
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("manifest.json: something that is no file"), std::string::npos) << o.err;
}

TEST(Report, TextsThatAreNoUtf8AreShownAsFarAsTheyAre) {
    const MadeUp folder(every_file);
    std::string cells = content(folder / "cells.csv");
    cells.replace(cells.find(",one,"), 5, ",one\xff,");
    std::ofstream(folder / "cells.csv", std::ios::binary) << cells;
    const Outcome o = jvari(folder, "report --json " + folder.path.string(), "JVARI_NODE_MODULES=/nowhere");
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_NE(content(folder / "report.html").find("one\ufffd"), std::string::npos);
}

TEST(Report, AManifestThatIsNestedTooDeepIsRefused) {
    const MadeUp folder(every_file);
    std::ofstream(folder / "manifest.json") << "{\"suite\": \"a\", \"x\": " << std::string(300000, '[') << std::string(300000, ']') << "}";
    EXPECT_EQ(jvari(folder, "report " + folder.path.string()).code, 2);
}

TEST(Report, SoundsLieBelowTheFolder) {
    const Scratch outside;
    std::ofstream(outside / "private.wav", std::ios::binary) << bench::store::wav_of({44100, 1, std::vector<std::int16_t>(4410, 7)});
    for (const std::string& file : {outside / "private.wav", "../" + outside.path.filename().string() + "/private.wav"}) {
        const MadeUp folder(every_file);
        std::ofstream(folder / "sounds.csv") << "scheme,rate,modes,tap,quantity,sample_rate,peak,file,reference_file\none,44100,1,nut,"
                                                "nut_force,44100,1,"
                                             << file << ",\n";
        const Outcome o = jvari(folder, "report " + folder.path.string(), "JVARI_NODE_MODULES=/nowhere");
        EXPECT_EQ(o.code, 2) << o.err;
        EXPECT_NE(o.err.find("expected one below the folder"), std::string::npos) << o.err;
    }
}

TEST(Report, PicturesOfDifferentProblemsHaveDifferentNames) {
    const std::string start = "a, " + std::string(200, 'x');
    const std::vector<std::string> problems{"a, height = -0.001", "a, height = 0.001", "a, k = 1e-05", "a, k = 1e+05", "a, name = (x)",
                                            "a, name = [x]",      start + " = 1",      start + " = 2", "a, n = a b",   "a, n = a,b"};
    std::set<std::string> files;
    for (const std::string& p : problems) {
        const std::string file = bench::report::twin_file("map", p, problems);
        EXPECT_TRUE(files.insert(file).second) << file;
        EXPECT_LE(file.size(), 108u);
        EXPECT_EQ(file.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_.+-"), std::string::npos) << file;
    }
    EXPECT_TRUE(files.contains("map-a-height--0.001.svg"));
    EXPECT_TRUE(files.contains("map-a-height-0.001.svg"));  // as it was: it meets none
    EXPECT_TRUE(files.contains("map-a-k-1e+05.svg"));
}

TEST(Report, OnlyRunsOfOneSceneAtOneSweptPointAreCompared) {
    const MadeUp folder(every_file);
    const bench::report::Results r = bench::report::read_results(folder.path);
    const bench::report::Section s = bench::report::work_precision_section(r);
    ASSERT_EQ(s.charts.size(), 1u);
    const std::vector<std::string> problems{"a, string.0.tension = 30", "a, string.0.tension = 31", "b, string.0.tension = 30",
                                            "b, string.0.tension = 31"};
    EXPECT_EQ(choices_of(s.charts[0], "problem_field"), problems);
    const Json spec = Json::parse(s.charts[0].spec);
    // "one" has the least error at each rate and the least cost: it alone is on the front of each problem, with that problem's errors.
    std::vector<double> of_b;
    for (const Json& f : spec.at("datasets").at("fronts")) {
        if (f.at("cost") != "cost_s_per_s" || f.at("error") != "error_l2_50ms") continue;
        EXPECT_NE(f.at("key").get<std::string>().find("|one|"), std::string::npos) << f.at("key");
        if (f.at("problem") == problems[2]) of_b.push_back(f.at("y"));
    }
    EXPECT_EQ(of_b, (std::vector<double>{0.15, 0.0375, 0.009375, 0.00234375}));
    EXPECT_EQ(s.charts[0].twins.size(), 4u);
    const Json twin = Json::parse(s.charts[0].twins[2].spec);
    EXPECT_EQ(s.charts[0].twins[2].file, "work_precision-b-string.0.tension-30.svg");
    for (const Json& c : twin.at("datasets").at("cells")) EXPECT_EQ(c.at("problem"), problems[2]);
}

TEST(Report, NoiseFloorAndCertificateAreOfTheSceneAndTheErrorThatIsShown) {
    const MadeUp folder(every_file);
    const Json bands =
        value_of(Json::parse(bench::report::work_precision_section(bench::report::read_results(folder.path)).charts[0].spec), "bands");
    EXPECT_EQ(bands.at("a, string.0.tension = 30|error_l2_50ms").at("floor"), 2e-3);
    EXPECT_EQ(bands.at("a, string.0.tension = 30|error_l2_50ms").at("certificate"), 4e-3);
    EXPECT_EQ(bands.at("b, string.0.tension = 30|error_l2_50ms").at("floor"), 1e-12);
    EXPECT_FALSE(bands.at("b, string.0.tension = 30|error_l2_50ms").contains("certificate"));
    EXPECT_FALSE(bands.contains("a, string.0.tension = 30|error_l2_10ms"));
}

TEST(Report, TheCheapestThatReachesAnAccuracyIsNamedWhereSomeReachItAndSomeDoNot) {
    const MadeUp folder(every_file);
    const Json spec = Json::parse(bench::report::work_precision_section(bench::report::read_results(folder.path)).charts[0].spec);
    std::map<std::string, std::vector<std::string>> of_problem;
    for (const Json& g : spec.at("datasets").at("goals")) {
        EXPECT_EQ(g.at("error"), "error_l2_50ms");
        of_problem[g.at("problem")].push_back(g.at("text"));
    }
    EXPECT_TRUE(of_problem["b, string.0.tension = 30"].empty());  // no certificate there: nothing is certain
    // there the reference is certain to 4e-3: 0.1 at 44.1 kHz is not known to be within 10 %, 6.25e-3 at 176.4 kHz not within 1 %
    EXPECT_EQ(of_problem["a, string.0.tension = 30"],
              (std::vector<std::string>{"10 %: one, 40 modes at 88.2 kHz", "1 %: one, 40 modes at 352.8 kHz"}));
}

TEST(Report, TheVerdictNamesSchemeRateErrorCostAndCertaintyOfEachScene) {
    const MadeUp folder(every_file);
    const auto verdicts = verdicts_of(bench::report::read_results(folder.path));
    ASSERT_EQ(verdicts.size(), 4u);
    EXPECT_EQ(verdicts[0].scene, "a, string.0.tension = 30");
    const bench::report::Answer first = verdicts[0].answers.at(0);  // e = 2.5e-2 and c = 4e-3 at 88.2 kHz
    EXPECT_EQ(first.within, "waveform within 10 %, first 50 ms");
    EXPECT_EQ((std::vector<std::string>{first.scheme, first.modes, first.rate, first.error, first.cost}),
              (std::vector<std::string>{"one", "40", "88.2 kHz", "\u2264 2.9\u00a0%", "20 ms"}));
    EXPECT_EQ(first.certain.substr(0, 11), "upper bound");
    EXPECT_EQ(verdicts[0].finding.substr(0, 20), "one errs by at most ");  // of the cheapest within 1 %
    EXPECT_NE(verdicts[0].finding.find(" at 352.8 kHz, "), std::string::npos) << verdicts[0].finding;
    const bench::report::Answer unknown = verdicts[2].answers.at(1);  // no certificate there
    EXPECT_EQ(unknown.scheme, "cannot be decided");
    EXPECT_EQ(unknown.certain.substr(0, 44), "the uncertainty of the reference is unknown;");
    EXPECT_EQ(verdicts[2].finding.find("errs by"), std::string::npos) << verdicts[2].finding;
    EXPECT_NE(verdicts[0].sentences.at(0).find("Reference: truth"), std::string::npos) << verdicts[0].sentences.at(0);
}

TEST(Report, AControlIsInTheVerdictOnlyWhereTheManifestSaysThatControlsCompete) {
    const MadeUp folder(every_file);
    std::string cells = content(folder / "cells.csv");
    for (auto at = cells.find(",one,"); at != std::string::npos; at = cells.find(",one,")) cells.replace(at, 5, ",modal_explicit_penalty,");
    std::ofstream(folder / "cells.csv", std::ios::binary) << cells;
    const auto verdict = [&folder] { return verdicts_of(bench::report::read_results(folder.path)).at(0).answers.at(0).scheme; };
    EXPECT_EQ(verdict(), "three <b>");
    std::ofstream(folder / "manifest.json") << R"({"suite": "made up", "controls": true})";
    EXPECT_EQ(verdict(), "modal_explicit_penalty");
}

// What a record keeps of a suite: errors and costs, each in a file of its own.
struct Record : MadeUp {
    Record() : MadeUp({"manifest.json", "cells.csv"}) {
        const bench::store::Table cells = bench::store::read_csv(content(*this / "cells.csv"));
        const std::vector<std::string> clocked{"cost_s_per_s", "cost_lower", "cost_upper", "ns_per_step"};
        std::vector<std::string> rest;
        for (const std::string& name : cells.columns)
            if (std::find(clocked.begin(), clocked.end(), name) == clocked.end()) rest.push_back(name);
        std::vector<std::string> cost{"cell", "scene", "scheme", "rate"};
        cost.insert(cost.end(), clocked.begin(), clocked.end());
        std::ofstream(*this / "errors.csv", std::ios::binary) << bench::store::csv(cells.only(rest));
        std::ofstream(*this / "cost.csv", std::ios::binary) << bench::store::csv(cells.only(cost));
        fs::remove(path / "cells.csv");
    }
};

TEST(Report, IsMadeOfARecordsErrorsAndCostsAsOfItsCells) {
    const Record record;
    const MadeUp whole({"manifest.json", "cells.csv"});
    const auto drawn = [](const fs::path& folder) {
        const bench::report::Results r = bench::report::read_results(folder);
        return work_precision_section(r).charts.at(0).spec + verdicts_of(r).at(0).answers.at(0).modes;
    };
    EXPECT_EQ(drawn(record.path), drawn(whole.path));
    std::string cost = content(record / "cost.csv");
    cost.replace(cost.find("88200"), 5, "88300");
    std::ofstream(record / "cost.csv", std::ios::binary) << cost;
    const Outcome o = jvari(record, "report " + record.path.string(), "JVARI_NODE_MODULES=/nowhere");
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("cost.csv: its rows are not those of errors.csv"), std::string::npos) << o.err;
}

TEST(Report, WhatIsSweptHasAChartOfErrorAlongIt) {
    const MadeUp folder(every_file);
    const bench::report::Section s = bench::report::sweep_section(bench::report::read_results(folder.path));
    ASSERT_EQ(s.charts.size(), 1u);
    EXPECT_EQ(choices_of(s.charts[0], "base_field"), (std::vector<std::string>{"a", "b"}));
    const Json spec = Json::parse(s.charts[0].spec);
    EXPECT_EQ(spec.at("encoding").at("x").at("axis").at("title"), "tension [N]");
    using Place = std::tuple<std::string, double, std::string, double>;  // scene, tension, scheme, rate
    std::map<Place, double> drawn, cells;                                // the error there
    for (const Json& row : spec.at("datasets").at("rows"))
        if (row.at("error_l2_10ms").is_number())
            drawn[{row.at("base"), row.at("at"), row.at("series"), row.at("rate")}] = row.at("error_l2_10ms");
    const bench::store::Table t = bench::store::read_csv(content(folder / "cells.csv"));
    for (std::size_t i = 0; i < t.rows.size(); ++i)
        if (const double error = t.number(i, "error_l2_10ms"); std::isfinite(error))
            cells[{t.at(i, "scene"), t.number(i, "string.0.tension"), t.at(i, "scheme"), t.number(i, "rate")}] = error;
    EXPECT_EQ(drawn, cells);
    std::set<double> places;
    for (const auto& [place, error] : drawn) places.insert(std::get<1>(place));
    EXPECT_EQ(places, (std::set<double>{30, 31}));
    ASSERT_EQ(s.charts[0].twins.size(), 2u);
    EXPECT_EQ(s.charts[0].twins[0].file, "sweep-string.0.tension-a.svg");
}

TEST(Report, StepsToATrimmedSceneHaveTheLookOfTheirSchemes) {
    bench::report::Results r;
    r.path = {
        {"step", "change", "scheme", "options", "modes", "rate", "error", "certificate", "within", "target", "cost_s_per_s", "measure"},
        {{"0", "whole", "modal_two_point", "", "", "88200", "0.03", "0.001", "no", "0.01", "0.2", "L2"},
         {"1", "less", "modal_two_point", "compliance=matched", "20", "44100", "0.009", "0.001", "yes", "0.01", "0.1", "L2"},
         {"2", "least", "finite_difference_theta", "", "", "44100", "0.009", "0.001", "yes", "0.01", "0.05", "L2"}}};
    const std::vector<std::string> names{"modal_two_point", "modal_two_point compliance=matched", "finite_difference_theta"};
    const auto looks = bench::report::identities_of(names);
    const bench::report::Section s = bench::report::path_section(r);
    for (const std::string& text : {s.charts.at(0).spec, s.charts.at(0).twins.at(0).spec}) {
        const Json spec = Json::parse(text), costs = spec.at("hconcat").at(0), errors = spec.at("hconcat").at(1).at("layer").back();
        const Json& point = costs.at("layer").back();
        for (const auto& [what, encoding] :
             std::vector<std::pair<std::string, Json>>{{"colour", costs.at("encoding").at("color")},
                                                       {"colour", errors.at("encoding").at("color")},
                                                       {"shape", point.at("encoding").at("shape")},
                                                       {"shape", errors.at("encoding").at("shape")},
                                                       {"dash", costs.at("layer").at(0).at("encoding").at("strokeDash")},
                                                       {"dash", costs.at("layer").at(1).at("encoding").at("strokeDash")}}) {
            EXPECT_EQ(encoding.at("scale").at("domain"), names) << what;
            for (std::size_t k = 0; k < names.size(); ++k)
                EXPECT_EQ(encoding.at("scale").at("range").at(k), what == "colour"  ? Json(looks[k].colour)
                                                                  : what == "shape" ? Json(looks[k].shape)
                                                                                    : Json(looks[k].dash))
                    << names[k];
        }
        for (std::size_t k = 0; k < names.size(); ++k) EXPECT_EQ(spec.at("datasets").at("steps").at(k).at("series"), names[k]);
    }
}

TEST(Report, ErrorFallsAlongModesInOneLineForEachScheme) {
    const MadeUp folder({"manifest.json"});
    std::ofstream(folder / "cells.csv") << "cell,scene,scheme,options,rate,modes,status,flags,error_l2_50ms\n"
                                           "1,a,modal_strang,,88200,10,ok,,0.1\n2,a,modal_strang,,88200,20,ok,,0.01\n"
                                           "3,a,finite_difference_theta,,88200,155,ok,,0.1\n"  // a grid: its nodes go with the rate
                                           "4,a,finite_difference_theta,,176400,225,ok,,0.05\n";
    const bench::report::Section s = bench::report::sweep_section(bench::report::read_results(folder.path));
    ASSERT_EQ(s.charts.size(), 1u);
    const Json spec = Json::parse(s.charts[0].spec);
    EXPECT_EQ(spec.at("encoding").at("x").at("axis").at("title"), "modes");
    const Json rows = spec.at("datasets").at("rows");
    ASSERT_EQ(rows.size(), 2u);
    for (const Json& row : rows) EXPECT_EQ(row.at("series"), "modal_strang");
    EXPECT_EQ(rows[1].at("at"), 20);
    EXPECT_EQ(rows[1].at("error_l2_50ms"), 0.01);
    EXPECT_EQ(s.charts[0].twins.at(0).file, "sweep-modes.svg");
}

TEST(Report, OfModesAndRatesTheBestOfEachSchemeAreOneLine) {
    const MadeUp folder({"manifest.json"});
    const auto row = [](const char* cell, const char* modes, const char* rate, const char* status, const char* error, const char* cost) {
        return fmt::format("{},a,modal_strang,compliance=own,{},{},{},,{},0,{},{},{}\n", cell, rate, modes, status, error, cost, cost,
                           cost);
    };
    std::ofstream(folder / "cells.csv")
        << "cell,scene,scheme,options,rate,modes,status,flags,error_l2_50ms,certificate_l2_50ms,cost_s_per_s,cost_lower,cost_upper\n"
        << row("1", "10", "44100", "ok", "0.1", "1") << row("2", "10", "88200", "ok", "0.08", "2")
        << row("3", "20", "88200", "ok", "0.02", "1.9")  // beats the second
        << row("4", "20", "176400", "not_needed", "0.03", "");
    const bench::report::Results results = bench::report::read_results(folder.path);
    const Json cells = Json::parse(bench::report::work_precision_section(results).charts.at(0).spec).at("datasets").at("cells");
    ASSERT_EQ(cells.size(), 2u);
    for (const Json& cell : cells) EXPECT_EQ(cell.at("series"), "modal_strang compliance=own");
    EXPECT_EQ(cells[0].at("label"), "10 modes, 44.1 kHz");
    EXPECT_EQ(cells[1].at("label"), "20 modes, 88.2 kHz");
    const auto sentences = bench::report::verdicts_of(results).at(0).sentences;
    EXPECT_TRUE(std::ranges::any_of(sentences, [](const std::string& s) { return s.starts_with("3 of 4 runs succeeded, 1 left out"); }));
}

TEST(Report, ABandIsOfTheReferenceOfAllPointsOrNotThere) {
    const auto bands = [](const char* second) {
        const MadeUp folder({"manifest.json"});
        std::ofstream(folder / "cells.csv")
            << "cell,scene,scheme,options,rate,modes,status,flags,error_l2_50ms,certificate_l2_50ms,cost_s_per_s,cost_lower,cost_upper\n"
            << "1,a,modal_strang,,44100,10,ok,,0.1,0.002,1,1,1\n2,a,exact_contact,,,10,ok,,0.0007," << second << ",1,1,1\n";
        const auto spec = Json::parse(bench::report::work_precision_section(bench::report::read_results(folder.path)).charts.at(0).spec);
        for (const Json& p : spec.at("params"))
            if (p.at("name") == "bands") return p.at("value");
        return Json();
    };
    EXPECT_EQ(bands("0.002").at("a|error_l2_50ms").at("certificate"), 0.002);
    EXPECT_FALSE(bands("0.0002").contains("a|error_l2_50ms"));  // 0.07 % is known of the second, and not of the first
}

TEST(Report, ABusyMachineIsSaid) {
    bench::store::Table cells{{"cost_s_per_s", "cost_lower", "cost_upper"},
                              {{"1", "0.9", "1.1"}, {"1", "0.5", "1.1"}, {"1", "0.75", "1.25"}, {"", "", ""}}};
    EXPECT_DOUBLE_EQ(bench::compare::median_spread(cells), 0.25);
    EXPECT_NE(bench::compare::busy_text(cells).find("25 %"), std::string::npos);
    cells.rows.resize(1);
    EXPECT_EQ(bench::compare::busy_text(cells), "");
    cells.rows.clear();
    EXPECT_EQ(bench::compare::busy_text(cells), "");
}

TEST(Report, OrdersAreThoseOfTheFileWhereItHasThemElseOfTheCells) {
    const MadeUp folder(every_file);
    const bench::report::Section s = bench::report::convergence_section(bench::report::read_results(folder.path));
    const Json orders = value_of(Json::parse(s.charts.at(0).spec), "orders");
    EXPECT_EQ(orders.at("a, string.0.tension = 30|one|error_l2_50ms"), "1.99 \u00b1 0.05");  // convergence.csv
    const std::string own = orders.at("b, string.0.tension = 31|one|error_l2_50ms");         // 0.15 x 4^-k
    EXPECT_EQ(own.substr(0, 5), "2.00 ");
    const std::string three = orders.at("a, string.0.tension = 31|three <b>|error_l2_50ms");  // 0.1 x 2^-k
    EXPECT_EQ(three.substr(0, 5), "1.00 ");
    EXPECT_EQ(s.table.column("series"), -1);
    EXPECT_EQ(s.table.rows.size(), 4u);
}

TEST(Report, ErrorsBelowTheirNoiseFloorHaveNoOrder) {
    const MadeUp folder({"manifest.json", "cells.csv"});
    const bench::report::Section s = bench::report::convergence_section(bench::report::read_results(folder.path));
    int seen = 0;
    for (std::size_t i = 0; i < s.table.rows.size(); ++i)
        if (s.table.at(i, "scene") == "a, string.0.tension = 30" && s.table.at(i, "scheme") == "one" &&
            s.table.at(i, "error") == "error_l2_50ms") {
            EXPECT_EQ(s.table.at(i, "points"), "3");  // 0.1 x 4^-3 = 1.56e-3 lies below the floor of 2e-3
            ++seen;
        }
    EXPECT_EQ(seen, 1);
}

TEST(Report, DispersionIsDrawnRateByRateWithDecaysRelativeToTheTrueOnes) {
    const MadeUp folder(every_file);
    const bench::report::Section s = bench::report::dispersion_section(bench::report::read_results(folder.path));
    ASSERT_EQ(s.charts.size(), 1u);
    EXPECT_EQ(choices_of(s.charts[0], "rate_field"), (std::vector<std::string>{"44100", "88200"}));
    const Json rows = Json::parse(s.charts[0].spec).at("datasets").at("rows");
    ASSERT_EQ(rows.size(), 120u);
    EXPECT_NEAR(rows[70].at("own_decay").get<double>(), -1e-3 * rows[70].at("mode").get<double>(), 2e-5);
    EXPECT_TRUE(rows[4].at("trace_decay").is_null());  // an empty field
}

TEST(Report, CostHasAChartOfWhatScalesAndOneOfWhatEachElementAdds) {
    const MadeUp folder(every_file);
    const bench::report::Section s = bench::report::cost_section(bench::report::read_results(folder.path));
    ASSERT_EQ(s.charts.size(), 2u);
    EXPECT_EQ(choices_of(s.charts[0], "what_field"), (std::vector<std::string>{"modes", "contacts"}));
    EXPECT_EQ(Json::parse(s.charts[1].spec).at("datasets").at("rows").size(), 10u);
}

TEST(Report, MapsHoldTheirBoundariesAndTheory) {
    const MadeUp folder(every_file);
    const bench::report::Section s = bench::report::map_section(bench::report::read_results(folder.path));
    ASSERT_EQ(s.charts.size(), 2u);
    EXPECT_EQ(choices_of(s.charts[0], "series_field"), (std::vector<std::string>{"one", "two"}));
    const Json spec = Json::parse(s.charts[0].spec);
    EXPECT_EQ(spec.at("encoding").at("x").at("scale").at("type"), "log");
    EXPECT_EQ(Json::parse(s.charts[1].spec).at("encoding").at("x").at("scale").at("type"), "linear");
    int boundaries = 0;
    bench::report::Results uneven = bench::report::read_results(folder.path);
    std::erase_if(uneven.maps.rows, [&](const auto& row) { return row[uneven.maps.column("x")] == "1e+06"; });
    for (const Json& map : {spec, Json::parse(bench::report::map_section(uneven).charts.at(0).spec)}) {
        std::map<double, std::pair<double, double>> tiles;  // of each place their edges
        for (const Json& row : map.at("datasets").at("rows"))
            if (row.at("kind") == "cell") tiles[row.at("x")] = {row.at("left"), row.at("right")};
        EXPECT_EQ(tiles.contains(1e6), map == spec);
        for (auto tile = tiles.begin(); std::next(tile) != tiles.end(); ++tile) {
            const auto& [x, edges] = *tile;
            EXPECT_NEAR(edges.second / std::sqrt(x * std::next(tile)->first), 1, 1e-12) << x;  // half-way on a logarithmic axis
            EXPECT_NEAR(edges.second / std::next(tile)->second.first, 1, 1e-12) << x;
        }
        EXPECT_LT(tiles.begin()->second.first, tiles.begin()->first);
    }
    EXPECT_NE(spec.at("encoding").at("y").at("axis").at("title").get<std::string>().find("[Hz]"), std::string::npos);
    for (const Json& row : spec.at("datasets").at("rows")) {
        if (row.at("kind") != "boundary") continue;
        ++boundaries;
        EXPECT_NEAR(row.at("theory").get<double>() / row.at("x").get<double>(), 1.2, 1e-3);
    }
    EXPECT_EQ(boundaries, 8);
    EXPECT_EQ(s.table.rows.size(), 8u);
}

TEST(Report, PicturesOfOthersStandInThePageAndItsOwnDoNot) {
    const MadeUp folder(every_file);
    std::ofstream(folder / "dispersion.svg") << "<svg/>";
    const bench::report::Results r = bench::report::read_results(folder.path);
    const bench::report::Section s = bench::report::picture_section(r, {"dispersion.svg"});
    ASSERT_EQ(s.pictures.size(), 1u);
    EXPECT_EQ(s.pictures[0].name, "others");
}

TEST(Report, OfASuiteEachCellThatEndedIsHeardAndCellsOfOneSceneShareTheirReference) {
    const Scratch scratch;
    std::ofstream(scratch / "a.toml")
        << "[[cells]]\nscenes = [\"tanpura_c3_release\"]\nschemes = [\"modal_two_point\", \"modal_explicit_penalty\"]\nrates = [44100, "
           "88200]\n"
           "modes = 10\nreference_modes = \"cell\"\nduration = 0.03\nmeasure = [\"errors\", \"sound\"]\nsweep = { \"string.0.tension\" = "
           "[30, 31] }\n";
    const std::string command = "suite " + scratch / "a.toml" + " --json --out " + scratch / "out", none = "JVARI_NODE_MODULES=/nowhere";
    ASSERT_EQ(jvari(scratch, command, none).code, 0);
    const std::string first = content(scratch / "out/sounds.csv"), page = content(scratch / "out/report.html");
    const bench::report::Results r = bench::report::read_results(scratch.path / "out");
    ASSERT_EQ(r.sounds.rows.size(), 6u);  // of each tension the reference and two rates; the penalty force diverges
    for (std::size_t i = 0; i < 6; ++i) {
        const bool truth = i % 3 == 0;
        EXPECT_EQ(r.sounds.at(i, "scheme"), truth ? "reference" : "modal_two_point");
        EXPECT_EQ(r.sounds.at(i, "reference_file"), truth ? "" : r.sounds.at(i / 3 * 3, "file"));
        EXPECT_EQ(r.sounds.at(i, "problem"),
                  i < 3 ? "tanpura_c3_release, string.0.tension = 30" : "tanpura_c3_release, string.0.tension = 31");
        EXPECT_EQ(bench::store::read_wav(scratch.path / "out" / r.sounds.at(i, "file"), 1).samples.size(),
                  1324u);  // rows at 0 and 30 ms too
    }
    EXPECT_NE(r.sounds.at(0, "file"), r.sounds.at(3, "file"));
    ASSERT_EQ(jvari(scratch, command + " --resume", none).code, 0);
    EXPECT_EQ(content(scratch / "out/sounds.csv"), first);
    const Json sections = data_of(page).at("sections");
    const auto heard = std::find_if(sections.begin(), sections.end(), [](const Json& x) { return x.at("id") == "sounds"; });
    ASSERT_NE(heard, sections.end());
    EXPECT_EQ(heard->at("sounds").size(), 6u);
    EXPECT_EQ(heard->at("sounds")[0].at("scheme"), "reference exact_contact");
}

TEST(Report, WhatDoesNotFitIsLeftOutFromTheLastOnAndThePageSaysSo) {
    bench::report::Page page;
    page.manifest = "{}";
    page.sections = {{"sounds", "Sounds"}, {"figures", "Figures"}};
    page.sections[0].sounds.assign(10, {"a", "44100 Hz", std::string(30000, 'x')});
    page.sections[1].pictures.assign(2, {"b", std::string(30000, 'y')});
    EXPECT_EQ(fitting_page_of(page), page_of(page));
    const std::string text =
        bench::report::fitting_page_of(page, bench::report::page_of(page).size() - 150000);  // two pictures and two sounds of 40 kB
    const Json sections = data_of(text).at("sections");
    ASSERT_EQ(sections.size(), 2u);
    EXPECT_EQ(sections[1].at("pictures").size(), 0u);
    EXPECT_EQ(sections[1].at("left_out").size(), 1u);
    EXPECT_EQ(sections[0].at("sounds").size(), 8u);
    EXPECT_NE(sections[0].at("left_out")[0].get<std::string>().find("2 more sounds"), std::string::npos);
    EXPECT_LT(text.size(), page_of(page).size() - 150000);
}

TEST(Report, ATableThatWouldBeTooLargeKeepsItsFirstColumnsAndSaysSo) {
    bench::report::Page page;
    page.manifest = "{}";
    page.sections = {{"cells", "Cells"}};
    bench::report::Section& s = page.sections[0];
    s.table.columns = {"scheme", "rate", "much"};
    s.first_columns = {"scheme", "rate"};
    s.table.rows.assign(2000, {"a", "44100", std::string(1000, 'x')});
    const std::string text = bench::report::page_of(page);
    EXPECT_LT(text.size(), bench::report::table_limit);
    const Json section = data_of(text).at("sections").at(0);
    EXPECT_EQ(section.at("table").at("columns"), (std::vector<std::string>{"scheme", "rate"}));
    EXPECT_EQ(section.at("left_out").size(), 1u);
}

}  // namespace
}  // namespace jvari::test
