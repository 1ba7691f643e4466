// Suites: what a file spreads out to, and that a suite which was stopped ends like one that was
// not.
#include <chrono>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "bench/store/encoding.hpp"
#include "bench/store/machine.hpp"
#include "bench/study/cells.hpp"
#include "bench/study/cost.hpp"
#include "bench/study/run.hpp"
#include "bench/suite/suite.hpp"
#include "scenes/scene_file.hpp"
#include "tests/command_line.hpp"
#include "tests/suite_text.hpp"

namespace jvari::test {
namespace {

namespace fs = std::filesystem;

bench::store::Table all_of(const bench::study::Plan& plan,
                           const std::vector<bench::study::Record>& records) {
    return table_of(cells_of(plan, records), bench::study::Contents::everything);
}
std::string repeating(const bench::study::Plan& plan,
                      const std::vector<bench::study::Record>& records) {
    const bench::study::Cells cells = cells_of(plan, records);
    return csv(table_of(cells, bench::study::Contents::facts)) + csv(errors_table(cells));
}

// ---- The file

TEST(SuiteFile, SpreadsOutToTheProductOfWhatItLists) {
    const bench::suite::Suite suite = bench::suite::parse_suite(R"(
        [[cells]]
        scenes = ["free_string", "sitar_c5_decay"]
        schemes = ["modal_two_point", "sitar_fdm"]
        rates = [44100, 88200, 176400]
        modes = [5, 10]
        reference_modes = "cell"
        duration = 0.01
        sweep = { "string.0.tension" = [30, 31.5], "tap.0.name" = ["a"] }
        [[cells]]
        scenes = "free_string"
        schemes = ["modal_two_point", "sitar_fdm"]
        rates = [44100, 88200, 176400]
        modes = 5
        reference_modes = "cell"
        duration = 0.01
        sweep = { "string.0.tension" = [30], "tap.0.name" = ["a"] }
    )",
                                                                "a.toml");
    const auto points = bench::suite::points_of(suite.sets);
    ASSERT_EQ(points.size(), 2u * 2 * 2 + 1);
    EXPECT_EQ(points[1].request.set,
              (std::vector<std::string>{"string.0.tension=31.5", "tap.0.name=\"a\""}));
    const bench::study::Plan plan =
        bench::suite::plan_of(suite.sets, bench::compare::Catalogue(), {});
    // the second set repeats six cells of the first
    EXPECT_EQ(plan.jobs.size(), 2u * 2 * 2 * 2 * 3);
    std::set<std::string> ids;
    for (const bench::study::Job& c : plan.jobs) ids.insert(c.id);
    EXPECT_EQ(ids.size(), plan.jobs.size());
    EXPECT_EQ(plan.points[1].scene.strings[0].tension, 31.5);
    EXPECT_EQ(plan.points[0].scene.duration, 0.01);
}

TEST(SuiteFile, TheTruthDoesNotShrinkWithTheModesThatVary) {
    const auto truth = [](const std::string& more) {
        return bench::suite::parse_suite(
                   "[[cells]]\nscenes = [\"free_string\"]\nschemes = [\"modal_two_point\"]\nrates "
                   "= [44100]\n" +
                       more,
                   "a.toml")
            .sets[0]
            .reference_modes;
    };
    EXPECT_EQ(truth("modes = [5, 10]\n"), 0);  // doubled until nothing moves
    EXPECT_EQ(truth("modes = [5, 10]\nreference_modes = 64\n"), 64);
    EXPECT_EQ(truth("modes = [5, 10]\nreference_modes = \"cell\"\n"), std::nullopt);
    EXPECT_EQ(truth("modes = 5\n"), 0);
    EXPECT_EQ(truth(""), 0);
    EXPECT_TRUE(says(refusal_of("[[cells]]\nscenes = [\"b\"]\nreference_modes = \"cel\"\n"),
                     "a whole number from 0 to 9999999, or \"cell\""));
}

TEST(SuiteFile, WhatASetDoesNotNameIsSoughtUnlessItSaysNot) {
    const auto cells = [](const std::string& more) {
        const auto suite = bench::suite::parse_suite(
            "[[cells]]\nscenes = [\"tanpura_c3_release\"]\nschemes = [\"modal_two_point\"]\nrates "
            "= [44100, 88200]\n" +
                more,
            "a.toml");
        std::vector<std::string> all;
        for (const auto& c :
             bench::suite::plan_of(suite.sets, bench::compare::Catalogue(), {}).jobs)
            all.push_back(bench::store::options_text(c.cell.settings.options) + " " +
                          std::to_string(c.cell.settings.modes));
        return all;
    };
    using Cells = std::vector<std::string>;
    const Cells unasked{" 133", " 133"};
    EXPECT_EQ(cells(""), (Cells{"compliance=own 133", "compliance=own 133", "compliance=own 200",
                                "compliance=matched 133", "compliance=matched 133",
                                "compliance=matched 200"}));
    EXPECT_EQ(cells("search = false\n"), unasked);
    EXPECT_EQ(cells("reference_modes = \"cell\"\n"), unasked);
    // what is not measured cannot be sought
    EXPECT_EQ(cells("measure = \"spectrogram\"\n"), unasked);
    EXPECT_EQ(cells("modes = 60\noptions = { compliance = \"matched\" }\n"),
              (Cells{"compliance=matched 60", "compliance=matched 60"}));
}

TEST(SuiteFile, OptionsVaryForTheSchemeThatTheyName) {
    const Planned plan(R"(
        [[cells]]
        scenes = ["sitar_c5_ideal"]
        schemes = ["sitar_waveguide", "sitar_fdm"]
        rates = [44100]
        options = { "sitar_waveguide:length" = ["integer", "fractional"] }
        measure = ["spectrogram"]
    )");
    // sitar_fdm is the same at both points, and no reference differs
    ASSERT_EQ(plan.jobs.size(), 3u);
    EXPECT_EQ(bench::store::options_text(plan.jobs[0].cell.settings.options), "length=integer");
    EXPECT_EQ(bench::store::options_text(plan.jobs[2].cell.settings.options), "length=fractional");
}

TEST(SuiteFile, TapsBesideThoseOfTheSceneAreJudgedToo) {
    const std::string set = "[[cells]]\nscenes = [\"free_string\"]\n";
    EXPECT_TRUE(
        says(refusal_of(set + "taps = [{ name = \"a\", quantity = \"velocty\" }]"),
             "a.toml:3: cells.0.taps.0.quantity: unknown quantity \"velocty\"; did you mean"));
    for (const char* number : {"0.5", "1e300"})
        EXPECT_TRUE(says(
            refusal_of(set + "taps = [{ name = \"a\", quantity = \"velocity\", string = " + number +
                       " }]"),
            "expected a whole number from 0 to 1000"));
    const Planned plan(set + R"(schemes = ["modal_two_point"]
rates = [44100]
modes = 5
reference_modes = "cell"
duration = 0.01
taps = [{ name = "middle", quantity = "displacement", string = 0, position = 0.5 }])");
    const bench::study::Cells cells = bench::study::cells_of(plan, plan.run().records);
    EXPECT_EQ(cells[0].status, "ok") << cells[0].reason;
    EXPECT_GE(cells[0].figure(bench::study::measure("error_l2_whole"), "middle").value, 0);
}

TEST(SuiteFile, DotsAreCountedInKeysAlone) {
    const auto suite = [](const std::string& more) {
        return "[[cells]]\nscenes = [\"b\"]\n" + more + "\n";
    };
    std::string numbers, dots;
    for (int k = 1; k <= 80; ++k)
        numbers += (k > 1 ? ", " : "") + std::to_string(k) + ".5", dots += ".a";
    const std::string full(80, '.');
    const std::string sound[] = {
        suite("rates = [" + numbers + "]"),
        suite("sweep = { \"string.0.tension\" = [" + numbers + "] }"),
        "source = \"" + full + "\"\n" + suite(""),
        "source = '''\n" + full + " it's \n'''  # " + full + "\n" + suite("")};
    for (const std::string& text : sound) EXPECT_EQ(refusal_of(text), "read");
    const std::string keys[] = {"a" + dots + " = 1",
                                "[a" + dots + "]",
                                "x = { a" + dots + " = 1 }",
                                "x = [{ b = \"\", a" + dots + " = 1 }]",
                                "x = \"\"\"it's\"\"\"\"\na" + dots + " = '\"'",
                                "x = '''\"'''\na" + dots + " = 1 # \"",
                                "\",\"" + dots + ".\",\"" + dots + " = 1",
                                "x = \"\\\"\"\na" + dots + " = 1",
                                "x = 'a\\'\na" + dots + " = 1"};
    for (const std::string& key : keys)
        EXPECT_TRUE(says(refusal_of(suite(key)), "found a key with more than 64 dots")) << key;
}

TEST(SuiteFile, WhatItDoesNotKnowIsAnErrorWithFileAndLine) {
    EXPECT_EQ(refusal_of("nmae = \"a\"\n[[cells]]\nscenes = [\"b\"]")
                  .rfind("a.toml:1: unknown key \"nmae\"; did you mean \"name\"?", 0),
              0u);
    const std::pair<const char*, const char*> cases[] = {
        {"[[cells]]\nscenes = [\"b\"]\nraets = [1]",
         "a.toml:3: cells.0: unknown key \"raets\"; did you mean \"rates\"?"},
        {"name = \"a\"", "[[cells]]"},
        {"[[cells]]\nrates = [1]", "scenes is missing"},
        {"[[cells]]\nscenes = []",
         "a.toml:2: cells.0.scenes: found an array, expected at least one value"},
        {"[[cells]]\nscenes = [\"b\", 3]", "a.toml:2: cells.0.scenes.1: found 3, expected a text"},
        {"[[cells]]\nscenes = [\"b\"]\nrates = [-1]",
         "a.toml:3: cells.0.rates.0: found -1, expected a number > 0"},
        {"[[cells]]\nscenes = [\"b\"]\nmodes = 1.5",
         "a.toml:3: cells.0.modes: found 1.5, expected a whole number from 1 to 9999999"},
        {"[[cells]]\nscenes = [\"b\"]\nsweep = { x = 3 }",
         "expected an array of the values to vary, or { from, to, points }"},
        {"[[cells]]\nscenes = [\"b\"]\nmeasure = [\"eror\"]", "unknown measure"},
        {"[[cells]]\nscenes = [\"b\"]\nmeasure = [\"cost\"]", "no speed without an error"},
        {"[[cells]]\nscenes = [\"b\"]\nreference_modes = 10000000", "from 0 to 9999999"},
        {"[[cells]]\nscenes = [\"b\"", "not valid TOML"},
    };
    for (const auto& [text, expected] : cases) EXPECT_TRUE(says(refusal_of(text), expected));
}

TEST(SuiteFile, OfMoreCellsThanCanBeRunIsRefusedBeforeTheyArePlanned) {
    const auto listed = [](int count) {
        std::string text = "[1";
        for (int k = 2; k <= count; ++k) text += ", " + std::to_string(k);
        return text + "]";
    };
    const std::string head =
        "[[cells]]\nscenes = [\"b\"]\nrates = " + listed(100) + "\nmodes = " + listed(100);
    EXPECT_NO_THROW(
        bench::suite::parse_suite(head + "\nsweep = { x = " + listed(100) + " }", "a.toml"));
    for (const std::string& one_more :
         {"\nsweep = { x = " + listed(101) + " }", "\noptions = { x = " + listed(101) + " }",
          "\nsweep = { x = " + listed(51) + ", y = " + listed(2) + " }"})
        EXPECT_TRUE(says(refusal_of(head + one_more), "a.toml:1: cells.0: found 10"));
}

TEST(SuiteFile, EverySuiteOfTheLibraryCanBePlanned) {
    for (const std::string& name : bench::suite::library_suites()) {
        const bench::suite::Suite suite = bench::suite::read_suite(name);
        EXPECT_FALSE(plan_of(suite.sets, bench::compare::Catalogue(), {}).jobs.empty() &&
                     plan_of(suite.maps, bench::compare::Catalogue(), {}).jobs.empty())
            << name;
    }
    const bench::suite::Suite sitar = bench::suite::read_suite("paper-deshmukh");
    const auto jobs = plan_of(sitar.sets, bench::compare::Catalogue(), {}).jobs;
    // seven variants, two schemes
    EXPECT_EQ(std::ranges::count(jobs, 0, &bench::study::Job::set), 14);
}

// ---- Running

std::atomic<int> makes = 0;
const Descriptor& original() {
    static const bench::compare::Catalogue catalogue;
    return catalogue.find("modal_two_point");
}
std::unique_ptr<Scheme> counted(const Descriptor&, const Scene& scene, const Settings& settings) {
    ++makes;
    return make_scheme(original(), scene, settings);
}

class Slow : public Scheme {  // 2 ms of work for each block
public:
    void reset() noexcept override {}
    Status advance(const Block& out) noexcept override {
        const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(2);
        while (std::chrono::steady_clock::now() < until) {}
        for (int k = 0; k < out.taps; ++k) std::fill_n(out.tap + k * out.stride, out.rows, 0.0);
        for (int k = 0; out.energy && k < 3; ++k)
            std::fill_n(out.energy + k * out.stride, out.rows, 0.0);
        return {};
    }
    int dofs() const override { return 0; }
};

struct Workshop {  // the schemes of the program, and three for the tests
    Descriptor counting{original()}, slow{original()}, unwilling{original()}, stumbling{original()};
    bench::compare::Catalogue catalogue;
    bench::store::Listener listener;
    Workshop() {
        counting.name = "counting";
        counting.make = counted;
        slow.name = "slow";
        slow.make = [](const Descriptor&, const Scene&,
                       const Settings&) -> std::unique_ptr<Scheme> {
            return std::make_unique<Slow>();
        };
        unwilling.name = "unwilling";
        unwilling.make = [](const Descriptor&, const Scene&,
                            const Settings&) -> std::unique_ptr<Scheme> {
            throw Refusal("it is not willing");
        };
        stumbling.name = "throwing";
        stumbling.make = [](const Descriptor&, const Scene&,
                            const Settings&) -> std::unique_ptr<Scheme> {
            throw std::runtime_error("out of luck");
        };
        for (const Descriptor* d : {&counting, &slow, &unwilling, &stumbling})
            catalogue.schemes.push_back(d);
    }
};

constexpr const char* counting_suite = R"(
    [[cells]]
    scenes = ["free_string", "tanpura_c3"]
    schemes = ["counting"]
    rates = [44100, 88200]
    modes = [10]
    reference_modes = "cell"
    duration = 0.06
    repeats = 2
    sweep = { "string.0.tension" = [30, 33] }
    measure = ["errors", "cost", "spectrogram"]
)";

