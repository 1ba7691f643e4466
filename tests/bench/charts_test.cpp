// What the charts are given to draw: every cell once, the front as the rule says, nothing that ends a script early.
#include "bench/report/charts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "bench/compare/record/pareto.hpp"
#include "bench/report/identity.hpp"
#include "bench/report/page.hpp"
#include "bench/report/page_text.hpp"
#include "bench/report/vega.hpp"
#include "schemes/controls.hpp"
#include "schemes/registry.hpp"

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
    EXPECT_EQ(cells[1].at("label"), "88.2 kHz");
    EXPECT_NEAR(cells[1].at("quartile_lower").get<double>(), 0.95, 1e-6);
    EXPECT_NEAR(cells[1].at("quartile_upper").get<double>(), 1.05, 1e-6);
    EXPECT_TRUE(cells[3].at("error_l2_50ms").is_null());
    const auto value_of = [&spec](const char* name) {
        for (const auto& p : spec.at("params"))
            if (p.at("name") == name) return p.at("value");
        return nlohmann::json();
    };
    EXPECT_EQ(value_of("measure_field"), "error_l2_50ms");
    EXPECT_EQ(value_of("tap_field"), "");
    EXPECT_EQ(value_of("bands").at("|error_l2_50ms").at("floor"), 1e-12);
    EXPECT_EQ(value_of("bands").at("|error_l2_50ms").at("certificate"), 1e-9);
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

TEST(Charts, AControlIsOnTheFrontOnlyWhereItCompetes) {
    bench::report::WorkPrecision w = sample();
    for (const std::size_t i : {0, 1}) w.cells.rows[i][0] = "modal_explicit_penalty";
    const auto front = [&w] {
        std::vector<double> x;
        const auto spec = nlohmann::json::parse(bench::report::work_precision_spec(w));
        for (const auto& f : spec.at("datasets").at("fronts"))
            if (f.at("cost") == "cost_s_per_s" && f.at("error") == "error_l2_50ms") x.push_back(f.at("x"));
        return x;
    };
    EXPECT_EQ(front(), (std::vector<double>{0.03}));
    w.controls = bench::compare::Controls::compete;
    EXPECT_EQ(front(), (std::vector<double>{0.01, 0.02}));
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
            EXPECT_NEAR(f.at("y").get<double>(), f.at("key").get<std::string>().ends_with("|44100|133") ? 1e-2 : 1.6e-3, 1e-12) << f;
        }
    }
    bool hollow = false;
    for (const auto& layer : spec.at("layer"))
        for (const auto& step : layer.value("transform", nlohmann::json::array()))
            hollow = hollow || (step.contains("filter") && step["filter"].is_string() &&
                                step["filter"].get<std::string>().find("datum.flags != ''") != std::string::npos);
    EXPECT_TRUE(hollow);
}

// ---- Identity

using Rgb = std::array<double, 3>;

Rgb linear(const std::string& hex) {  // sRGB, IEC 61966-2-1
    Rgb c;
    for (std::size_t k = 0; k < 3; ++k) {
        const double x = std::stoi(hex.substr(1 + 2 * k, 2), nullptr, 16) / 255.0;
        c[k] = x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
    }
    return c;
}

Rgb times(const std::array<Rgb, 3>& m, const Rgb& v) {
    Rgb r{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) r[i] += m[i][k] * v[k];
    return r;
}
constexpr std::array<Rgb, 3> to_xyz{
    {{0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}}};

