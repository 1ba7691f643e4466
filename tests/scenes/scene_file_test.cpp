// Scene files: what the library holds, round trips, overrides, and the exact words for everything
// that is wrong.
#include "scenes/scene_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <random>

#include "scenes/columns.hpp"
#include "scenes/material.hpp"
#include "scenes/modes.hpp"
#include "scenes/pitch.hpp"
#include "scenes/schema.hpp"
#include "tests/says.hpp"

namespace jvari {
namespace {

namespace fs = std::filesystem;

Features features(std::initializer_list<Feature> all) {
    Features f;
    for (Feature one : all) f = f | Features(one);
    return f;
}

std::string message(const std::string& text, const std::vector<std::string>& overrides = {},
                    const std::string& file = "scene.toml") {
    try {
        parse_scene(text, file, overrides);
    } catch (const SceneFileError& e) { return e.what(); }
    return "(read without an error)";
}

struct Directory {  // of this test alone, removed after it
    fs::path path = fs::temp_directory_path() /
                    ("jvari_scene_file_test." + std::to_string(std::random_device{}()));
    Directory() { fs::create_directories(path); }
    ~Directory() { fs::remove_all(path); }
    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(path / name, std::ios::binary) << text;
        return (path / name).string();
    }
};

// lines 1-2
const std::string head = "name = \"s\"\nduration = 1.0\n";
// 3-6
const std::string one =
    head + "[[string]]\nlength = 1.0\nlinear_density = 4.83e-4\ntension = 33.1\n";
// 7-10
const std::string lumped =
    one + "[[string.barrier]]\nshape = \"lumped\"\nposition = 0.01\nstiffness = 4.39e8\n";
// 7-10
const std::string profile =
    one + "[[string.barrier]]\nshape = \"profile\"\ncurve = \"flat\"\nstiffness_density = 1e9\n";
// 7-8
const std::string tap = one + "[[tap]]\nname = \"a\"\n";

// ---- The library

TEST(Library, HoldsThePapersScenesWithWhatTheyNeed) {
    using enum Feature;
    const Features c3 = features({bending_stiffness, damping, frequency_dependent_damping});
    const Features steel = c3 | features({power_law_contact, initial_shape});
    const std::vector<std::pair<std::string, Features>> expected{
        {"free_string", c3 | Features(initial_shape)},
        {"sitar_c5", features({damping, profile_barrier, initial_shape})},
        {"sitar_parabola", steel | Features(profile_barrier)},
        {"sitar_sympathetic", c3 | features({lumped_barrier, initial_shape, moving_body})},
        {"tanpura_c3", c3 | features({lumped_barrier, thread, pluck})},
        {"tanpura_c3_release", c3 | features({lumped_barrier, thread, initial_shape})},
        {"two_point_bridge", steel | Features(lumped_barrier)},
    };
    const auto names = library_scenes();
    for (const auto& [name, needed] : expected) {
        EXPECT_TRUE(std::find(names.begin(), names.end(), name) != names.end()) << name;
        EXPECT_EQ(names_of(needed_by(read_scene(name))), names_of(needed)) << name;
    }
    EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
}

TEST(Library, EveryScenePassesItsChecksNamesItselfAndItsSourceAndSurvivesBeingWritten) {
    for (const std::string& name : library_scenes()) {
        const Scene scene = read_scene(name);
        EXPECT_NO_THROW(validate(scene)) << name;
        EXPECT_EQ(scene.name, name);
        EXPECT_FALSE(scene.source.empty()) << name;
        EXPECT_FALSE(scene.taps.empty()) << name;
        const Scene again = parse_scene(write_scene(scene), "again.toml");
        EXPECT_TRUE(again == scene) << write_scene(scene);
        EXPECT_EQ(scene_hash(again), scene_hash(scene));
    }
}

TEST(Library, TheC3StringIsTable1) {
    const Scene scene = read_scene("tanpura_c3");
    const String& s = scene.strings.at(0);
    EXPECT_TRUE(s.damping == Damping(PolynomialDamping{0.6, 6.5e-3, 5.0e-6}));
    EXPECT_TRUE(s.barriers.at(0) == Barrier(LumpedBarrier{10e-3, 2e-3, 0, {4.39e8}, 1, 0}));
    EXPECT_TRUE(s.thread == (Thread{5e-3, 1.2e-3, 1.2e5, 1.2, 0}));
    EXPECT_TRUE(s.pluck == (Pluck{-0.4, 50e-3, 30, 0, 0.5, 1.0}));
    EXPECT_FALSE(s.start);
    EXPECT_EQ(scene.taps.size(), 4u);
    const Scene release = read_scene("tanpura_c3_release");
    EXPECT_TRUE(release.strings.at(0).start == Start(ModeShape{1, 1.9e-3}));
    EXPECT_FALSE(release.strings.at(0).pluck);
}

TEST(Library, TheSitarStringIsTunedToC5AndTheSteelStringHasThePrintedInharmonicity) {
    const String sitar = read_scene("sitar_c5").strings.at(0);
    EXPECT_EQ(std::sqrt(sitar.tension / sitar.linear_density) / (2 * sitar.length), 523.25);
    for (const char* name : {"two_point_bridge", "sitar_parabola"}) {
        const String s = read_scene(name).strings.at(0);
        EXPECT_NEAR(std::numbers::pi * std::numbers::pi * s.bending_stiffness /
                        (s.tension * s.length * s.length),
                    1.78e-5, 1e-18)
            << name;
    }
}

TEST(Library, IsTheDirectoryThatTheEnvironmentNames) {
    const Directory other;
    other.write("mine.toml", one);
    setenv("JVARI_SCENES", other.path.c_str(), 1);
    EXPECT_EQ(library_scenes(), std::vector<std::string>{"mine"});
    EXPECT_EQ(read_scene("mine").name, "s");
    unsetenv("JVARI_SCENES");
    EXPECT_THROW(read_scene("mine"), SceneFileError);
}

// ---- Writing

const char* const everything = R"(
name = "all \"of\" it"
source = "tab\t, line\n, µ"
duration = 0.5
[[string]]
length = 0.9
linear_density = 5e-4
tension = 30
[string.damping]
law = "quality_factor"
diameter = 3e-4
air_viscosity = 1.8e-5
air_density = 1.2
viscoelastic_angle = 0.004
thermoelastic_loss = 2e-4
[[string.barrier]]
shape = "lumped"
position = 0.01
width = 2e-3
height = -1e-4
stiffness = 1e9
exponent = 1.5
contact_loss = 2.0
[[string.barrier]]
shape = "profile"
curve = "parabola"
coefficient = 0.5
from = 0.02
to = 0.04
stiffness_density = 12345678901234567000.0
exponent = 2.5
contact_loss = 1.0
[string.thread]
position = 5e-3
width = 1e-3
stiffness = 1e5
damping = 0.5
height = 1e-5
[string.start]
shape = "triangle"
position = 0.3
amplitude = -1e-3
smoothing = 0.01
[string.pluck]
amplitude = 0.4
duration = 0.05
skew = 3.0
start = 0.1
position = 0.45
width = 0.9
[string.polarisation]
rotation = 0.05
pluck_angle = 0.2
[[string]]
length = 1
linear_density = 1e-3
tension = 40
damping = {law = "per_period", factor = 0.99}
barrier = [{shape="profile", curve="line", coefficient=-0.01, from=0,to=0.01,stiffness_density=1e9},
           {shape = "profile", curve = "flat", from = 0.9, to = 1, stiffness_density = 1e9}]
start = {shape = "mode", number = 3, amplitude = 1e-3}
[[tap]]
name = "v"
quantity = "velocity"
string = 1
position = 0.25
[[tap]]
name = "drive"
quantity = "driving_force"
[body]
bridge = "bridge.wav"
nut = "nut.wav"
[[body.mode]]
mass = 0.25
stiffness = 1.5e5
damping = 6.0
[[body.mode]]
mass = 0.1
stiffness = 4e5
)";

