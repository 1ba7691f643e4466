// Starts and forces that come from files, and the static equilibrium.
#include "scenes/start.hpp"

#include <filesystem>
#include <numbers>
#include <random>

#include "scenes/columns.hpp"
#include "scenes/excitation.hpp"
#include "scenes/modes.hpp"
#include "scenes/scene_file.hpp"
#include "scenes/wording.hpp"
#include "tests/c3.hpp"
#include "tests/says.hpp"

namespace jvari {
namespace {

std::string why(const std::function<void()>& act) {
    try {
        act();
    } catch (const std::exception& e) { return e.what(); }
    return "";
}

TEST(RestingForces, OfASpringIsKhOver1PlusKc) {
    const double k = 4.39e8, c = 3e-4, h = 1e-3;
    const RestingPoint one{k, 1, h};
    EXPECT_NEAR(resting_forces({&one, 1}, {&c, 1}).at(0) / (k * h / (1 + k * c)), 1, 1e-14);
}

TEST(RestingForces, BalanceOfSpringsPowerLawsRigidPointsAndThreadsWithAnyCompliance) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    int pressing = 0, open = 0;
    for (int draw = 0; draw < 400; ++draw) {
        const std::size_t n = 1 + draw % 6;
        std::vector<double> g(n * (n + 2)), C(n * n, 0.0);
        for (double& x : g) x = unit(random);
        for (std::size_t a = 0; a < n; ++a)
            for (std::size_t b = 0; b < n; ++b)
                for (std::size_t i = 0; i < n + 2; ++i)
                    C[a * n + b] += 1e-4 * g[a * (n + 2) + i] * g[b * (n + 2) + i];
        std::vector<RestingPoint> points(n);
        for (RestingPoint& p : points) {
            p.height = 1e-3 * unit(random);
            const int kind = static_cast<int>(random() % 4);
            p.stiffness = kind == 0 ? rigid : kind == 1 ? 1e9 : std::pow(10, 4 + 4 * unit(random));
            if (kind == 1) p.exponent = 1.5;
            p.both_ways = kind == 3;
        }
        const std::vector<double> F = resting_forces(points, C);
        ASSERT_EQ(F.size(), n) << draw;
        for (std::size_t a = 0; a < n; ++a) {
            double gap = -points[a].height;  // of the point over the barrier
            for (std::size_t b = 0; b < n; ++b) gap += C[a * n + b] * F[b];
            const RestingPoint& p = points[a];
            if (p.both_ways) {
                EXPECT_NEAR(F[a], -p.stiffness * gap, 1e-8 * (std::abs(F[a]) + 1));
            } else if (F[a] == 0) {
                EXPECT_GE(gap, -1e-15);
                ++open;
            } else {
                const double depth =
                    p.stiffness == rigid ? 0 : std::pow(F[a] / p.stiffness, 1 / p.exponent);
                EXPECT_GT(F[a], 0);
                EXPECT_NEAR(gap, -depth, 1e-14) << draw;
                ++pressing;
            }
        }
    }
    EXPECT_GT(pressing, 300);
    EXPECT_GT(open, 300);
}

TEST(StartOfAFile, StraightLinesHaveTheSeriesOfTheTriangle) {
    String s = c3_free().strings.front();
    const Modes m = modes_of(s, 60);
    s.start = TriangleShape{0.3, 1e-3, 0};
    const auto triangle = start_of(m, s).displacement;
    s.start = start_from("t.csv",
                         "x_m,displacement_m,velocity_m_per_s\n0.1,0.333333333333333333e-3,"
                         "0.1\n0.3,1e-3,0.3\n1,0,0\n");
    const ModalStart file = start_of(m, s);
    EXPECT_TRUE(needed_by(Scene{"", "", 1, {s}, {}, {}}).has(Feature::initial_velocity));
    for (int i = 0; i < m.count(); ++i) {
        EXPECT_NEAR(file.displacement[i], triangle[i], 1e-18);
        EXPECT_NEAR(file.velocity[i], 300 * triangle[i], 1e-15);
    }
    EXPECT_NEAR(displacement_at(std::get<TableStart>(*s.start), s.length, 0.65), 0.5e-3, 1e-18);
}

TEST(StartOfAFile, RowsOfModesAreTheModes) {
    String s = c3_free().strings.front();
    s.start = start_from("t.csv", "mode,displacement,velocity\n2,1e-3,0.5\n50,3,4\n");
    const ModalStart start = start_of(modes_of(s, 3), s);
    EXPECT_EQ(start.displacement, (std::vector<double>{0, 1e-3, 0}));
    EXPECT_EQ(start.velocity, (std::vector<double>{0, 0.5, 0}));
    EXPECT_NEAR(displacement_at(std::get<TableStart>(*s.start), 1, 0.25),
                1e-3 + 3 * std::sin(50 * std::numbers::pi / 4), 1e-12);
}

TEST(ForceOfAFile, IsStraightBetweenItsRowsAndNothingBeyondThem) {
    Pluck p;
    force_from("f.csv", "time_s,force_N\n0.1,0\n0.2,-4\n0.4,2\n", p);
    EXPECT_EQ(p.amplitude, 4);
    EXPECT_EQ(p.start, 0.1);
    for (const auto& [t, F] :
         {std::pair{0.05, 0.0}, {0.15, -2.0}, {0.3, -1.0}, {0.4, 2.0}, {0.41, 0.0}})
        EXPECT_NEAR(force(p, t), F, 1e-14) << t;
    EXPECT_EQ(next_knot(p, 0), 0.1);
    EXPECT_EQ(next_knot(p, 0.1), 0.2);
    EXPECT_EQ(next_knot(p, 0.2), 0.1 + (0.4 - 0.1));
    p.amplitude = 8;
    EXPECT_NEAR(force(p, 0.15), -4, 1e-14);
}

class InAFolder : public testing::Test {
protected:
    void SetUp() override {
        folder = std::filesystem::temp_directory_path() /
                 ("jvari-start-" + std::to_string(std::random_device{}()));
        std::filesystem::create_directories(folder);
    }
    void TearDown() override { std::filesystem::remove_all(folder); }
    void put(const std::string& name, const std::string& text) const {
        std::ofstream(folder / name) << text;
    }
    Scene read(const std::string& more, const std::vector<std::string>& overrides = {}) const {
        return parse_scene(
            "name = \"a\"\nduration = 1\n[[string]]\nlength = 1\nlinear_density = 1e-3\ntension = "
            "40\n" +
                more,
            (folder / "a.toml").string(), overrides);
    }
    std::filesystem::path folder;
};

std::string wav(int tag, int bits, std::initializer_list<std::uint64_t> samples, int channels = 1) {
    const int container = (bits + 7) / 8;
    std::string text = "RIFF....WAVE", data;
    const auto put = [](std::string& to, std::uint64_t n, int bytes) {
        for (int k = 0; k < bytes; ++k) to += static_cast<char>(n >> 8 * k);
    };
    for (const std::uint64_t s : samples) put(data, s, container);
    text += "junk", put(text, 3, 4), text += "abc ";
    text += "fmt ", put(text, 16, 4), put(text, tag, 2), put(text, channels, 2), put(text, 8000, 4);
    put(text, 0, 4), put(text, container * channels, 2), put(text, bits, 2);
    text += "data", put(text, data.size(), 4);
    return text + data;
}

TEST(ForceOfAFile, OfASoundHasItsRateAndItsSamplesAsNewtons) {
    for (const auto& text :
         {wav(1, 16, {0, 0x4000, 0x8000}), wav(1, 24, {0, 0x400000, 0x800000}),
          wav(1, 20, {0, 0x400000, 0x800000}), wav(1, 12, {0, 0x4000, 0x8000}),
          wav(1, 32, {0, 0x40000000, 0x80000000}), wav(3, 32, {0, 0x3f000000, 0xbf800000}),
          wav(3, 64, {0, 0x3fe0000000000000, 0xbff0000000000000})}) {
        Pluck p;
        force_from("f.wav", text, p);
        EXPECT_EQ(force(p, 1 / 8000.), 0.5);
        EXPECT_EQ(force(p, 2 / 8000.), -1);
        EXPECT_EQ(force(p, 1.5 / 8000), -0.25);
    }
    Pluck p, named;
    EXPECT_TRUE(says(why([&] { force_from("f.wav", wav(1, 16, {1, 1}, 2), p); }), "2 channels"));
    EXPECT_TRUE(says(why([&] { force_from("f.wav", "RIFF", p); }), "no RIFF WAVE file"));
    const std::string whole = wav(1, 16, {0, 0x4000, 0x8000});
    for (const std::size_t lacks : {1, 2, 4})
        EXPECT_TRUE(says(why([&] {
                             Pluck cut;
                             force_from("f.wav", whole.substr(0, whole.size() - lacks), cut);
                         }),
                         "that its header announces. Is the file cut off?"));
    EXPECT_TRUE(says(why([&] {
                         Pluck twice;
                         force_from("f.wav", whole + whole.substr(whole.find("data")), twice);
                     }),
                     "two blocks of samples"));
    force_from("F.WAV", whole, named);
    EXPECT_EQ(force(named, 1 / 8000.), 0.5);
}

TEST_F(InAFolder, AFileThatIsCutOffInItsLastNumberIsRefused) {
    put("s.csv", "mode,displacement_m\n1,1e-3\n2,0.1");
    put("f.csv", "time_s,force_N\n0,1\n1,0.1");
    put("m.csv", "frequency_hz,decay_rate_per_s\n100,1\n200,1");
    for (const std::string keys :
         {"start = \"s.csv\"\n", "[string.pluck]\nposition = 0.5\nfile = \"f.csv\"\n",
          "[string.damping]\nlaw = \"table\"\nfile = \"m.csv\"\n"})
        EXPECT_TRUE(says(why([&] { read(keys); }), ".csv:3: found no end of the line")) << keys;
}

// (f/m)^2 of a stiff string is straight in m^2: what a table lacks is filled in exactly.
TEST_F(InAFolder, RowsOfModesAreThoseThatTheirColumnNumbers) {
    String s = read("").strings[0];
    s.bending_stiffness = 1e-4;
    const Modes modes = modes_of(s, 9);
    std::string text = "decay_rate_per_s,mode,frequency_hz\n";
    for (const int m : {1, 2, 5, 6, 9})
        text += number_text(3 * m) + "," + number_text(m) + "," +
                number_text(modes.omega0[m - 1] / (2 * std::numbers::pi)) + "\n";
    put("m.csv", text);
    const std::string law = "[string.damping]\nlaw = \"table\"\nfile = \"m.csv\"\n";
    const Scene scene = read(law);
    const auto& t = std::get<TableDamping>(scene.strings[0].damping);
    EXPECT_EQ(t.filled, (std::vector<int>{3, 4, 7, 8}));
    ASSERT_EQ(t.frequency_hz.size(), 9u);
    for (int m = 1; m <= 9; ++m) {
        EXPECT_NEAR(2 * std::numbers::pi * t.frequency_hz[m - 1] / modes.omega0[m - 1], 1, 1e-12);
        EXPECT_NEAR(t.decay_rate[m - 1], 3 * m, 1e-12);
    }
    EXPECT_TRUE(scene == parse_scene(write_scene(scene), (folder / "b.toml").string()));
    const auto refusal = [&](const std::string& rows) {
        put("m.csv", "mode,frequency_hz,decay_rate_per_s\n" + rows);
        return why([&] { read(law); });
    };
    EXPECT_TRUE(says(refusal("2,200,1\n3,300,1\n"), "m.csv:2: mode: found 2 in the first row"));
    EXPECT_TRUE(says(refusal("1,100,1\n1,200,1\n"), "m.csv:3: mode: found 1 after 1"));
    EXPECT_TRUE(says(refusal("1,100,1\n2.5,200,1\n"), "m.csv:3: mode: found 2.5 after 1"));
    EXPECT_TRUE(says(refusal("1,100,1\n1e9,200,1\n"), "m.csv:3: mode: found \"1e9\""));
    const auto bare = [&](const std::string& rows) {
        put("m.csv", "frequency_hz,decay_rate_per_s\n" + rows);
        return why([&] { read(law); });
    };
    EXPECT_TRUE(says(bare("100,1\n201,1\n403,1\n"), "m.csv:4: frequency_hz: found 403 after 201"));
    EXPECT_TRUE(says(bare("200,1\n300,1\n"), "m.csv:3: frequency_hz: found 300 after 200 and 0"));
    EXPECT_EQ(bare("100,1\n205,1\n330,1\n480,1\n"), "");
}

TEST_F(InAFolder, ATableBeyondTheStringIsAskedWhetherItIsInMm) {
    put("b.csv", "x_m,height_m\n0,0\n10,-0.6\n19,-2.3\n");
    put("s.csv", "x_m,displacement_m\n500,1\n");
    EXPECT_TRUE(says(why([&] {
                         read(
                             "[[string.barrier]]\nshape = \"profile\"\ncurve = \"table\"\nfile "
                             "= \"b.csv\"\nfrom = 0\nto = 0.02\nstiffness_density = 1e9\n");
                     }),
                     "a.toml:10: string.0.barrier.0.file: found x_m 19, expected 0 <= x <= 1 [m], "
                     "on the string; is the table in mm?"));
    EXPECT_TRUE(says(why([&] { read("start = \"s.csv\"\n"); }), "is the table in mm?"));
}

TEST_F(InAFolder, EveryFileOfAnOverrideIsFoundFromWhereTheProgramRuns) {
    put("m.csv", "frequency_hz,decay_rate_per_s\n100,1\n200,2\n");
    put("b.csv", "x_m,height_m\n0,0\n0.02,-1e-6\n");
    const auto from_here = [&](const std::string& file) {
        return std::filesystem::relative(folder / file).string();
    };
    const std::string keys =
        "[string.damping]\nlaw = \"none\"\n[[string.barrier]]\nshape = \"profile\"\ncurve = "
        "\"flat\"\nfrom = 0\nto = 0.02\nstiffness_density = 1e9\n[body]\nbridge = \"r.wav\"\n";
    const Scene scene = read(
        keys, {"string.0.damping.law=table", "string.0.damping.file=" + from_here("m.csv"),
               "string.0.barrier.0.curve=table", "string.0.barrier.0.file=" + from_here("b.csv"),
               "body.bridge=" + from_here("r.wav")});
    EXPECT_EQ(std::get<TableDamping>(scene.strings[0].damping).decay_rate,
              (std::vector<double>{1, 2}));
    EXPECT_TRUE(std::filesystem::path(scene.body->bridge).is_absolute());
    EXPECT_TRUE(scene == parse_scene(write_scene(scene), "elsewhere/a.toml"));
}

TEST_F(InAFolder, StartsAreWrittenAsTheyAreRead) {
    put("s.csv", "x_m,displacement_m\n0.5,1e-3\n");
    put("f.csv", "time_s,force_N\n0,1\n1,1\n");
    for (const std::string start :
         {"start = \"rest\"\n",
          "start = \"s.csv\"\n[string.velocity]\nshape = \"mode\"\nnumber = 2\n"
          "amplitude = 0.1\n",
          "[string.start]\nshape = \"mode\"\nnumber = 2\namplitude = 1e-3\n",
          "[string.pluck]\nfile = \"f.csv\"\nposition = 0.5\n",
          "[string.pluck]\nfile = \"f.csv\"\namplitude = 3\nposition = 0.5\n"}) {
        const Scene scene = read(start),
                    again = parse_scene(write_scene(scene), (folder / "b.toml").string());
        EXPECT_TRUE(scene == again) << start;
        EXPECT_EQ(scene_hash(scene), scene_hash(again));
        EXPECT_NE(scene_hash(scene), scene_hash(read("")));
    }
    const std::string before = scene_hash(read("start = \"s.csv\"\n"));
    put("s.csv", "x_m,displacement_m\n0.5,2e-3\n");
    EXPECT_NE(scene_hash(read("start = \"s.csv\"\n")), before);
    EXPECT_EQ(read("[string.pluck]\nfile = \"f.csv\"\namplitude = 3\nposition = 0.5\n")
                  .strings[0]
                  .pluck->amplitude,
              3);
}

TEST_F(InAFolder, AnOverrideFindsItsFileFromWhereTheProgramRuns) {
    put("s.csv", "mode,displacement_m,velocity_m_per_s\n1,1e-3,0\n");
    const std::string shape = "[string.start]\nshape = \"mode\"\nnumber = 2\namplitude = 1e-3\n";
    const auto relative = std::filesystem::relative(folder / "s.csv").string();
    const Scene scene = read(shape, {"string.0.start=" + relative});
    EXPECT_TRUE(std::get<TableStart>(*scene.strings[0].start).of_modes);
    EXPECT_TRUE(scene == parse_scene(write_scene(scene), "elsewhere/a.toml"));
    put("f.csv", "time_s,force_N\n0,1\n1,2\n");
    const std::string analytic =
                          "[string.pluck]\namplitude = -0.4\nduration = 0.1\nposition = 0.5\n",
                      pull = std::filesystem::relative(folder / "f.csv").string();
    const Scene pulled = read(analytic, {"string.0.pluck.file=" + pull});
    EXPECT_EQ(pulled.strings[0].pluck->amplitude, 2);
    EXPECT_TRUE(pulled == parse_scene(write_scene(pulled), "elsewhere/a.toml"));
    EXPECT_EQ(read(analytic, {"string.0.pluck.file=" + pull, "string.0.pluck.amplitude=5"})
                  .strings[0]
                  .pluck->amplitude,
              5);
    EXPECT_TRUE(
        std::holds_alternative<RestStart>(*read(shape, {"string.0.start=rest"}).strings[0].start));
}

// Scenes that others wrote before `start` was called so.
TEST_F(InAFolder, TheInitialOfAnOlderSceneIsItsStart) {
    const std::string shape = "]\nshape = \"mode\"\nnumber = 2\namplitude = 1e-3\n";
    const Scene now = read("[string.start" + shape);
    EXPECT_TRUE(now.strings[0].start == Start(ModeShape{2, 1e-3}));
    EXPECT_TRUE(read("[string.initial" + shape) == now);
    EXPECT_TRUE(read("[string.initial" + shape, {"string.0.initial.number=1"}) ==
                read("[string.start" + shape, {"string.0.start.number=1"}));
}

TEST_F(InAFolder, WhatCannotBeIsRefusedWithItsPlace) {
    put("end.csv", "x_m,displacement_m\n0,1e-3\n");
    put("far.csv", "x_m,displacement_m\n2,0\n");
    put("back.csv", "x_m,displacement_m\n0.5,0\n0.4,0\n");
    put("none.csv", "displacement_m\n0\n");
    put("both.csv", "mode,x_m,displacement_m\n1,0.5,0\n");
    put("half.csv", "mode,displacement_m\n1.5,1\n");
    put("text.csv", "mode,displacement_m\n1,one\n");
    put("one.csv", "time_s,force_N\n0,1\n");
    put("zero.csv", "time_s,force_N\n0,0\n1,0\n");
    const auto start = [&](const std::string& file) {
        return why([&] { read("start = \"" + file + "\"\n"); });
    };
    EXPECT_TRUE(
        says(start("end.csv"), "a.toml:7: string.0.start: found an end of the string that"));
    EXPECT_TRUE(says(start("far.csv"), "string.0.start: found x_m 2, expected 0 <= x <= 1 [m]"));
    EXPECT_TRUE(says(start("back.csv"), "string.0.start: found x_m 0.4 in row 2"));
    EXPECT_TRUE(
        says(start("none.csv"), "expected rows of one of the columns \"x_m\" and \"mode\""));
    EXPECT_TRUE(says(start("both.csv"), "found \"x_m\" and \"mode\""));
    EXPECT_TRUE(says(start("half.csv"), "found mode 1.5, expected whole numbers"));
    EXPECT_TRUE(says(start("text.csv"), "text.csv:2: displacement_m: found \"one\""));
    EXPECT_TRUE(says(start("no.csv"),
                     "a.toml:7: string.0.start: found \"no.csv\", which is not a "
                     "file, expected \"rest\", a table with a shape, or a CSV"));
    EXPECT_TRUE(
        says(why([&] { read("start = 3\n"); }), "string.0.start: found 3, expected a table"));
    EXPECT_TRUE(says(why([&] { read("start = \"rest\"\n[string.initial]\nshape = \"mode\"\n"); }),
                     "string.0.initial: unknown key; it is called \"start\""));
    EXPECT_TRUE(says(why([&] { read("axial_stiffness = 1e3\nstart = \"rest\"\n"); }),
                     "string.0.start: found \"rest\", expected another start of a string that"));
    EXPECT_TRUE(says(
        why([&] { read("start = \"rest\"\n[body]\n[[body.mode]]\nmass = 1\nstiffness = 1\n"); }),
        "string.0.start: found \"rest\", expected another start"));
    const auto pluck = [&](const std::string& keys) {
        return why([&] { read("[string.pluck]\nposition = 0.5\n" + keys); });
    };
    EXPECT_TRUE(says(pluck("file = \"one.csv\"\n"), "expected two rows at least and a force"));
    EXPECT_TRUE(says(pluck("file = \"zero.csv\"\n"), "expected two rows at least and a force"));
    put("f.csv", "time_s,force_N\n0,1\n0,2\n");
    EXPECT_TRUE(
        says(pluck("file = \"f.csv\"\n"), "a.toml:9: string.0.pluck.file: found time_s 0 in "));
    put("f.csv", "time_s,force_N\n0,1\n1,2\n");
    EXPECT_TRUE(says(pluck("file = \"f.csv\"\nduration = 1\n"),
                     "a.toml:10: string.0.pluck.duration: found 1, expected nothing beside file"));
    EXPECT_TRUE(
        says(pluck("file = \"f.wav\"\n"), "string.0.pluck.file: found \"f.wav\", which is "));
}

}  // namespace
}  // namespace jvari