Rgb lab(Rgb rgb) {  // CIELAB under D65
    for (double& x : rgb) x = std::clamp(x, 0.0, 1.0);
    Rgb f = times(to_xyz, rgb);
    constexpr Rgb white{0.95047, 1, 1.08883};
    for (std::size_t k = 0; k < 3; ++k)
        f[k] = f[k] / white[k] > 0.008856 ? std::cbrt(f[k] / white[k]) : 7.787 * f[k] / white[k] + 16.0 / 116;
    return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

// Sight without the cones for long, middle and short waves: Machado, Oliveira & Fernandes 2009, severity 1.
constexpr std::array<std::array<Rgb, 3>, 4> sights{
    {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
     {{{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}},
     {{{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}},
     {{{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}}}}};

double contrast(const std::string& a, const std::string& b) {  // WCAG 2
    const double p = times(to_xyz, linear(a))[1] + 0.05, q = times(to_xyz, linear(b))[1] + 0.05;
    return std::max(p, q) / std::min(p, q);
}

std::string css_colour(const std::string& name, bool dark) {
    const std::string css = bench::report::page_text("page.css");
    const auto at = css.find("--" + name + ": #", dark ? css.find("prefers-color-scheme: dark") : 0);
    std::string hex = css.substr(css.find('#', at), 7);
    if (hex[4] == ';') hex = {'#', hex[1], hex[1], hex[2], hex[2], hex[3], hex[3]};
    return hex;
}

TEST(Identity, FamiliesAreToldApartByEveryKindOfSightAndSeenOnTheirPage) {
    for (const bool dark : {false, true}) {
        const auto families = bench::report::families();
        for (std::size_t i = 0; i < families.size(); ++i) {
            const std::string one = dark ? families[i].dark : families[i].light;
            EXPECT_GE(contrast(one, css_colour("paper", dark)), 3) << one;
            for (std::size_t k = 0; k < i; ++k)
                for (std::size_t sight = 0; sight < sights.size(); ++sight) {
                    const std::string other = dark ? families[k].dark : families[k].light;
                    const Rgb p = lab(times(sights[sight], linear(one))), q = lab(times(sights[sight], linear(other)));
                    EXPECT_GE(std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]), 15)
                        << families[i].name << " and " << families[k].name << (dark ? ", dark" : ", light") << ", sight " << sight;
                }
        }
    }
}

TEST(Identity, TextOfThePageHasAContrastOfFourAndAHalf) {
    for (const bool dark : {false, true})
        for (const char* ink : {"ink", "soft", "bad", "key"})
            for (const char* ground : {"paper", "raised"})
                EXPECT_GE(contrast(css_colour(ink, dark), css_colour(ground, dark)), 4.5) << ink << ground << dark;
}

TEST(Identity, TheFrontIsSeenOnItsPageAndTheLinesOnItToo) {
    for (const bool dark : {false, true}) {
        const auto shade = [dark](const bench::report::Neutral& n) { return dark ? n.dark : n.light; };
        EXPECT_GE(contrast(shade(bench::report::front_edge), css_colour("paper", dark)), 3) << dark;
        EXPECT_EQ(shade(bench::report::ink), css_colour("ink", dark));
        for (const bench::report::Family& f : bench::report::families())
            EXPECT_GE(contrast(shade(bench::report::front_track), dark ? f.dark : f.light), 2.5) << f.name;
    }
    std::vector<std::string> drawn;
    const auto spec = nlohmann::json::parse(bench::report::work_precision_spec(sample()));
    for (const auto& layer : spec.at("layer"))
        if (layer.contains("data") && layer.at("data").value("name", "") == "fronts") {
            drawn.push_back(layer.at("mark").at("color"));
            EXPECT_EQ(layer.at("mark").value("opacity", 1.0), 1);
        }
    EXPECT_EQ(drawn, (std::vector<std::string>{bench::report::front_edge.light, bench::report::front_track.light}));
    bench::report::Page page;
    page.manifest = "{}";
    const std::string text = bench::report::page_of(page), data = text.substr(text.find("id=\"data\">") + 10);
    const auto darker = nlohmann::json::parse(data.substr(0, data.find("</script>"))).at("dark");
    for (const bench::report::Neutral& n : {bench::report::ink, bench::report::front_edge, bench::report::front_track})
        EXPECT_EQ(darker.at(n.light), n.dark);
}

TEST(Identity, NoChartHasAHueOfItsOwn) {  // outcomes of a map are no schemes
    const std::regex colour("#([0-9a-f]{6}|[0-9a-f]{3})\"");
    int charts = 0;
    for (const bench::report::PageText& text : bench::report::page_texts()) {
        const std::string name = text.name, all = text.text;
        if (!name.ends_with(".json") || name == "map.json") continue;
        ++charts;
        for (std::sregex_iterator at(all.begin(), all.end(), colour), end; at != end; ++at) {
            const std::string hex = (*at)[1];
            const std::size_t width = hex.size() / 3;
            EXPECT_TRUE(hex.substr(0, width) == hex.substr(width, width) && hex.substr(width, width) == hex.substr(2 * width))
                << name << ": #" << hex;
        }
    }
    EXPECT_EQ(charts, 8);
}

TEST(Identity, ASchemeLooksTheSameInAnyCompanyAndLikeNoOther) {
    std::vector<std::string> names;
    for (const Descriptor& d : schemes()) names.emplace_back(d.name);
    const auto all = bench::report::identities_of(names);
    std::set<std::pair<std::string, std::string>> seen;
    for (std::size_t i = 0; i < names.size(); ++i) {
        EXPECT_TRUE(seen.emplace(all[i].colour, all[i].shape).second) << names[i];
        const auto alone = bench::report::identities_of({"a plugin", names[i] + " compliance=matched"})[1];
        EXPECT_EQ(std::pair(alone.colour, alone.shape), std::pair(all[i].colour, all[i].shape)) << names[i];
        EXPECT_NE(alone.dash, all[i].dash) << names[i];
        EXPECT_EQ(all[i].control, is_control(schemes()[i])) << names[i];
        if (all[i].control) {
            EXPECT_EQ(all[i].colour, bench::report::families()[bench::report::families().size() - 2].light);
        }
    }
    const auto dash = [](const char* name) { return bench::report::identities_of({name}).front().dash; };
    std::set<std::vector<int>> dashes;  // of what is asked of one scheme
    for (const char* name : {"exact_contact", "exact_contact compliance=own", "exact_contact compliance=matched",
                             "exact_contact compliance=own tolerance=1e-6", "exact_contact compliance=matched tolerance=1e-6"})
        EXPECT_TRUE(dashes.insert(dash(name)).second) << name;
    for (const char* form : {" compliance=own", " compliance=matched"}) {
        const auto plain = dash((std::string("modal_two_point") + form).c_str());
        auto more = dash((std::string("exact_contact") + form + " tolerance=1e-6").c_str());
        more.resize(plain.size());
        EXPECT_EQ(more, plain) << form;
    }
    const auto ordered = bench::report::in_order({"modal_explicit_penalty", "a plugin", "finite_difference_theta", "modal_two_point"});
    EXPECT_EQ(ordered, (std::vector<std::string>{"modal_two_point", "finite_difference_theta", "a plugin", "modal_explicit_penalty"}));
}

TEST(Charts, WhatEndedWellIsNeverDrawnAsFailed) {
    const auto spec = nlohmann::json::parse(bench::report::work_precision_spec(sample()));
    int crosses = 0;
    for (const auto& layer : spec.at("layer"))
        if (layer.at("mark").is_object() && layer.at("mark").value("text", nlohmann::json()) == "\u2715")
            for (const auto& step : layer.at("transform"))
                if (step.contains("filter") && step["filter"].get<std::string>().find("status") != std::string::npos) {
                    ++crosses;
                    EXPECT_EQ(step["filter"], "datum.x > 0 && datum.status != 'ok'");
                }
    EXPECT_EQ(crosses, 1);
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
    for (const char* word : {"a scene", "relative L2 error", "computing time", "a, 88.2 kHz", "\u2715"})
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