TEST(WriteScene, EveryKeyOfTheSchemaSurvives) {
    const Scene scene = parse_scene(everything, "scene.toml");
    EXPECT_EQ(scene.source, "tab\t, line\n, µ");
    EXPECT_EQ(scene.strings[0].polarisation->pluck_angle, 0.2);
    EXPECT_EQ(std::get<ProfileBarrier>(scene.strings[0].barriers[1]).stiffness.K,
              12345678901234567000.0);
    EXPECT_EQ(std::get<ModeShape>(*scene.strings[1].start).number, 3);
    EXPECT_EQ(scene.taps[1].string, std::nullopt);
    EXPECT_EQ(scene.body->nut, "nut.wav");
    EXPECT_TRUE((scene.body->modes == std::vector<BodyMode>{{0.25, 1.5e5, 6}, {0.1, 4e5, 0}}));
    const Scene again = parse_scene(write_scene(scene), "again.toml");
    EXPECT_TRUE(again == scene) << write_scene(scene);
    EXPECT_EQ(write_scene(again), write_scene(scene));
}

TEST(WriteScene, EveryDoubleIsReadBackToTheBit) {
    Scene scene = parse_scene(one, "scene.toml");
    std::mt19937_64 engine(1);
    for (int i = 0; i < 2000; ++i) {
        scene.duration = std::ldexp(1.0 + static_cast<double>(engine() >> 12) * 0x1p-52,
                                    static_cast<int>(engine() % 2000) - 1000);
        EXPECT_EQ(parse_scene(write_scene(scene), "again.toml").duration, scene.duration);
    }
}

TEST(SceneHash, ChangesWithEveryValueAndIsTheSameForTheSameScene) {
    const Scene scene = parse_scene(everything, "scene.toml");
    const std::string hash = scene_hash(scene);
    EXPECT_EQ(hash.size(), 16u);
    EXPECT_EQ(hash, scene_hash(parse_scene(everything, "elsewhere.toml")));
    EXPECT_NE(hash, scene_hash(parse_scene(
                        everything, "scene.toml",
                        {"string.0.thread.height=1.0000000000000001e-5", "duration=0.6"})));
    EXPECT_NE(hash, scene_hash(parse_scene(everything, "scene.toml",
                                           {"string.0.length=0.9000000000000001"})));
    EXPECT_NE(hash,
              scene_hash(parse_scene(everything, "scene.toml", {"body.mode.1.damping=1e-9"})));
    // a filter of what is heard
    EXPECT_EQ(hash, scene_hash(parse_scene(everything, "scene.toml", {"body.nut=other.wav"})));
    Scene tables = scene;
    tables.strings[0].damping = TableDamping{"modes.csv", {100}, {1}};
    const std::string before = scene_hash(tables);
    tables.strings[0].damping = TableDamping{"modes.csv", {100}, {2}};
    EXPECT_NE(before, scene_hash(tables));  // the same file name, other contents
}