TEST(SuiteRun, WhatIsResumedAfterItsEndDoesNothingTwice) {
    const Scratch scratch;
    const Workshop w;
    const Planned plan(counting_suite, w.catalogue);
    ASSERT_EQ(plan.jobs.size(), 8u);
    makes = 0;
    const bench::study::Study first = bench::study::run(plan, scratch.path, false, 2, w.listener);
    EXPECT_EQ(first.ran, 8);
    EXPECT_EQ(first.timed, 8);
    EXPECT_EQ(makes, 8 * (1 + 2));  // each once for its errors and twice for the clock
    const bench::study::Study second = bench::study::run(plan, scratch.path, true, 2, w.listener);
    EXPECT_EQ(makes, 8 * (1 + 2));
    EXPECT_EQ(second.read_back, 8);
    EXPECT_EQ(second.ran + second.timed, 0);
    // clock columns too
    EXPECT_EQ(csv(all_of(plan, second.records)), csv(all_of(plan, first.records)));
    EXPECT_EQ(second.records[0].levels.level, first.records[0].levels.level);
    // as the page reads it
    const auto drawn =
        bench::study::read_levels(scratch.path / (plan.jobs[0].id + ".json"), "spectrogram");
    ASSERT_TRUE(drawn);
    EXPECT_EQ(drawn->level, first.records[0].levels.level);
    EXPECT_FALSE(bench::study::read_levels(scratch.path / (plan.jobs[0].id + ".json"), "another"));
    EXPECT_EQ(scratch.files(), 8 + 8);  // numbers and clocks

    const bench::store::Table t = all_of(plan, first.records);
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        EXPECT_EQ(t.text(i, "status"), "ok") << t.text(i, "reason");
        EXPECT_GT(t.number(i, "error_l2_whole"), 0);
        EXPECT_GT(t.number(i, "cost_s_per_s"), 0);
        EXPECT_EQ(t.text(i, "string.0.tension"), i % 4 < 2 ? "30" : "33");
        EXPECT_FALSE(t.text(i, "reference").empty());
    }
}

