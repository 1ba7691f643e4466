// Figures of a suite: what the file may say, the rows that facets make, and the pictures that Vega-Lite makes of them.
#include <cmath>
#include <iterator>
#include <numbers>

#include "bench/report/vega.hpp"
#include "bench/sound/radiation.hpp"
#include "bench/store/base64.hpp"
#include "bench/study/columns.hpp"
#include "bench/study/run.hpp"
#include "bench/suite/facet.hpp"
#include "bench/suite/suite_plan.hpp"
#include "scenes/modes.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"
#include "tests/command_line.hpp"
#include "tests/suite_text.hpp"

namespace jvari::test {
namespace {

const std::string cells = "[[cells]]\nscenes = [\"free_string\"]\n";  // two lines

// ---- The file

TEST(FigureFile, FiguresInTheSuiteAreRefusedWithWhereTheyStand) {
    EXPECT_TRUE(says(refusal_of(cells + "[[figure]]\nname = \"1\""), "stand beside it in a.vl.json"));
}

TEST(FigureFile, WhatIsWrongWithAFacetIsSaidWithFileLineAndKey) {
    const std::pair<std::string, const char*> cases[] = {
        {"measure = [\"trace\"]", "a.toml:1: cells.0: measure asks for trace, the table trace is missing"},
        {"trace = { taps = [\"nut\"], windows = [[0, 1]] }", "a.toml:3: cells.0.trace: found a table, expected \"trace\" in measure"},
        {"trace = { taps = [\"nut\"], windows = [[1, 0]] }",
         "a.toml:3: cells.0.trace.windows.0: found an array, expected [from, to] with from < to"},
        {"trace = { taps = [\"nut\"] }", "a.toml:3: cells.0.trace: the key windows is missing"},
        {"extent = { taps = [\"nut\"], intervals = 1.5 }", "a.toml:3: cells.0.extent.intervals: found 1.5, expected a whole number"},
        {"profile = { instants = [0], from = 1, to = 0.5, positions = 3 }",
         "a.toml:3: cells.0.profile.to: found 0.5, expected more than from"},
        {"envelope = { taps = [\"nut\"], width_hz = 0, to_hz = 1, points = 1 }",
         "a.toml:3: cells.0.envelope.width_hz: found 0, expected a number > 0"},
        {"taps = [{ name = \"a\", quantity = \"velocty\" }]",
         "a.toml:3: cells.0.taps.0.quantity: unknown quantity \"velocty\"; did you mean"},
        {"taps = [{ name = \"a\", quantity = \"velocity\", string = 0.5 }]",
         "a.toml:3: cells.0.taps.0.string: found 0.5, expected a whole number from 0 to 1000"},
        {"taps = [{ name = \"a\", quantity = \"velocity\", string = 1e300 }]",
         "a.toml:3: cells.0.taps.0.string: found 1e+300, expected a whole number from 0 to 1000"},
    };
    for (const auto& [text, expected] : cases) EXPECT_TRUE(says(refusal_of(cells + text), expected));
    const bench::suite::Suite suite =
        bench::suite::parse_suite(cells + "measure = [\"trace\"]\ntrace = { taps = [\"nit\"], windows = [[0, 1]] }", "a.toml");
    try {
        bench::suite::plan_of(suite, bench::compare::Catalogue(), {});
        FAIL() << "a tap that is not there was planned";
    } catch (const bench::store::UsageError& e) {
        EXPECT_TRUE(says(std::string(e.what()), "scene free_string: trace: unknown tap \"nit\"; did you mean")) << e.what();
    }
}

// ---- The rows: of a string of one mode without losses, y = a sin(pi x) cos(omega t)

const char* one_mode = R"(
    [[cells]]
    scenes = ["free_string"]
    schemes = ["modal_two_point"]
    rates = [44100]
    modes = 1
    duration = 0.5
    sweep = { "string.0.damping.sigma0" = [0.0], "string.0.damping.sigma1" = [0.0], "string.0.damping.sigma3" = [0.0] }
    taps = [{ name = "middle", quantity = "displacement", string = 0, position = 0.5 }]
    measure = ["trace", "extent", "profile", "envelope", "centroid"]
    trace = { taps = ["middle", "energy"], windows = [[0.1, 0.11], [0.4999, 9]] }
    extent = { taps = ["middle"], intervals = 10 }
    profile = { instants = [0.0, 0.123456, 3], from = 0, to = 1, positions = 9 }
    envelope = { taps = ["middle"], width_hz = 20, to_hz = 1000, points = 1000 }
    centroid = { taps = ["middle"], window = 0.1, hop = 0.05 }
)";
struct OneMode {
    Planned plan{one_mode};
    std::vector<bench::study::Record> records = plan.run().records;
    const Scene& scene = plan.points[0].scene;
    double omega = modes_of(scene.strings[0], 1).omega0[0];
    double amplitude = initial_displacement(modes_of(scene.strings[0], 1), scene.strings[0])[0];
    double y(double x, double t) const { return amplitude * std::sin(std::numbers::pi * x) * std::cos(omega * t); }
};

TEST(FigureRows, FollowTheClosedFormOfASingleMode) {
    const OneMode m;
    ASSERT_EQ(m.records[0].cell.status(), "ok");
    const auto rows = [&m](const char* f) { return bench::study::rows_of(f, m.plan, m.records); };
    const double digits = 1e-7 * m.amplitude;  // eight are written

    const bench::store::Table profile = rows("profile");
    ASSERT_EQ(profile.rows.size(), 2u * 9);  // the third instant lies past the end
    for (std::size_t i = 0; i < profile.rows.size(); ++i) {
        const double t = std::round(profile.number(i, "time_s") * 44100) / 44100;
        EXPECT_NEAR(profile.number(i, "displacement_m"), m.y(profile.number(i, "position_m"), t), digits);
    }
    EXPECT_NEAR(profile.number(9, "time_s"), 0.123456, 0.5 / 44100);
    EXPECT_EQ(profile.number(0, "position_m"), 0);
    EXPECT_EQ(profile.number(2, "position_m"), 0.25);
    EXPECT_EQ(profile.number(8, "position_m"), 1);

    const bench::store::Table trace = rows("trace");
    int energies = 0;
    for (std::size_t i = 0; i < trace.rows.size(); ++i) {
        const double t = std::round(trace.number(i, "time_s") * 44100) / 44100;
        if (trace.at(i, "tap") == "energy") {  // of the undamped mode: m omega^2 a^2/2 with m = mu L/2
            const double all = 0.25 * m.scene.strings[0].linear_density * std::pow(m.omega * m.amplitude, 2);
            EXPECT_NEAR(trace.number(i, "value") / all, 1, 1e-3);  // the scheme's own, with its stiffness
            ++energies;
        } else {
            EXPECT_NEAR(trace.number(i, "value"), m.y(0.5, t), digits);
        }
    }
    EXPECT_EQ(energies, 442 + 5);  // rows from 0.1 to 0.11 s and from 0.4999 s to the end
    EXPECT_EQ(trace.rows.size(), 2u * energies);

    const bench::store::Table extent = rows("extent");
    ASSERT_EQ(extent.rows.size(), 10u);
    for (std::size_t i = 0; i < 10; ++i) {  // 50 ms hold six periods: both turning points
        EXPECT_NEAR(extent.number(i, "low"), -std::abs(m.amplitude), 1e-3 * std::abs(m.amplitude));
        EXPECT_NEAR(extent.number(i, "high"), std::abs(m.amplitude), 1e-3 * std::abs(m.amplitude));
    }

    const double f = m.omega / (2 * std::numbers::pi), level = 10 * std::log10(m.amplitude * m.amplitude / 2);
    const bench::store::Table envelope = rows("envelope");
    ASSERT_EQ(envelope.rows.size(), 1000u);
    double top = -HUGE_VAL;
    for (std::size_t i = 0; i < 1000; ++i) {
        top = std::max(top, envelope.number(i, "level_db"));
        if (std::abs(envelope.number(i, "frequency_hz") - f) <= 40) continue;
        EXPECT_LT(envelope.number(i, "level_db"), level - 60);
    }
    EXPECT_NEAR(top, level, 3.3);  // the strongest bin of a Hann window holds two thirds of the power or a little less: -1.8 to -3.2 dB
    const bench::store::Table centroid = rows("centroid");
    ASSERT_EQ(centroid.rows.size(), 9u);
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(centroid.number(i, "centroid_hz"), f, 0.2);
}

// Two modes that sound as loud: their centroid lies between them, and of a band that holds one it is that one.
TEST(FigureRows, OfACentroidKnowOnlyTheirBand) {
    const auto centroid_of = [](const std::string& band) {
        const Planned plan(R"(
            [[cells]]
            scenes = ["free_string"]
            schemes = ["modal_two_point"]
            rates = [44100]
            modes = 2
            duration = 0.2
            measure = ["centroid"]
            centroid = { taps = ["nut"], window = 0.1, hop = 0.1)" +
                           band + " }");
        return plan.rows_of("centroid").number(0, "centroid_hz");
    };
    const auto modes = modes_of(read_scene("free_string").strings[0], 2);
    const double first = modes.omega0[0] / (2 * std::numbers::pi), second = modes.omega0[1] / (2 * std::numbers::pi);
    EXPECT_NEAR(centroid_of(", to_hz = 200"), first, 0.5);
    EXPECT_NEAR(centroid_of(", from_hz = 200, to_hz = 400"), second, 0.5);
    EXPECT_GT(centroid_of(""), first + 20);
    EXPECT_LT(centroid_of(""), second - 20);
    EXPECT_TRUE(std::isnan(centroid_of(", from_hz = 21000")) || centroid_of(", from_hz = 21000") > 21000);
}

TEST(FigureRows, OfAPressureAreTheForceThroughTheBodysResponse) {
    const std::string set = R"(
        [[cells]]
        scenes = ["tanpura_c3"]
        schemes = ["modal_two_point"]
        rates = [44100]
        modes = 40
        duration = 0.02
        measure = ["errors", "trace"]
        reference_modes = "cell"
        trace = { taps = ["bridge_pressure", "nut_pressure"], windows = [[0, 1]] }
    )";
    try {
        const bench::suite::Suite suite = bench::suite::parse_suite(set, "a.toml");
        bench::suite::plan_of(suite, bench::compare::Catalogue(), {});
        FAIL() << "a pressure without a body was planned";
    } catch (const bench::store::UsageError& e) {
        EXPECT_STREQ(e.what(), "scene tanpura_c3: trace: tap bridge_pressure: the scene has no body.bridge");
    }
    const Planned plan(set + "sweep = { \"body.bridge\" = [\"synthetic_bridge.wav\"], \"body.nut\" = [\"synthetic_nut.wav\"] }");
    const auto records = plan.run().records;
    const bench::store::Table rows = bench::study::rows_of("trace", plan, records);
    EXPECT_EQ(bench::study::table_of(plan, records).column("error_l2_whole_bridge_pressure"), -1);  // what is drawn alone has no error