// ---- Tables

TEST(Tables, AreFoundBesideTheSceneAndReadByTheNamesInTheirHeader) {
    const Directory d;
    d.write("modes.csv",
            "# measured\nmode, sigma_per_s ,frequency_hz\r\n1,0.5,100\n\n# and\n2, 0.75 "
            ",2.01e2,left over\n");
    d.write("bridge.csv", "x_m,height_m\n0,0\n0.01,-1e-6\n0.02,-4e-6\n");
    const std::string path =
        d.write("scene.toml", one +
                                  "[string.damping]\nlaw = \"table\"\nfile = "
                                  "\"modes.csv\"\n[[string.barrier]]\nshape = \"profile\"\n"
                                  "curve = \"table\"\nfile = \"bridge.csv\"\nfrom = 0\nto = "
                                  "0.02\nstiffness_density = 1e9\n");
    const Scene scene = read_scene(path);
    EXPECT_TRUE(scene.strings[0].damping ==
                Damping(TableDamping{"modes.csv", {100, 201}, {0.5, 0.75}}));
    EXPECT_EQ(modes_of(scene.strings[0], 2).sigma[1], 0.75);
    EXPECT_TRUE(std::get<ProfileBarrier>(scene.strings[0].barriers[0]).curve ==
                Curve(TableCurve{"bridge.csv", {0, 0.01, 0.02}, {0, -1e-6, -4e-6}}));
    EXPECT_TRUE(needed_by(scene).has(Feature::measured_modes));
    EXPECT_TRUE(parse_scene(write_scene(scene), (d.path / "again.toml").string()) == scene);
}

TEST(Tables, ErrorsNameTheLineOfTheTableOrOfTheSceneThatNamesIt) {
    const Directory d;
    const std::string text = one + "[string.damping]\nlaw = \"table\"\nfile = \"modes.csv\"\n",
                      file = (d.path / "scene.toml").string();
    const auto with = [&](const std::string& csv) {
        d.write("modes.csv", csv);
        std::string m = message(text, {}, file);
        if (m.rfind(d.path.string() + "/", 0) == 0) m.erase(0, d.path.string().size() + 1);
        return m;
    };
    EXPECT_EQ(with("frequency_hz,decay_rate_per_s\n100,abc\n"),
              "modes.csv:2: decay_rate_per_s: found \"abc\", expected a number >= 0");
    EXPECT_EQ(with("frequency_hz,decay_rate_per_s\n100,1\nnan,1\n"),
              "modes.csv:3: frequency_hz: found \"nan\", expected a positive number");
    EXPECT_EQ(with("frequency_hz,decay_rate_per_s\n100\n"),
              "modes.csv:2: decay_rate_per_s: found \"\", expected a number >= 0");
    EXPECT_EQ(with("frequency_hz,decay_rate_per_s\n100,-1\n"),
              "modes.csv:2: decay_rate_per_s: found \"-1\", expected a number >= 0");
    EXPECT_EQ(with("# a\nfrequency,decay_rate_per_s\n"),
              "modes.csv:2: header: found no column \"frequency_hz\" (or \"f_hz\", "
              "\"frequency_khz\", \"f_khz\") among \"frequency\", \"decay_rate_per_s\"");
    EXPECT_EQ(with("mode,f,T_60\n"),
              "modes.csv:1: header: found no columns \"frequency_hz\" (or \"f_hz\", "
              "\"frequency_khz\", \"f_khz\"), \"decay_rate_per_s\" (or \"sigma_per_s\", "
              "\"t60_s\", \"tau_s\", \"q\", \"zeta\") among \"mode\", \"f\", \"T_60\"");
    EXPECT_EQ(with("f_Hz,T60_s\n100,0\n"),
              "modes.csv:2: t60_s: found \"0\", expected a positive number");
    EXPECT_EQ(with("frequency_hz,frequency_hz,decay_rate_per_s\n100,200,1\n"),
              "modes.csv:1: header: found two columns \"frequency_hz\", expected one");
    EXPECT_EQ(
        with("frequency_hz;decay_rate_per_s\n100;0,5\n"),
        "modes.csv:1: header: found \"frequency_hz;decay_rate_per_s\", expected commas between "
        "columns, and points in numbers, as 0.5");
    EXPECT_EQ(with("\xef\xbb\xbf"
                   "frequency_hz,decay_rate_per_s\n100,-1\n"),
              "modes.csv:2: decay_rate_per_s: found \"-1\", expected a number >= 0");
    EXPECT_EQ(with("# nothing\n"),
              "modes.csv:1: found no header, expected the columns \"frequency_hz\", "
              "\"decay_rate_per_s\"");
    EXPECT_EQ(with("frequency_hz,decay_rate_per_s\n"),
              "scene.toml:9: string.0.damping.file: found no rows, expected at least one");
    EXPECT_EQ(with("frequency_hz,decay_rate_per_s\n200,1\n100,1\n"),
              "scene.toml:9: string.0.damping.file: found frequency_hz 100 in row 2, expected a "
              "positive number, above that of the row before");
    const std::string override =
        "string.0.barrier.0.file=" + d.write("bridge.csv", "x_m,height_m\n0,0\n0.01,0\n");
    EXPECT_EQ(message(profile + "from = 0\nto = 0.02\n",
                      {"string.0.barrier.0.curve=table", override}, file),
              "--set " + override +
                  ": string.0.barrier.0.file: found heights from 0 to 0.01 m, expected them from "
                  "0 to 0.02 m");
}