TEST(SuiteRun, ACellIsBelievedWhereItIsAsItWasWritten) {
    const Scratch scratch;
    const Workshop w;
    const Planned plan(counting_suite, w.catalogue);
    const std::string whole =
        repeating(plan, bench::study::run(plan, scratch.path, false, 2, w.listener).records);
    const std::string path = scratch / (plan.jobs[2].id + ".json"), kept = content(path);
    const auto ran_with = [&](const std::string& text) {
        std::ofstream(path, std::ios::binary) << text;
        const bench::study::Study resumed =
            bench::study::run(plan, scratch.path, true, 2, w.listener);
        EXPECT_EQ(repeating(plan, resumed.records), whole);
        return resumed.ran;
    };
    EXPECT_EQ(ran_with(kept), 0);
    std::string altered = kept;
    const auto digit = altered.find_first_of("123456789", altered.find("error_l2_50ms") + 20);
    altered[digit] = altered[digit] == '1' ? '2' : '1';
    EXPECT_EQ(ran_with(altered), 1);
    // as versions without checksums wrote it
    EXPECT_EQ(ran_with(kept.substr(0, kept.find(",\n \"checksum")) + "}\n"), 1);
}

// be the checksum right
TEST(SuiteRun, ASoundWithoutItsFieldsIsNotBelieved) {
    const Scratch scratch;
    const bench::suite::Suite suite = bench::suite::parse_suite(R"(
        [[cells]]
        scenes = ["free_string"]
        schemes = ["modal_two_point"]
        rates = [44100]
        duration = 0.01
        measure = ["errors", "sound"]
    )",
                                                                "a.toml");
    const Workshop w;
    const bench::study::Plan plan = bench::suite::plan_of(suite.sets, w.catalogue, {});
    bench::study::run(plan, scratch.path, false, 1, w.listener);
    const std::string path = scratch / (plan.jobs[0].id + ".json");
    auto json = nlohmann::ordered_json::parse(bench::store::unsealed(content(path)));
    json["reference_sound"] = nlohmann::ordered_json::array();
    std::ofstream(path) << bench::store::sealed(json.dump());
    EXPECT_EQ(bench::study::run(plan, scratch.path, true, 1, w.listener).ran, 1);
}