    Scene scene = plan.points[0].scene;
    const Body body = scene.body.value();
    scene.taps = {{"driving", Quantity::driving_force, {}, 0}, {"nut", Quantity::nut_force, {}, 0}};
    Settings settings;
    settings.sample_rate = settings.tap_rate = 44100;
    settings.modes = 40;
    const auto two_point = std::ranges::find_if(schemes(), [](const Descriptor& d) { return std::string("modal_two_point") == d.name; });
    const Trace trace = run(*two_point, scene, settings).trace;
    for (const auto& [tap, column, file] : {std::tuple{"bridge_pressure", 0, body.bridge}, {"nut_pressure", 1, body.nut}}) {
        const auto response = bench::sound::impulse_response(file, 44100, "body");
        const auto force = trace.column(column);
        double largest = 0;
        std::size_t n = 0;
        for (std::size_t i = 0; i < rows.rows.size(); ++i) {
            if (rows.at(i, "tap") != tap) continue;
            double sum = 0;
            for (std::size_t k = 0; k <= n && k < response.size(); ++k) sum += response[k] * force[n - k];
            EXPECT_NEAR(rows.number(i, "value"), sum, 1e-9) << tap << " " << n;
            largest = std::max(largest, std::abs(sum));
            ++n;
        }
        EXPECT_EQ(n, force.size()) << tap;
        EXPECT_GT(largest, 1e-6) << tap;
    }
}