// ---- Overrides

TEST(Overrides, NumbersAreReadWholeAndByTens) {
    const std::string base = "tanpura_c3_release";
    EXPECT_EQ(read_scene(base, {"string.0.length=010"}).strings[0].length, 10);
    EXPECT_EQ(read_scene(base, {"string.0.start={shape=\"mode\",number=2,amplitude=1e-3}",
                                "string.0.start.number=3e0"})
                  .strings[0]
                  .start,
              Start(ModeShape{3, 1e-3}));
    for (const char* text : {"0x10", "1_0", "1e400", "nan", "inf", "0,5"})
        EXPECT_THROW(read_scene(base, {std::string("string.0.length=") + text}), std::runtime_error)
            << text;
}

TEST(Overrides, SetValuesByPathAlsoAbsentOnes) {
    const Scene scene =
        read_scene("tanpura_c3", {"string.0.barrier.0.stiffness=1e9", "duration = 2",
                                  "string.0.polarisation.rotation=0.1", "name=other-name",
                                  "source=\"quoted\"", "tap.4.name=v", "tap.4.quantity=velocity",
                                  "tap.4.string=0", "tap.4.position=0.1",
                                  "string.0.start={shape='mode', number=2, amplitude=1e-3}"});
    EXPECT_EQ(std::get<LumpedBarrier>(scene.strings[0].barriers[0]).stiffness.k, 1e9);
    EXPECT_EQ(scene.duration, 2);
    EXPECT_EQ(scene.strings[0].polarisation->rotation, 0.1);
    EXPECT_EQ(scene.name, "other-name");
    EXPECT_EQ(scene.source, "quoted");
    EXPECT_EQ(scene.taps.at(4).quantity, Quantity::velocity);
    EXPECT_TRUE(scene.strings[0].start == Start(ModeShape{2, 1e-3}));
    EXPECT_TRUE(scene.strings[0].pluck);
}

TEST(Overrides, ALaterOneWinsAndAnArrayIsMadeWhereItIsAbsent) {
    const Scene scene =
        parse_scene(one, "scene.toml",
                    {"duration=2", "duration=3", "string.0.barrier.0.shape=lumped",
                     "string.0.barrier.0.position=0.01", "string.0.barrier.0.stiffness=1e8"});
    EXPECT_EQ(scene.duration, 3);
    EXPECT_TRUE((scene.strings[0].barriers ==
                 std::vector<Barrier>{LumpedBarrier{0.01, 0, 0, {1e8}, 1, 0}}));
}

TEST(Overrides, ChoosingAnotherLawOrShapeLeavesTheKeysOfTheFormerUnread) {
    const Scene lossless = read_scene("tanpura_c3", {"string.0.damping.law=none"});
    EXPECT_TRUE(lossless.strings[0].damping == Damping(NoDamping{}));
    const Scene flat = read_scene("sitar_c5", {"string.0.barrier.0.curve=flat"});
    EXPECT_TRUE(std::get<ProfileBarrier>(flat.strings[0].barriers[0]).curve == Curve(FlatCurve{}));
    const Scene mode =
        read_scene("free_string", {"string.0.start.shape=mode", "string.0.start.number=5"});
    EXPECT_TRUE(mode.strings[0].start == Start(ModeShape{5, 1e-3}));
}

TEST(Barriers, ThatAreRigidAreReadWrittenAndNeededByName) {
    const Scene scene = parse_scene(lumped, "scene.toml", {"string.0.barrier.0.stiffness=rigid"});
    EXPECT_EQ(std::get<LumpedBarrier>(scene.strings[0].barriers[0]).stiffness.k, rigid);
    EXPECT_TRUE(needed_by(scene).has(Feature::rigid_barrier));
    EXPECT_FALSE(needed_by(parse_scene(lumped, "scene.toml")).has(Feature::rigid_barrier));
    EXPECT_NE(write_scene(scene).find("stiffness = \"rigid\""), std::string::npos);
    EXPECT_TRUE(parse_scene(write_scene(scene), "again.toml") == scene);
    EXPECT_NE(message(lumped, {"string.0.barrier.0.stiffness=inf"}), "(read without an error)");
    const Scene profile =
        read_scene("sitar_parabola",
                   {"string.0.barrier.0.stiffness_density=rigid", "string.0.barrier.0.exponent=1"});
    EXPECT_TRUE(needed_by(profile).has(Feature::rigid_profile));
    EXPECT_TRUE(parse_scene(write_scene(profile), "again.toml") == profile);
    const Scene wall =
        read_scene("flat_bridge_ideal", {"string.0.barrier.0.stiffness_density=rigid"});
    EXPECT_TRUE(needed_by(wall).has(Feature::rigid_profile) &&
                is_rigid(wall.strings[0].barriers[0]));
    EXPECT_NE(write_scene(wall).find("stiffness_density = \"rigid\""), std::string::npos);
}