TEST(SuiteRun, WhatAnotherProgramRecordedIsRunAgain) {
    const Scratch scratch;
    const Workshop w;
    const Planned plan(counting_suite, w.catalogue);
    bench::study::run(plan, scratch.path, false, 2, w.listener);
    const std::string another = "0123456-another";
    // a file of this cell's name, of another program
    const auto recorded_by_another = [&](int cell, const std::string& what) {
        const fs::path path = scratch.path / (plan.jobs[cell].id + ".json");
        std::string text = bench::store::unsealed(content(path));
        const std::string own = nlohmann::json(what).dump();
        const auto at = text.find(own, text.find("\"program\""));
        ASSERT_NE(at, std::string::npos) << what;
        std::ofstream(path) << bench::store::sealed(
            text.replace(at, own.size(), nlohmann::json(another).dump()));
    };
    recorded_by_another(1, bench::store::machine().cell_sources);
    recorded_by_another(2, bench::store::machine().build);
    recorded_by_another(5, bench::store::machine().compiler);
    const bench::study::Study resumed = bench::study::run(plan, scratch.path, true, 2, w.listener);
    EXPECT_EQ(resumed.ran, 3);
    EXPECT_EQ(resumed.read_back, 5);
}

TEST(SuiteRun, TheIdentityOfAProgramIsWhatItsNumbersDependOn) {
    using bench::store::Machine;
    const Scratch scratch;
    const std::string own = bench::store::program_identity({});
    EXPECT_EQ(own, bench::store::program_identity({}));
    for (std::string Machine::*part : {&Machine::cell_sources, &Machine::compiler, &Machine::flags,
                                       &Machine::build, &Machine::vectors}) {
        Machine other = bench::store::machine();
        other.*part += "x";
        EXPECT_NE(program_identity({}, other), own);
        EXPECT_EQ(run_identity(other) == bench::store::run_identity(),
                  part == &Machine::cell_sources);
    }
    Machine reworded = bench::store::machine();  // another commit, of the documentation
    reworded.commit += "x";
    EXPECT_EQ(program_identity({}, reworded), own);
    Machine other_run = bench::store::machine();
    other_run.run_sources += "x";
    EXPECT_NE(run_identity(other_run), bench::store::run_identity());
    std::ofstream(scratch / "plugin") << "a";
    const std::string with_plugin = bench::store::program_identity({scratch / "plugin"});
    EXPECT_NE(with_plugin, own);
    std::ofstream(scratch / "plugin") << "b";
    EXPECT_NE(bench::store::program_identity({scratch / "plugin"}), with_plugin);
}

