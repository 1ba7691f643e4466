// Files that a call names: results that would replace one another or what is read, tables and
// states that are not what they seem, folders that two studies want.
#include <nlohmann/json.hpp>

#include "tests/command_line.hpp"

namespace jvari::test {
namespace {

const std::string c3 =
    "timeout 30 $J run tanpura_c3_release --scheme modal_two_point --duration 0.005 --modes 40 ";

TEST(Files, NoResultReplacesAnotherOrWhatIsRead) {
    const Scratch scratch;
    shell(scratch,
          "$J new tanpura mine; cp mine.toml scene.txt; cp mine.toml kept.toml\n"
          "printf 'mode,displacement_m,velocity_m_per_s\\n1,1e-3,0\\n' >s.csv");
    const std::string mine = "$J run mine.toml --scheme modal_two_point --duration 0.005 ",
                      own = "$J run ./scene.txt --scheme modal_two_point --duration 0.005 ";
    for (const auto& [line, message] : {
             std::pair{c3 + "--out o.csv --state o.csv", "--state o.csv: --out writes that file"},
             {c3 + "--out o.csv --impacts ./o.csv", "--impacts ./o.csv: --out writes that file"},
             {"ln -s o.csv link.csv; " + c3 + "--out o.csv --state link.csv", "--out writes that"},
             {mine + "--state mine.toml", "--state mine.toml: scenes end in .toml"},
             {mine + "--impacts kept.toml", "--impacts kept.toml: scenes end in .toml"},
             {own + "--state scene.txt", "--state scene.txt: this is the scene, which would be"},
             {own + "--set string.0.start=s.csv --out s.csv",
              "s.csv: this is a table of the scene"},
             {std::string("$J export mine.toml --duration 0.005 --out mine.toml"), "end in .toml"},
             {std::string("$J export ./scene.txt --duration 0.005 --out scene.txt"), "the scene"},
             {std::string("$J check modal_two_point --only energy --junit mine.toml"), ".toml"},
         })
        EXPECT_TRUE(ends(shell(scratch, line), 2, message)) << line;
    EXPECT_EQ(content(scratch / "mine.toml"), content(scratch / "kept.toml"));
    EXPECT_EQ(content(scratch / "scene.txt"), content(scratch / "kept.toml"));
    EXPECT_FALSE(std::filesystem::exists(scratch / "o.csv"));
}

TEST(Files, AStateThatARunCannotGoOnFromIsRefusedWithoutACounterclaim) {
    const Scratch scratch;
    const Ended o = shell(scratch,
                          "$J run rigid_point_bridge --scheme modal_two_point --duration 0.005 "
                          "--state s.csv");
    EXPECT_TRUE(ends(o, 2, "modal_two_point keeps more than displacement and velocity"));
    EXPECT_TRUE(says(o.err, "Expected one string without masses and rigid barriers"));
    EXPECT_EQ(o.err.find("do not, without"), std::string::npos) << o.err;
}

TEST(Files, AStateSaysWhoseItIsAndWhatOfItARunLeavesOut) {
    const Scratch scratch;
    shell(scratch, c3 + "--state s.csv");
    const std::string start =
        " --duration 0.005 --scheme modal_two_point --set string.0.start=s.csv";
    const Ended other = shell(scratch, "$J run free_string" + start),
                fewer = shell(scratch, "$J run tanpura_c3_release --modes 20" + start),
                same = shell(scratch, "$J run tanpura_c3_release --modes 40" + start);
    EXPECT_TRUE(says(other.err, "s.csv is a state of tanpura_c3_release, and this scene is free_"));
    EXPECT_TRUE(says(fewer.err, "moves modes up to 40, and this run has 20"));
    EXPECT_EQ(same.err, "");
    EXPECT_EQ(same.code, 0);
}

// f1 = 130.8 Hz; the table of the review: f_i = 130.9 i sqrt(1 + 1.8e-5 i^2)
TEST(Files, ModesAreThoseThatTheirColumnNumbers) {
    const Scratch scratch;
    const std::string make =
        "$J new tanpura x >/dev/null; python3 - <<'P'\n"
        "import math, re\n"
        "rows = [(i, 130.9*i*math.sqrt(1+1.8e-5*i*i), 0.6+6.5e-3*math.pi*i+5e-6*(math.pi*i)**3) "
        "for i in range(1, 134)]\n"
        "s = open('x.toml').read()\n"
        "open('x.toml', 'w').write(re.sub(r'law = "
        "\"polynomial\"\\nsigma0.*\\nsigma1.*\\nsigma3.*', "
        "'law = \"table\"\\nfile = \"t.csv\"', s))\n"
        "def put(name, rows, head='mode,frequency_hz,decay_rate_per_s', scale=1):\n"
        "    open(name, 'w').write(head + '\\n' + ''.join(','.join(repr(v) for v in ((i,) if "
        "'mode' in head else ()) + (f*scale, d)) + '\\n' for i, f, d in rows))\n"
        "put('all.csv', rows)\n"
        "put('gap.csv', [r for r in rows if r[0] not in (3, 7, 8)])\n"
        "put('bare.csv', [r for r in rows if r[0] != 3], 'frequency_hz,decay_rate_per_s')\n"
        "put('khz.csv', rows, 'frequency_hz,decay_rate_per_s', 1e-3)\n"
        "P\n";
    shell(scratch, make);
    const auto with = [&](const std::string& table) {
        return shell(scratch, "cp " + table +
                                  ".csv t.csv; timeout 30 $J run x.toml --scheme "
                                  "modal_two_point --duration 0.05 --json");
    };
    const auto force = [](const Ended& o) {
        return nlohmann::json::parse(o.out).at("largest_contact_force").get<double>();
    };
    const Ended all = with("all"), gap = with("gap"), khz = with("khz");
    ASSERT_EQ(gap.code, 0) << gap.err;
    EXPECT_EQ(all.err, "");
    EXPECT_NEAR(force(gap) / force(all), 1, 1e-3);
    EXPECT_TRUE(says(gap.err, "t.csv has no row of mode 3, 7, 8: frequency and decay rate"));
    EXPECT_TRUE(ends(with("bare"), 2, "Is one missing? A column \"mode\""));
    EXPECT_TRUE(says(khz.err, "is at 0.1309 Hz, and length, tension and linear_density give 130."));
    EXPECT_TRUE(says(shell(scratch,
                           "cp khz.csv t.csv; $J run x.toml --scheme modal_two_point "
                           "--duration 0.005")
                         .out,
                     "f1 = 0.1309 Hz"));
}

TEST(Files, AForceMuchLongerThanItsRunIsAskedAbout) {
    const Scratch scratch;
    const Ended o =
        shell(scratch,
              "printf 'time_s,force_N\\n0,0\\n10,1\\n50,0\\n' >f.csv; $J run tanpura_c3 --modes 20 "
              "--scheme modal_two_point --duration 0.02 --set string.0.pluck.file=f.csv");
    EXPECT_TRUE(says(o.err, "lasts 50 s, and the run 0.02 s. Is time_s in s?"));
}

// A pluck of 1e6 s is 4e10 steps: no more of them is computed than the run has.
TEST(Files, AForceIsComputedAsFarAsTheRunLasts) {
    const Scratch scratch;
    const std::string run =
        "timeout 10 $J run tanpura_c3 --scheme modal_two_point --modes 20 "
        "--duration 0.02 --set string.0.pluck.duration=";
    EXPECT_TRUE(ends(shell(scratch, run + "1e6"), 0, "status"));
    EXPECT_TRUE(ends(shell(scratch, run + "1e300"), 3, "the pluck ends at 1e+300 s, after more "));
}

TEST(Files, OfTheFolderThatAreNoFilesAreNotReadFrom) {
    const Scratch scratch;
    EXPECT_TRUE(ends(shell(scratch,
                           "mkfifo gauges.csv; timeout 5 $J new guitar my --material "
                           "'nickel wound' --diameter 0.054in"),
                     2, "gauges.csv of this folder is no file"));
    const auto with = [&](const std::string& row) {
        return shell(scratch,
                     "rm -f gauges.csv; printf "
                     "'maker,series,gauge_in,linear_density_kg_per_m,core_diameter_m\\n" +
                         row +
                         "\\n' >gauges.csv; $J new guitar my --material round "
                         "--diameter 0.01in");
    };
    EXPECT_TRUE(ends(with("M\\374ller,round,0.01,4e-4,"), 2, "gauges.csv:2: maker: found"));
    EXPECT_TRUE(ends(with("A,round,0.01,4e-4,5e-4"), 2, "gauges.csv:2: core_diameter_m: found"));
    EXPECT_TRUE(ends(with("M\\303\\274ller,round,0.01,4e-4,"), 0, "written: my.toml"));
}

TEST(Files, AGridSaysThatItLeavesModesAsideAndIsComparedOnce) {
    const Scratch scratch;
    const std::string fd = "finite_difference_explicit";
    EXPECT_TRUE(
        says(shell(scratch, "$J run free_string --duration 0.005 --modes 30 --scheme " + fd).err,
             "its grid follows from the rate, and modes = 30 is left aside"));
    const Ended o = shell(scratch,
                          "$J compare free_string --duration 0.005 --rates 44100 --modes "
                          "20,40 --repeats 2 --json --schemes modal_two_point," +
                              fd);
    ASSERT_EQ(o.code, 0) << o.err;
    int grids = 0, all = 0;
    const auto answer = nlohmann::json::parse(o.out);
    for (const auto& row : answer.at("cells")) grids += row.at("scheme") == fd, ++all;
    EXPECT_EQ(grids, 1);
    EXPECT_EQ(all, 3);
    EXPECT_TRUE(says(o.err, "modes = 20,40 is left aside"));
}

// The second study begins while the first has written nothing yet, and so does the third.
TEST(Files, AFolderHasOneStudyAtATime) {
    const Scratch scratch;
    const auto study = [](const std::string& arguments) {
        return "(timeout 60 $J compare " + arguments +
               " --schemes modal_two_point --repeats 2 --out two --quiet; echo $? >>codes)";
    };
    const std::string brief = " --rates 44100 --modes 20 --reference-modes 40 --duration 0.01";
    const Ended o = shell(
        scratch, study("tanpura_c3_release --rates 44100,88200 --modes 40 --duration 0.3 "
                       "--reference-modes 320") +
                     " &\nfor k in $(seq 200); do ls two/cells/*.lock >/dev/null 2>&1 && break; "
                     "sleep 0.02; done\n" +
                     study("guitar_over_fret" + brief) + "\n" +
                     study("tanpura_c3_release" + brief) + "\nwait");
    EXPECT_EQ(content(scratch / "codes"), "2\n2\n0\n");
    EXPECT_TRUE(says(o.err, "--out two: a process is at work there on the comparison of tanpura"));
    EXPECT_TRUE(says(o.err, "--out two: a process is at work there on another comparison of tan"));
    EXPECT_FALSE(std::filesystem::exists(scratch / "two/cells/study.lock"));
}

TEST(Files, TheCommandOfARecordIsOneThatAShellReadsBack) {
    const Scratch scratch;
    ASSERT_EQ(shell(scratch,
                    "$J new tanpura t; mv t.toml \"it's \\$(mine).toml\"; $J compare "
                    "\"it's \\$(mine).toml\" --schemes modal_two_point --rates 44100 "
                    "--modes 10 --reference-modes 20 --duration 0.005 --repeats 2 --out m")
                  .code,
              0);
    const auto manifest = nlohmann::json::parse(content(scratch / "m/manifest.json"));
    overwrite(scratch / "again", "jvari() { printf '%s' \"$2\"; }\n" +
                                     manifest.at("command").get<std::string>() + "\n");
    EXPECT_EQ(shell(scratch, "sh ./again").out, "it's $(mine).toml");
}

}  // namespace
}  // namespace jvari::test