TEST(Barriers, AreNotRigidOverAWidthOnAnyScene) {
    int wide = 0;
    for (const std::string& name : library_scenes()) {
        Scene scene = read_scene(name);
        for (String& s : scene.strings)
            for (Barrier& b : s.barriers) {
                auto* lumped = std::get_if<LumpedBarrier>(&b);
                if (!lumped) continue;
                lumped->stiffness.k = rigid, lumped->exponent = 1, lumped->contact_loss = 0;
                if (const double width = lumped->width; width > 0) {
                    ++wide;
                    EXPECT_THROW(validate(scene), BadScene) << name;
                    lumped->width = 0;
                }
                EXPECT_NO_THROW(validate(scene)) << name;
            }
    }
    EXPECT_GE(wide, 8);
    EXPECT_NE(message(lumped, {"string.0.barrier.0.stiffness=rigid",
                               "string.0.barrier.0.width=1e-3", "string.0.bending_stiffness=1e-3"})
                  .find("To keep the width take stiffness = 1e+11 [N/m]"),
              std::string::npos);
}

// ---- A material and a diameter in place of two numbers

double first_mode(const Scene& scene) {  // [Hz]
    return modes_of(scene.strings.at(0), 1).omega0[0] / (2 * std::numbers::pi);
}

const std::string wire = head + "[[string]]\nlength = 1.0\ntension = 33.1\n";  // 3-5

TEST(Material, AWireOfItWeighsAndBendsAsTheLibrarysOwnStringsOfItDo) {
    // steel, as printed
    for (const auto& [scene, diameter] :
         {std::pair{"tanpura_c3", "0.28e-3"}, std::pair{"prepared_piano", "1e-3"}}) {
        const String printed = read_scene(scene).strings[0],
                     computed =
                         parse_scene(wire + "material = \"steel\"\ndiameter = " + diameter + "\n",
                                     "s.toml")
                             .strings[0];
        EXPECT_NEAR(computed.linear_density, printed.linear_density, 1e-3 * printed.linear_density)
            << scene;
        EXPECT_NEAR(computed.bending_stiffness, printed.bending_stiffness,
                    2e-3 * printed.bending_stiffness)
            << scene;
    }
    const String gut =
        parse_scene(wire + "material = \"gut\"\ndiameter = 1e-3\n", "s.toml").strings[0];
    EXPECT_NEAR(gut.linear_density, 1.0210e-3, 1e-7);     // pi 1300 / 4 10^-6
    EXPECT_NEAR(gut.bending_stiffness, 2.9452e-4, 1e-8);  // pi 6e9 / 64 10^-12
}

TEST(Material, APitchFollowsItAndAWrittenSceneSaysTheNumbers) {
    const Scene scene = parse_scene(head +
                                        "[[string]]\nlength = 1.0\nnote = \"C3\"\nmaterial = "
                                        "\"phosphor bronze\"\ndiameter = 0.3e-3\n",
                                    "s.toml");
    EXPECT_NEAR(first_mode(scene), 130.8127826503, 1e-9);
    EXPECT_EQ(write_scene(scene).find("material"), std::string::npos);
    EXPECT_TRUE(parse_scene(write_scene(scene), "again.toml") == scene) << write_scene(scene);
}

TEST(Material, OfAnOverrideWins) {
    const std::string steel = wire + "material = \"steel\"\ndiameter = 0.28e-3\n";  // 6, 7
    EXPECT_EQ(message(wire + "diameter = 1e-3\n").substr(0, 66),
              "scene.toml:3: string.0.material: found nothing, expected one of \"s");
    EXPECT_NE(
        message(wire + "material = \"stel\"\ndiameter = 1e-3\n").find("did you mean \"steel\"?"),
        std::string::npos);
    const auto of = [](const std::string& text, const std::vector<std::string>& set) {
        return parse_scene(text, "s.toml", set).strings[0];
    };
    EXPECT_EQ(of(steel, {"string.0.bending_stiffness=0"}).bending_stiffness, 0);
    EXPECT_EQ(of(steel, {"string.0.bending_stiffness=0"}).linear_density,
              of(steel, {}).linear_density);
    EXPECT_GT(of(steel, {"string.0.diameter=1e-3"}).linear_density, of(steel, {}).linear_density);
    const String nylon =
        read_scene("tanpura_c3", {"string.0.material=nylon", "string.0.diameter=1e-3"}).strings[0];
    EXPECT_NEAR(nylon.linear_density, 8.9535e-4, 1e-8);
}

// ---- Strings as they are sold