TEST(SuiteRun, ACellThatWasRunAndNotTimedIsTimedAlone) {
    const Scratch scratch;
    const Workshop w;
    const Planned plan(counting_suite, w.catalogue);
    bench::study::run(plan, scratch.path, false, 2, w.listener);
    EXPECT_TRUE(fs::remove(scratch.path / clock_file(plan.jobs[2])));
    makes = 0;
    const bench::study::Study resumed = bench::study::run(plan, scratch.path, true, 2, w.listener);
    EXPECT_EQ(resumed.ran, 0);
    EXPECT_EQ(resumed.timed, 1);
    EXPECT_EQ(makes, 2);
}

TEST(SuiteRun, WhatRefusesFailsOrPassesItsTimeLimitIsARowWithItsReason) {
    const Workshop w;
    const Planned plan(R"(
        [[cells]]
        scenes = ["free_string"]
        schemes = ["modal_two_point", "unwilling", "throwing", "slow"]
        rates = [44100]
        modes = 3
        reference_modes = "cell"
        duration = 1.0
        time_limit_s = 0.45
        measure = ["errors", "cost", "spectrogram"]
    )",
                       w.catalogue);
    const bench::store::Table t = all_of(plan, plan.run(2).records);
    const std::pair<const char*, const char*> expected[] = {
        {"ok", ""},
        {"refused", "it is not willing"},
        {"error", "out of luck"},
        {"past_time_limit", "past its time limit of 0.45 s"}};
    ASSERT_EQ(t.rows.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(t.text(i, "status"), expected[i].first);
        EXPECT_EQ(t.text(i, "reason"), expected[i].second);
        EXPECT_EQ(t.text(i, "cost_s_per_s").empty(), i > 0);
    }
}