TEST(FigureRows, TheExtentOfARampHasTheFirstAndTheLastRowOfEachInterval) {
    const Scene scene = OneMode().scene;
    const bench::compare::Catalogue catalogue;
    Trace trace;
    trace.tap_rate = 1000;
    trace.rows = trace.stride = 100;
    trace.names = {"nut"};
    for (int n = 0; n < 100; ++n) trace.tap.push_back(n);
    bench::suite::CellSet set;
    set.figures.rows["extent"].taps = {"nut"};
    set.figures.rows["extent"].count = 10;
    const bench::store::Table t = bench::suite::extent_rows({scene, catalogue.find("modal_two_point"), {}, trace, nullptr, 0, set});
    ASSERT_EQ(t.rows.size(), 10u);
    for (int i = 0; i < 10; ++i) {
        EXPECT_EQ(t.number(i, "low"), 10 * i);
        EXPECT_EQ(t.number(i, "high"), 10 * i + 9);
        EXPECT_NEAR(t.number(i, "time_s"), (i + 0.5) * 0.01, 1e-12);
    }
}

TEST(FigureRows, ThePositionsOfAProfileAreNoTapsOfTheTableOfErrors) {
    const OneMode m;
    const bench::store::Table t = bench::study::table_of(m.plan, m.records);
    EXPECT_GE(t.column("error_l2_whole_middle"), 0);
    for (const std::string& name : t.columns) EXPECT_FALSE(says(name, "profile_"));
}