TEST(SoldStrings, WeighWhatTheirMakersSayAndWhatSteelAndTheirNeighboursDo) {
    std::vector<double> pounds_per_inch;
    const ColumnTo column[] = {{{"lb_per_in", "lb_per_in", positive}, &pounds_per_inch}};
    read_columns("gauges.csv", library_text("gauges.csv"), column);
    const std::vector<SoldString> sold = sold_strings();
    ASSERT_EQ(sold.size(), pounds_per_inch.size());
    ASSERT_GT(sold.size(), 40u);
    // to a solid wire of steel
    const auto ratio = [&](std::size_t k) {
        return sold[k].linear_density / linear_density_of(materials[0], 0.0254 * sold[k].gauge);
    };
    for (std::size_t k = 0; k < sold.size(); ++k) {
        const SoldString& s = sold[k];
        const std::string what = s.series + " " + std::to_string(s.gauge);
        EXPECT_NEAR(s.linear_density / (pounds_per_inch[k] * 0.45359237 / 0.0254), 1, 5e-5) << what;
        EXPECT_EQ(s.core.has_value(), s.series == "plain steel") << what;
        if (s.core) {
            EXPECT_NEAR(*s.core, 0.0254 * s.gauge, 1e-9) << what;
            EXPECT_NEAR(ratio(k), 1, 0.02) << what;
        } else if (s.maker == "GHS") {
            EXPECT_NEAR(ratio(k), 0.805, 0.05 * 0.805) << what;
        } else if (sold[k - 1].series == s.series && sold[k + 1].series == s.series) {
            const double a = sold[k - 1].gauge, b = sold[k + 1].gauge,
                         trend =
                             ratio(k - 1) + (ratio(k + 1) - ratio(k - 1)) * (s.gauge - a) / (b - a);
            EXPECT_NEAR(ratio(k), trend, 0.03 * trend) << what;
        }
    }
}

TEST(Tables, AreReadInTheUnitsThatTheirColumnsName) {
    const Directory d;
    const std::string text = one + "[string.damping]\nlaw = \"table\"\nfile = \"modes.csv\"\n",
                      file = (d.path / "scene.toml").string();
    const auto modes = [&](const std::string& csv) {
        d.write("modes.csv", csv);
        return std::get<TableDamping>(parse_scene(text, file).strings[0].damping);
    };
    const double pi = std::numbers::pi;
    // an amplitude of exp(-sigma t) falls to a thousandth within T60
    const TableDamping t60 = modes("f_Hz,T60_s\n100,2\n202,0.5\n");
    EXPECT_EQ(t60.frequency_hz, (std::vector<double>{100, 202}));
    EXPECT_NEAR(std::exp(-t60.decay_rate[0] * 2), 1e-3, 1e-17);
    EXPECT_NEAR(std::exp(-t60.decay_rate[1] * 0.5), 1e-3, 1e-17);
    const TableDamping q = modes("Q,frequency_kHz\n250,0.1\n");
    EXPECT_EQ(q.frequency_hz[0], 100);
    EXPECT_NEAR(q.decay_rate[0], pi * 100 / 250, 1e-15);
    EXPECT_NEAR(modes("f_kHz,zeta\n0.1,0.002\n").decay_rate[0], q.decay_rate[0], 1e-15);
    EXPECT_NEAR(modes("f_hz,tau_s\n100,0.25\n").decay_rate[0], 4, 1e-15);
    // SI names first, whatever stands beside them
    EXPECT_EQ(modes("q,frequency_hz,decay_rate_per_s\n1,100,3\n").decay_rate[0], 3);
    d.write("bridge.csv", "height_mm,x_mm\n0,0\n-0.1,33\n");
    const auto curve = [&](const std::string& to) {
        const Scene s =
            parse_scene(profile + "from = 0\nto = " + to + "\n", (d.path / "scene.toml").string(),
                        {"string.0.barrier.0.curve=table",
                         "string.0.barrier.0.file=" + (d.path / "bridge.csv").string()});
        return std::get<TableCurve>(std::get<ProfileBarrier>(s.strings[0].barriers[0]).curve);
    };
    EXPECT_EQ(curve("0.033").x, (std::vector<double>{0, 0.033}));
    EXPECT_EQ(curve("0.033").height, (std::vector<double>{0, -0.1e-3}));
}

// ---- Contacts

TEST(Contacts, MayHaveARestitutionInPlaceOfTheirLoss) {
    const auto loss = [](const std::string& keys, const std::vector<std::string>& set = {}) {
        return std::get<LumpedBarrier>(
                   parse_scene(lumped + keys, "s.toml", set).strings[0].barriers[0])
            .contact_loss;
    };
    const std::string both = "restitution = 0.6\nimpact_speed = 2\n";
    const double d = 2 * loss(both);  // (1 + e) d = ln((1 + d)/(1 - e d))
    EXPECT_NEAR(std::exp(1.6 * d), (1 + d) / (1 - 0.6 * d), 1e-12);
    EXPECT_EQ(loss(both, {"string.0.barrier.0.contact_loss=0.25"}), 0.25);
    EXPECT_LT(loss(both, {"string.0.barrier.0.restitution=0.9"}), loss(both));
    EXPECT_EQ(message(lumped + both + "contact_loss = 1\n"),
              "scene.toml:13: string.0.barrier.0.contact_loss: found 1, expected nothing beside "
              "restitution and impact_speed, which say as much");
    EXPECT_TRUE(message(lumped + "restitution = 0.6\n")
                    .ends_with("impact_speed: found nothing, expected a positive number [m/s]"));
    EXPECT_TRUE(message(lumped + "restitution = 0\nimpact_speed = 1\n")
                    .ends_with("restitution: found 0, expected a number above 0 and at most 1"));
}