TEST(SuiteRun, AReferenceThatPassesTheTimeLimitIsSaidInTheRow) {
    const Workshop w;
    const Planned plan(R"(
        [[cells]]
        scenes = ["free_string"]
        schemes = ["modal_two_point"]
        reference = "slow"
        rates = [44100]
        modes = 4  # of a scheme that is done long before, under sanitizers too
        duration = 1.0
        time_limit_s = 0.5
        measure = ["errors"]
    )",
                       w.catalogue);
    const bench::store::Table t = all_of(plan, plan.run(1).records);
    EXPECT_EQ(t.text(0, "status"), "ok");
    EXPECT_EQ(t.text(0, "error_l2_50ms"), "");
    EXPECT_EQ(t.text(0, "reason"), "reference oversampled slow: past its time limit of 0.5 s");
    for (const char* of_the_clock :
         {"cost_s_per_s", "cost_lower", "processor_s_per_s", "wall_seconds", "ns_per_step",
          "times_real_time", "worst_block_of_deadline", "repeats"})
        EXPECT_EQ(t.at(0, of_the_clock), "") << of_the_clock;  // it was not timed
}

TEST(SuiteCommand, ASceneWithoutTapsIsRefused) {
    const Scratch scratch;
    std::ofstream(scratch / "s.toml") << "name = \"s\"\nsource = \"none\"\nduration = "
                                         "0.01\n[[string]]\nlength = 1.0\nlinear_density = "
                                         "1e-3\ntension = 50.0\n[string.start]\nshape = "
                                         "\"mode\"\nnumber = 1\namplitude = 1e-3\n";
    std::ofstream(scratch / "a.toml") << "[[cells]]\nscenes = [\"" << scratch / "s.toml"
                                      << "\"]\nschemes = [\"modal_two_point\"]\nrates = [44100]\n";
    for (const std::string& command : {"compare " + (scratch / "s.toml") +
                                           " --schemes modal_two_point --rates 44100 --repeats 1",
                                       "suite " + (scratch / "a.toml")}) {
        EXPECT_TRUE(ends(jvari(scratch, command), 2, "scene s has no tap")) << command;
    }
}