TEST(FigureRows, ACellWithAnotherWindowIsAnotherCell) {
    std::string other = one_mode;
    other.replace(other.find("[0.1, 0.11]"), 11, "[0.1, 0.12]");
    EXPECT_NE(plan_of(bench::suite::parse_suite(one_mode, "a"), bench::compare::Catalogue(), {}).jobs[0].id,
              plan_of(bench::suite::parse_suite(other, "a"), bench::compare::Catalogue(), {}).jobs[0].id);
}

TEST(FigureRows, OfAMotionAreTheStringsShapeFrameByFrame) {
    const OneMode m;
    const bench::compare::Catalogue catalogue;
    Settings settings;
    settings.sample_rate = settings.tap_rate = 44100;
    settings.modes = 1;
    const bench::suite::CellSet set;
    const bench::store::Table t =
        bench::suite::motion_rows({m.scene, catalogue.find("modal_two_point"), settings, Trace(), nullptr, 0, set});
    ASSERT_EQ(t.rows.size(), 1u);
    const auto numbers = [](const std::string& text) {
        std::istringstream in(text);
        return std::vector<double>(std::istream_iterator<double>(in), {});
    };
    const std::vector<double> x = numbers(t.at(0, "positions")), scale = numbers(t.at(0, "scales"));
    const std::string bytes = bench::store::bytes_of_base64(t.at(0, "shape"));
    ASSERT_EQ(x.size(), 48u);
    const std::size_t frames = bytes.size() / 2 / x.size();
    EXPECT_NEAR(static_cast<double>(frames), 120, 3);
    const double step = t.number(0, "step_s");
    for (std::size_t k = 0; k < frames; ++k)
        for (std::size_t i = 1; i + 1 < x.size(); ++i) {
            const auto low = static_cast<unsigned char>(bytes[2 * (k * x.size() + i)]),
                       high = static_cast<unsigned char>(bytes[2 * (k * x.size() + i) + 1]);
            const double y = static_cast<std::int16_t>(low | high << 8) * scale[i] / 32767;
            EXPECT_NEAR(y, m.y(x[i], static_cast<double>(k) * step), 1e-3 * m.amplitude) << k << " " << i;
        }
    EXPECT_EQ(t.at(0, "reference_shape"), "");
}

// ---- The pictures

TEST(FigureCommand, ASuiteWritesItsPicturesAndSaysWhichItCouldNotDraw) {
    const Scratch scratch;
    std::ofstream(scratch / "a.toml") << one_mode;
    const std::string plain =
        R"("data": {"name": "profile"}, "mark": "line", "encoding": {"x": {"field": "position_m", "type": "quantitative"},)";
    std::ofstream(scratch / "a.vl.json")
        << R"({"1": {"title": {"text": "left"}, )" << plain << R"("y": {"field": "displacement_m", "type": "quantitative"}}}, "2": {)"
        << plain << R"("y": {"field": "displacment", "type": "quantitative"}}}, "3": {"data": {"name": "trac"}, "mark": "line"}})";
    for (const std::string& command : {"suite " + scratch / "a.toml" + " --out " + scratch / "out", "report " + scratch / "out"}) {
        const Outcome o = jvari(scratch, command);
        EXPECT_EQ(o.code, 0) << o.err;
        if (!bench::report::find_vega().missing.empty()) {
            EXPECT_TRUE(says(o.err, "npm ci"));
            continue;
        }
        const std::string svg = content(scratch.path / "out" / "figure-1.svg");
        EXPECT_EQ(svg.rfind("<svg", 0), 0u);
        EXPECT_TRUE(says(svg, ">left<"));
        EXPECT_TRUE(says(o.err, "figure-2.svg: table profile: there is no column displacment; it has"));
        EXPECT_TRUE(says(o.err, "figure-3.svg: there is no table trac"));
        std::filesystem::remove(scratch.path / "out" / "figure-1.svg");  // the folder has what it takes to draw it again
    }
    EXPECT_FALSE(std::filesystem::exists(scratch.path / "out" / "figure-2.svg"));
    EXPECT_TRUE(says(content(scratch.path / "out" / "profile.csv"), "displacement_m"));
}

}  // namespace
}  // namespace jvari::test