TEST(Contacts, AboveAndWithAWeightAreWrittenAndNeedTheirFeatures) {
    const std::string text = lumped +
                             "side = \"above\"\n[[string.mass]]\nmass = 2e-4\nposition = 0.4\n"
                             "stiffness = 1e5\nspring = 300\ndamping = 0.02\nweight = 0.05\n";
    const Scene scene = parse_scene(text, "s.toml");
    EXPECT_TRUE(parse_scene(write_scene(scene), "again.toml") == scene) << write_scene(scene);
    for (const Feature f : {Feature::barrier_above, Feature::joined_mass, Feature::weighed_mass})
        EXPECT_TRUE(needed_by(scene).has(f)) << name_of(f);
    EXPECT_NEAR(scene.strings[0].masses[0].rest(), 0.05 / 300, 1e-18);
    EXPECT_TRUE(
        says(message(text, {"string.0.mass.0.spring=0"}), "none beside a weight without a spring"));
    EXPECT_TRUE(says(message(text, {"string.0.start=rest"}), "another start beside a mass"));
    EXPECT_TRUE(
        says(message(text, {"string.0.axial_stiffness=1"}), "none on a string that stretches"));
}

// ---- Pitch in place of tension

// 3-6
const std::string stiff =
    head + "[[string]]\nlength = 1.0\nlinear_density = 4.83e-4\nbending_stiffness = 6.03e-5\n";

TEST(Pitch, TheTensionIsThatAtWhichTheFirstModeHasIt) {
    EXPECT_NEAR(first_mode(parse_scene(stiff + "frequency = 130.5\n", "s.toml")), 130.5, 1e-11);
    EXPECT_NEAR(first_mode(parse_scene(stiff + "note = \"A4\"\n", "s.toml")), 440, 1e-10);
    // middle C
    EXPECT_NEAR(first_mode(parse_scene(stiff + "note = \"C4\"\n", "s.toml")), 261.6255653006, 1e-9);
    EXPECT_NEAR(first_mode(parse_scene(stiff + "note = \"F#2\"\n", "s.toml")),
                first_mode(parse_scene(stiff + "note = \"Gb2\"\n", "s.toml")), 1e-11);
    EXPECT_NEAR(2 * first_mode(parse_scene(stiff + "note = \"C-1\"\n", "s.toml")), 16.3515978313,
                1e-9);
    const double T = parse_scene(stiff + "note = \"C3\"\n", "s.toml").strings[0].tension;
    EXPECT_NEAR(T, 33.1, 0.05);  // the paper's C3, Table 1
    EXPECT_NEAR(
        parse_scene(head + "[[string]]\nlength = 1.0\nlinear_density = 4.83e-4\nnote = \"C3\"\n",
                    "s.toml")
            .strings[0]
            .tension,
        // without stiffness it has to pull more
        T + 6.03e-5 * std::numbers::pi * std::numbers::pi, 1e-12);
    // the file's tension stays unread
    EXPECT_NEAR(first_mode(read_scene("tanpura_c3", {"string.0.note=G2"})), 97.9988589954, 1e-9);
}

TEST(Pitch, OfANoteMayDeviateByCentsFromAConcertPitch) {
    const auto pitch = [](const std::string& note, const std::vector<std::string>& set = {}) {
        return first_mode(parse_scene(stiff + "note = \"" + note + "\"\n", "s.toml", set));
    };
    const double cent = std::exp2(1 / 1200.0);
    EXPECT_NEAR(pitch("A2 -14c"), 110 * std::pow(cent, -14), 1e-10);
    EXPECT_NEAR(pitch("A2 +1.5 cents"), 110 * std::pow(cent, 1.5), 1e-10);
    EXPECT_NEAR(pitch("A3", {"A4=415"}), 207.5, 1e-10);
    EXPECT_NEAR(first_mode(parse_scene("A4 = 442\n" + stiff + "note = \"A4 -3c\"\n", "s.toml")),
                442 * std::pow(cent, -3), 1e-10);
    for (const char* wrong : {"A2 14c", "A2 -14", "A2 -c", "A2 - 3 c", "A2-14 Hz", "A", "A2 "})
        EXPECT_TRUE(says(message(stiff + "note = \"" + wrong + "\"\n"), "or \"A2 -14c\"")) << wrong;
    EXPECT_EQ(message("A4 = 0\n" + stiff + "note = \"A2\"\n"),
              "scene.toml:1: A4: found 0, expected a positive number [Hz]");
}

TEST(Pitch, ASceneThatSaidItIsWrittenWithItsTensionAndReadsBackTheSame) {
    const Scene scene = parse_scene(stiff + "note = \"Eb3\"\n", "s.toml");
    const Scene again = parse_scene(write_scene(scene), "again.toml");
    EXPECT_TRUE(again == scene) << write_scene(scene);
    EXPECT_NE(write_scene(scene).find("tension = "), std::string::npos);
}

TEST(Pitch, ABarHasNoTensionAndABendingStiffness) {
    const String bar = parse_scene(stiff + "tension = 0\n", "s.toml").strings[0];
    const double pi = std::numbers::pi;
    for (int i = 1; i <= 3; ++i)  // (i pi/L)^2 sqrt(EI/mu)
        EXPECT_NEAR(modes_of(bar, 3).omega0[i - 1], i * i * pi * pi * std::sqrt(6.03e-5 / 4.83e-4),
                    1e-12 * i * i);
    EXPECT_NEAR(wave_impedance(bar), 4.83e-4 * modes_of(bar, 1).omega0[0] / pi, 1e-15);
    EXPECT_EQ(
        message(stiff + "tension = 0\n", {"string.0.bending_stiffness=0"}),
        "scene.toml:7: string.0.tension: found 0, expected a positive number [N], or beside it "
        "a bending_stiffness: a bar");
    EXPECT_TRUE(
        says(message(stiff + "tension = 0\n[string.damping]\nlaw = \"quality_factor\"\n"
                             "diameter = 1e-3\nair_viscosity = 1.8e-5\nair_density = 1.2\n"
                             "viscoelastic_angle = 1e-3\nthermoelastic_loss = 1e-4\n"),
             "expected another law: the bending loss of this one is a share of the tension"));
    EXPECT_TRUE(says(message(stiff + "tension = -1\n"), "found -1, expected a number >= 0 [N]"));
}