TEST(SuiteCommand, KilledAtAnyMomentAndResumedItGivesTheSameTable) {
    const Scratch scratch;
    const std::string file = scratch / "a.toml", none = "JVARI_NODE_MODULES=/nowhere";
    std::ofstream(file) << suite_of("tanpura_c3", "modal_two_point,sitar_fdm",
                                    "44100, 88200, 176400",
                                    "modes = 20\nreference_modes = 'cell'\nduration = 0.05\n"
                                    "sweep = { 'string.0.tension' = [30, 31, 32, 33] }");
    const Ended whole =
        jvari(scratch, "suite " + file + " --jobs 1 --json --out " + scratch / "whole", none);
    ASSERT_EQ(whole.code, 0) << whole.err;
    const auto json = nlohmann::json::parse(whole.out);
    EXPECT_EQ(json.at("ran"), 24);
    EXPECT_EQ(json.at("cells").at(0).at("scene"), "tanpura_c3");
    const auto start_and_kill_with = [&](int cells) {  // as soon as there are so many
        const std::string kept = scratch / "killed/cells";
        std::system(
            ("env " + none + " " JVARI_PROGRAM " suite " + file + " --jobs 2 --resume --out " +
             scratch / "killed" + " >/dev/null 2>&1 & p=$!; while kill -0 $p && test $(ls " + kept +
             " | grep -c json$) -lt " + std::to_string(cells) +
             "; do sleep 0.003; done 2>/dev/null; kill -9 $p 2>/dev/null; wait $p 2>/dev/null")
                .c_str());
    };
    for (const int cells : {1, 3, 4, 7, 10, 12, 15, 19}) start_and_kill_with(cells);
    const Ended resumed =
        jvari(scratch, "suite " + file + " --resume --json --out " + scratch / "killed", none);
    ASSERT_EQ(resumed.code, 0) << resumed.err;
    EXPECT_GE(nlohmann::json::parse(resumed.out).at("read_back"), 19);
    EXPECT_EQ(content(scratch / "killed/errors.csv"), content(scratch / "whole/errors.csv"));
    EXPECT_TRUE(says(content(scratch / "killed/report.html"), "sitar_fdm cannot represent"));
    const Ended again =
        jvari(scratch, "suite " + file + " --resume --json --out " + scratch / "killed", none);
    EXPECT_EQ(nlohmann::json::parse(again.out).at("read_back"), 24);
}

TEST(SuiteCommand, ExitCodesAreThoseOfTheProgram) {
    const Scratch scratch;
    const std::string file = scratch / "a.toml";
    std::ofstream(file) << suite_of("tanpura_c3", "sitar_fdm", "44100",
                                    "measure = ['spectrogram']");
    EXPECT_EQ(jvari(scratch, "suite " + file).code, 3);
    EXPECT_EQ(jvari(scratch, "suite nowhere").code, 2);
    EXPECT_EQ(jvari(scratch, "suite " + file + " --resume").code, 2);
    EXPECT_EQ(jvari(scratch, "suite " + file + " --jobs 0").code, 2);
    EXPECT_TRUE(says(jvari(scratch, "list suites").out, "paper-deshmukh"));
}

// ---- The picture

TEST(Spectrograms, ASineStandsInItsRowWithItsPower) {
    std::vector<double> signal(44100);
    for (std::size_t n = 0; n < signal.size(); ++n)
        signal[n] = 0.01 * std::sin(2 * M_PI * 1012.0 * static_cast<double>(n) / 44100);
    const bench::study::Levels l = bench::study::levels_of(signal, 44100);
    ASSERT_EQ(l.rows, 100);
    EXPECT_NEAR(l.frames, 60, 1);
    for (int m = 0; m < l.frames; ++m) {
        const int* frame = l.level.data() + static_cast<std::ptrdiff_t>(m) * l.rows;
        EXPECT_EQ(std::max_element(frame, frame + l.rows) - frame, 12);  // 960-1040 Hz
        // 1e-4/2 is -43.0 dB; the strongest bin of a Hann window holds 2/3 of it (-1.8 dB) on a
        // bin, down to 1.4 dB less between two
        EXPECT_NEAR(frame[12], -448 - 7, 8);
        EXPECT_LT(frame[50], frame[12] - 800);
    }
}

}  // namespace
}  // namespace jvari::test