TEST(Pitch, TooLowForTheStiffnessIsAnError) {
    EXPECT_TRUE(message(stiff + "frequency = 0.1\n")
                    .starts_with("scene.toml:7: string.0.frequency: found 0.1, expected a pitch "
                                 "that a tension gives: the bending stiffness "
                                 "alone gives 0.555"));
}

// ---- Bad input

struct Bad {
    std::string text, says;
    std::vector<std::string> overrides = {};
};
// what no line of a text file can hold
std::vector<Bad> bad_scenes() {
    return {
        {"name = ",
         "scene.toml:1: not valid TOML: Error while parsing key-value pair: encountered "
         "end-of-file"},
        {"\xff\xfe", "scene.toml:1: not valid TOML: Encountered invalid utf-8 sequence"},
        {"x = " + std::string(5000, '['),
         "scene.toml:1: not valid TOML: Error while parsing value: exceeded maximum nested value "
         "depth of 256 (TOML_MAX_NESTED_VALUES)"},
        {std::string("a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a") +
             ".a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a = 1",
         "scene.toml:1: found a key with more than 64 dots, expected fewer"},
        {std::string((1 << 20) + 1, ' '),
         "scene.toml:1: found 1048577 bytes, expected at most 1048576"},
        {"", "scene.toml:1: name: found nothing, expected a text"},
        {lumped,
         "--set duration=1\nname=2: duration: found \"1\\u000Aname=2\", expected a positive "
         "number [s]",
         {"duration=1\nname=2"}},
    };
}

std::vector<Bad> listed_bad_scenes() {
    const std::map<std::string, std::string> beginnings{
        {"head", head},   {"one", one}, {"lumped", lumped}, {"profile", profile},
        {"stiff", stiff}, {"tap", tap}, {"wire", wire}};
    std::vector<Bad> all;
    std::ifstream in(JVARI_BAD_SCENES);
    bool new_one = true;
    for (std::string line; std::getline(in, line);) {
        if (line.empty() || line[0] == '#') continue;
        if (line.starts_with("> ")) {
            if (new_one) all.emplace_back();
            all.back().says += (new_one ? "" : " ") + line.substr(2);
            new_one = false;
            continue;
        }
        new_one = true;
        Bad& bad = all.back();
        if (line[0] == '@') bad.text = beginnings.at(line.substr(1));
        else if (line.starts_with("--set ")) bad.overrides.push_back(line.substr(6));
        else bad.text += line + "\n";
    }
    return all;
}

TEST(BadScenes, EachSaysWhereWhatWasFoundAndWhatWasExpected) {
    const auto listed = listed_bad_scenes();
    EXPECT_GT(listed.size(), 100u);
    for (const auto& table : {bad_scenes(), listed})
        for (const Bad& bad : table)
            EXPECT_EQ(message(bad.text, bad.overrides), bad.says) << bad.text.substr(0, 300);
}

TEST(BadScenes, TheTextsTheyAreMadeFromAreGood) {
    for (const std::string& text :
         {one, lumped, profile + "from = 0\nto = 0.1\n", tap + "quantity = \"nut_force\"\n"})
        EXPECT_EQ(message(text), "(read without an error)");
}

TEST(BadScenes, AMissingSceneNamesTheNearestOfTheLibrary) {
    const auto says = [](const std::string& name) {
        try {
            read_scene(name);
        } catch (const SceneFileError& e) { return std::string(e.what()); }
        return std::string();
    };
    EXPECT_EQ(
        says("tanpura_c4"),
        "\"tanpura_c4\": neither a file nor a scene of the library; did you mean \"tanpura_c3\"?");
    EXPECT_EQ(says("no/such/scene.toml"), "\"no/such/scene.toml\" cannot be read");
    EXPECT_EQ(says("/"), "\"/\" is no file");
    EXPECT_EQ(says("/dev/zero"), "\"/dev/zero\" is larger than 1048576 bytes");
}

TEST(Validate, ChecksScenesThatNoFileHasSeen) {
    Scene scene = read_scene("tanpura_c3");
    scene.strings[0].damping = PerPeriodDamping{1.5};
    try {
        validate(scene);
        FAIL();
    } catch (const BadScene& e) {
        EXPECT_EQ(e.key, "string.0.damping.factor");
        EXPECT_EQ(e.found, "1.5");
        EXPECT_EQ(e.expected, "a number above 0 and at most 1");
    }
    scene = read_scene("tanpura_c3");
    scene.taps[0].string = 1000000000;
    EXPECT_THROW(validate(scene), BadScene);
    scene.strings.clear();
    EXPECT_THROW(validate(scene), BadScene);
}

}  // namespace
}  // namespace jvari
