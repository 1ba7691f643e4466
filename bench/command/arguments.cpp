// What the program understands, and the help that teaches it.
#include "bench/command/arguments.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <sstream>

#include <set>
#include "bench/command/console.hpp"
#include "bench/store/keys.hpp"
#include "bench/store/machine.hpp"
#include "bench/store/records.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::command {

namespace {
constexpr const char* about = "jvari: numerical schemes for strings against obstacles, compared by speed and accuracy on the same scenes.";
constexpr const char* examples =
    "Examples\n"
    "  jvari new guitar my_guitar                              a commented scene to begin with\n"
    "  jvari list                                              what there is, and which scheme represents which scene\n"
    "  jvari run tanpura_c3 --scheme modal_two_point --out c3.wav\n"
    "  jvari run tanpura_c3 --scheme modal_two_point --rate 176400 --energy --set string.0.tension=40 --out c3.csv\n"
    "  jvari compare tanpura_c3_release --out report           every scheme that represents it, at 44.1 kHz x 1 ... 64\n"
    "  jvari suite paper-deshmukh --out sitar --resume         a declared set of cells, taken up where it was stopped\n"
    "  jvari trim tanpura_c3_release --within 1% --out trimmed  no more than the scene needs: the cheapest model within 1 %\n"
    "  jvari certify tanpura_c3_release --duration 0.1         how far the references agree there\n"
    "  jvari report report                                     its page and picture once more\n"
    "  jvari diff results/smoke report                         what got worse, what got better\n"
    "  jvari check --plugin libmine.so                         does a scheme of one's own keep the contract\n"
    "\n"
    "Exit codes: 0 done; 2 bad usage or bad scene; 3 the scheme refuses the scene; 4 the run failed, or "
    "its result could not be written (what was written stays valid).\n"
    "Ctrl-C leaves whole files only; compare and suite say how many cells are kept.";

std::string a_number(const std::string& text, bool whole) {
    double x = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), x);
    if (error == std::errc() && stop == text.data() + text.size() && std::isfinite(x) && x > 0 &&
        (!whole || (x == std::floor(x) && x <= store::most_counted)))
        return {};
    return fmt::format("found \"{}\", expected a {}", text,
                       whole ? fmt::format("whole number from 1 to {}", store::most_counted) : "number > 0");
}
const CLI::Validator positive([](const std::string& text) { return a_number(text, false); }, "", "positive");
// A quantity may have its unit behind it, "44.1k" or "10ms": the text becomes the number in SI units.
CLI::Validator in_units(std::vector<std::pair<std::string, double>> units) {
    return CLI::Validator(
        [units = std::move(units)](std::string& text) {
            for (const auto& [unit, scale] : units) {
                if (!text.ends_with(unit)) continue;
                const std::string number = text.substr(0, text.size() - unit.size());
                if (a_number(number, false).empty()) text = fmt::format("{:.15g}", scale * store::number_of(number));
                break;
            }
            return a_number(text, false);
        },
        "", "quantity");
}
const CLI::Validator hertz = in_units({{"kHz", 1e3}, {"Hz", 1}, {"k", 1e3}}), seconds = in_units({{"ms", 1e-3}, {"us", 1e-6}, {"s", 1}});
const CLI::Validator counting([](const std::string& text) { return a_number(text, true); }, "", "counting");

void add_common(CLI::App& verb, Common& c) {
    verb.add_flag("--json", c.json, "one JSON object on standard output, nothing else there");
    verb.add_option("--plugin", c.plugins, "shared object with further schemes (repeatable)")->type_name("LIB.so")->allow_extra_args(false);
    verb.add_flag("--quiet", c.quiet, "errors only: no messages, no progress, no result as text (`list` still lists)");
}

void add_scene(CLI::App& verb, std::string& scene, std::vector<std::string>& set) {
    verb.add_option("scene", scene, "a scene file, or a name that `jvari list scenes` shows")->required()->type_name("SCENE");
    verb.add_option("--set", set, "overrides a key of the scene, as string.0.barrier.0.stiffness=1e9 (repeatable)")
        ->type_name("KEY.PATH=VALUE")
        ->allow_extra_args(false);
}

void add_modes(CLI::App& verb, int& modes) {
    verb.add_option("--modes", modes,
                    "modes of each string, or interior nodes for a scheme on a grid; absent: every mode below min(20 kHz, rate/2)")
        ->type_name("N")
        ->check(counting);
}

void add_options(CLI::App& verb, std::vector<std::string>& options) {
    verb.add_option(
            "--option", options,
            "an option of a scheme, as NAME=VALUE or SCHEME:NAME=VALUE (repeatable). In compare the short form goes to every compared "
            "scheme that knows the name, never to the reference; several values, as compliance=own,matched, are run one by one")
        ->type_name("[SCHEME:]NAME=VALUE")
        ->allow_extra_args(false);
}

void add_jobs(CLI::App& verb, int& jobs) {
    verb.add_option("--jobs", jobs, "accuracy runs side by side; as many as there are cores where absent. Timed runs go one at a time")
        ->type_name("N")
        ->check(counting);
}

std::vector<compare::SchemeOption> scheme_options(const std::vector<std::string>& texts) {
    std::vector<compare::SchemeOption> options;
    for (const std::string& text : texts) {
        const auto equals = text.find('=');
        if (equals == std::string::npos || equals == 0) throw store::UsageError("--option " + text + ": expected [SCHEME:]NAME=VALUE");
        const std::string key = text.substr(0, equals);
        const auto colon = key.find(':');
        compare::SchemeOption o{colon == std::string::npos ? "" : key.substr(0, colon),
                                colon == std::string::npos ? key : key.substr(colon + 1), text.substr(equals + 1)};
        if (o.name.empty() || colon == 0) throw store::UsageError("--option " + text + ": expected [SCHEME:]NAME=VALUE");
        options.push_back(std::move(o));
    }
    return options;
}

std::optional<int> modes_of_reference(const std::string& text) {
    if (text == "cell") return std::nullopt;
    if (text == "0") return 0;
    if (!a_number(text, true).empty())
        throw store::UsageError(
            fmt::format("--reference-modes: found \"{}\", expected a whole number from 0 to {}, or cell", text, store::most_counted));
    return std::stoi(text);
}

// Each value of a list for itself; an option is named once.
std::vector<compare::SchemeOption> one_by_one(const std::vector<compare::SchemeOption>& lists) {
    std::vector<compare::SchemeOption> options;
    for (std::size_t k = 0; k < lists.size(); ++k) {
        const compare::SchemeOption& list = lists[k];
        for (std::size_t j = 0; j < k; ++j)
            if (lists[j].scheme == list.scheme && lists[j].name == list.name)
                throw store::UsageError(fmt::format("--option {}: found more than once; several values stand in one list, {}={},{}",
                                                    list.name, list.name, lists[j].value, list.value));
        std::istringstream values(list.value);
        for (std::string value; std::getline(values, value, ',');) options.push_back({list.scheme, list.name, value});
        if (list.value.empty()) options.push_back(list);
    }
    return options;
}

void must_be_assignments(const std::vector<std::string>& set) {
    for (const std::string& s : set)
        if (s.find('=') == std::string::npos || s.front() == '=') throw store::UsageError("--set " + s + ": expected KEY.PATH=VALUE");
}
}  // namespace

const char* welcome() {
    return "jvari compares numerical schemes for a string that vibrates against an obstacle.\n"
           "\n"
           "  jvari new guitar my_guitar            write a commented scene, my_guitar.toml; also tanpura, sitar, bass, piano\n"
           "  jvari run my_guitar.toml --scheme modal_two_point --out my_guitar.wav        hear it\n"
           "  jvari compare my_guitar.toml --out report      which scheme, at which rate, and how wrong is it?\n"
           "  jvari list                            the schemes, references and scenes that there are\n"
           "\n"
           "`jvari --help` lists every verb, `jvari help compare` teaches one.";
}

std::optional<Request> read_arguments(int argc, const char* const* argv) {
    CLI::App app(about, "jvari");
    app.footer(examples);
    app.require_subcommand(1);
    app.set_version_flag("--version", fmt::format("jvari {} ({})", store::machine().version, store::machine().commit));
    app.get_formatter()->column_width(34);

    NewRequest fresh;
    auto* new_verb = app.add_subcommand("new", "a commented scene to begin with: writes NAME.toml here");
    new_verb->add_option("instrument", fresh.instrument, "guitar, tanpura, sitar, bass or piano; or body: a made-up pair of responses")
        ->required()
        ->type_name("INSTRUMENT");
    new_verb->add_option("name", fresh.name, "of the scene and, with .toml, of its file")->required()->type_name("NAME");
    new_verb->footer("Example: jvari new guitar my_guitar");
    add_common(*new_verb, fresh);

    ListRequest list;
    auto* list_verb = app.add_subcommand("list", "what exists, and which scheme represents which scene");
    list_verb
        ->add_option("what", list.what,
                     "schemes, scenes, references, options, facts, taps, suites, keys (of suite files) or columns (of cells.csv); absent: "
                     "all, and the matrix")
        ->check(CLI::IsMember({"schemes", "scenes", "references", "options", "facts", "taps", "suites", "keys", "columns"}))
        ->type_name("WHAT")
        ->option_text("");
    list_verb->add_flag("--markdown", list.markdown,
                        "with `schemes`: the capability table of the README; with `options`, `facts`, `keys` or `columns`: their table");
    list_verb->footer("Example: jvari list schemes --markdown");
    add_common(*list_verb, list);

    RunRequest run;
    std::vector<std::string> run_options;
    auto* run_verb = app.add_subcommand("run", "one scheme on one scene");
    add_scene(*run_verb, run.scene, run.set);
    add_modes(*run_verb, run.modes);
    add_options(*run_verb, run_options);
    run_verb->add_option("--scheme", run.scheme, "a scheme or a reference")->required()->type_name("NAME");
    run_verb->add_option("--rate", run.rate, "sample rate; 44100 where absent")->type_name("HZ")->transform(hertz);
    run_verb->add_option("--duration", run.duration, "in place of the scene's")->type_name("S")->transform(seconds);
    run_verb->add_option("--tap-rate", run.tap_rate, "rows per second; 44100 where absent, or the rate where that is no multiple of it")
        ->type_name("HZ")
        ->transform(hertz);
    run_verb->add_flag("--energy", run.energy, "probe the energy: three more columns, and the residuals of the balance");
    run_verb->add_option("--out", run.out, "writes the trace: .csv or .h5; .wav or .flac: what is heard of it")->type_name("FILE");
    run_verb
        ->add_option("--plot", run.plot,
                     "draws the run, .svg or .html: taps, spectrum, spectrogram, energy ledger, contact times (turns --energy on)")
        ->type_name("FILE");
    run_verb->add_flag("--mono", run.mono, "one channel where a body gives two");
    run_verb->add_option("--wav-format", run.wav_format, "of a .wav or .flac: pcm24 (default) or pcm16")
        ->check(CLI::IsMember({"pcm24", "pcm16"}))
        ->type_name("FORMAT")
        ->option_text("FORMAT");
    run_verb->footer("Example: jvari run tanpura_c3 --scheme modal_two_point --rate 176400 --duration 0.2 --energy --out c3.csv");
    add_common(*run_verb, run);

    CompareCall compare;
    std::vector<std::string> compare_options;
    std::string reference_modes = "0";
    auto* compare_verb = app.add_subcommand("compare", "schemes at several rates against a reference: error and cost of each");
    add_scene(*compare_verb, compare.scene, compare.set);
    compare_verb
        ->add_option("--modes", compare.modes,
                     "modes of each string; absent: those below 20 kHz, and 1.35, 2, 3 and 4 times as many where they lie below rate/2")
        ->delimiter(',')
        ->type_name("N,...")
        ->check(counting);
    add_options(*compare_verb, compare_options);
    compare_verb->add_option("--schemes", compare.schemes, "absent: every scheme that represents the scene, but for controls")
        ->delimiter(',')
        ->type_name("A,B,...");
    compare_verb->add_flag("--controls", compare.controls,
                           "controls, known to be wrong somewhere, can be the cheapest; with no --schemes they run as well");
    compare_verb->add_option("--rates", compare.rates, "absent: 44100 x 1, 2, 4, 8, 16, 32, 64")
        ->delimiter(',')
        ->type_name("HZ,...")
        ->transform(hertz);
    compare_verb
        ->add_option("--reference", compare.reference, "a reference or a scheme; absent: the highest reference that represents the scene")
        ->type_name("NAME");
    compare_verb
        ->add_option(
            "--reference-modes", reference_modes,
            "modes of the reference; 0, or absent: doubled until nothing moves, and the points of a profile with them; cell: those "
            "of the schemes")
        ->type_name("N|cell");
    compare_verb->add_option("--duration", compare.duration, "in place of the scene's")->type_name("S")->transform(seconds);
    compare_verb
        ->add_option("--tap-rate", compare.tap_rate,
                     "rows per second that are compared; 44100 where all rates are multiples of it, else the lowest rate")
        ->type_name("HZ")
        ->transform(hertz);
    compare_verb->add_option("--repeats", compare.repeats, "timed runs of each cell; a slow cell gets fewer, two at least; 5 where absent")
        ->type_name("N")
        ->check(counting);
    add_jobs(*compare_verb, compare.jobs);
    compare_verb->add_flag("--resume", compare.resume,
                           "reads back the errors of the cells that DIR holds and runs the others; all are timed again");
    compare_verb
        ->add_option("--out", compare.out, "folder for cells.csv, errors.csv, cost.csv, manifest.json, work_precision.svg, report.html")
        ->type_name("DIR");
    compare_verb->footer(
        "Example: jvari compare tanpura_c3_release --schemes modal_two_point --rates 44100,176400 --duration 0.1 --out report");
    add_common(*compare_verb, compare);

    SuiteRequest suite;
    auto* suite_verb =
        app.add_subcommand("suite", "a declared set of comparisons, sweeps, stability maps and figures over scenes and schemes");
    suite_verb->add_option("suite", suite.suite, "a suite file, or a name that `jvari list suites` shows")->required()->type_name("FILE");
    suite_verb
        ->add_option("--out", suite.out,
                     "folder for cells/, a table of each kind that the suite measures, manifest.json, report.html and its pictures")
        ->type_name("DIR");
    suite_verb->add_flag("--resume", suite.resume,
                         "reads back the cells that DIR holds and runs the others; any number of processes may do so at once in one DIR");
    suite_verb
        ->add_option("--print", suite.print, "runs nothing: writes the script of a Slurm array, whose tasks share DIR, to standard output")
        ->check(CLI::IsMember({"slurm"}))
        ->type_name("slurm")
        ->option_text("slurm");
    add_jobs(*suite_verb, suite.jobs);
    suite_verb->footer(
        "Examples: jvari suite paper-deshmukh --out sitar --resume\n"
        "          jvari suite stability --out maps --print slurm > job.sh && sbatch job.sh");
    add_common(*suite_verb, suite);

    TrimCall trim;
    auto* trim_verb = app.add_subcommand("trim", "the cheapest model of a scene within a tolerance: no more than it needs");
    trim_verb->add_option("scene", trim.scene, "a scene file, or a name that `jvari list scenes` shows")->required()->type_name("SCENE");
    trim_verb->add_option("--within", trim.within, "the tolerance: 1%, or 1dB where the measure is in dB")->required()->type_name("ERROR");
    trim_verb->add_option("--of", trim.measure, "l2_50ms (absent), third_octave_db, stft, centroid or decay")
        ->type_name("MEASURE")
        ->option_text("MEASURE");
    trim_verb->add_option("--tap", trim.tap, "what is listened to; absent: the first nut force, else the first tap")->type_name("NAME");
    trim_verb->add_option("--scheme", trim.scheme, "a scheme; any: all that represent the scene or what is left of it")
        ->type_name("NAME|any")
        ->option_text("NAME|any");
    trim_verb->add_option("--set", trim.set, "overrides a key of the scene (repeatable)")
        ->type_name("KEY.PATH=VALUE")
        ->allow_extra_args(false);
    trim_verb->add_option("--duration", trim.duration, "how much of the scene is run and judged; 0.05 where absent")
        ->type_name("S")
        ->transform(seconds)
        ->option_text("S");
    trim_verb
        ->add_option("--tap-rate", trim.tap_rate,
                     "rows per second that are compared, and the lowest rate that is tried; 44100 where absent")
        ->type_name("HZ")
        ->transform(hertz)
        ->option_text("HZ");
    trim_verb->add_option("--reference", trim.reference, "a reference or a scheme; absent: the highest reference that represents the scene")
        ->type_name("NAME");
    trim_verb
        ->add_option("--reference-modes", trim.reference_modes,
                     "modes of the reference; absent: doubled until nothing moves, as far as twenty seconds reach")
        ->type_name("N")
        ->check(CLI::NonNegativeNumber)
        ->option_text("N");
    add_jobs(*trim_verb, trim.jobs);
    trim_verb
        ->add_option("--out", trim.out,
                     "folder for trimmed.toml, needs.csv, path.csv, trim.svg, report.html; what was judged is kept in its cells/")
        ->type_name("DIR");
    trim_verb->footer("Example: jvari trim tanpura_c3_release --within 1% --out trimmed");
    add_common(*trim_verb, trim);

    CertifyRequest certify;
    auto* certify_verb = app.add_subcommand("certify", "how far the references agree on a scene: what an error can be believed to");
    add_scene(*certify_verb, certify.scene, certify.set);
    add_modes(*certify_verb, certify.modes);
    certify_verb->add_option("--duration", certify.duration, "in place of the scene's; compare uses a certificate as far as it reaches")
        ->type_name("S")
        ->transform(seconds);
    certify_verb->add_option("--tap-rate", certify.tap_rate, "rows per second that are compared; 44100 where absent")
        ->type_name("HZ")
        ->transform(hertz);
    certify_verb
        ->add_option("--oversampled-rate", certify.oversampled_rate,
                     "also the best scheme at a quarter, half and all of this rate, with its own estimate; absent: only where no reference "
                     "represents the scene, at 64 tap rates")
        ->type_name("HZ")
        ->check(positive);
    certify_verb
        ->add_option(
            "--out", certify.out,
            "the file, .json; results/certificates/<scene>.json where absent, with part of the scene's hash in its name where --set "
            "changes the scene. What a clock measured goes beside it, to .cost.json")
        ->type_name("FILE");
    certify_verb
        ->add_option("--reference", certify.reference,
                     "this one alone, at its two accuracies: a whole second of one that is fast. Its file has its name in it")
        ->type_name("NAME");
    certify_verb->add_flag("--again", certify.again, "runs the references also where the file is there and of the same scene and settings");
    certify_verb->footer(
        "Example: jvari certify tanpura_c3_release --duration 0.1\n"
        "\n"
        "Every reference that represents the scene runs at two settings of its accuracy. The table says, pair by pair, how far they are "
        "apart and\n"
        "for how long they agree. compare and suite print these figures with their errors: an error below them is shown as \"\u2264\" the "
        "figure.");
    add_common(*certify_verb, certify);

    ReportRequest report;
    auto* report_verb = app.add_subcommand("report", "page and pictures, made again from a folder that compare or suite wrote");
    report_verb->add_option("folder", report.folder, "holds manifest.json and cells.csv, maps.csv or both")->required()->type_name("DIR");
    report_verb->footer("Example: jvari report report");
    add_common(*report_verb, report);

    DiffRequest diff;
    auto* diff_verb = app.add_subcommand("diff", "two folders of results: what got worse, what got better, what only one has");
    auto* before = diff_verb->add_option("before", diff.before, "a folder that compare or suite wrote")->type_name("A");
    auto* after = diff_verb->add_option("after", diff.after, "another, of the same scene or suite")->type_name("B");
    diff_verb->add_option("--history", diff.history, "one folder in place of two: each commit that changed it against the one before")
        ->type_name("DIR")
        ->excludes(before);
    before->needs(after);
    diff_verb->footer(
        "Example: jvari diff results/smoke report\n"
        "\n"
        "Exit code 4 where something got worse: an error by more than noise and certificates, a certificate, a status, an outcome of a "
        "map,\n"
        "or the cost of a scheme beyond its quartiles and the drift of all; and where a cell of A is missing in B. Costs of two machines\n"
        "are not compared.");
    add_common(*diff_verb, diff);

    CheckRequest check;
    auto* check_verb =
        app.add_subcommand("check", "does a scheme keep what every scheme promises: the contract, and what it claims in numbers");
    check_verb->add_option("schemes", check.schemes, "schemes or references; absent: those of the plugins")->type_name("SCHEME");
    check_verb->add_option("--junit", check.junit, "also writes JUnit XML, as continuous integration reads it")->type_name("FILE");
    check_verb->footer(
        "Example: jvari check --plugin build/libmy_scheme.so --junit check.xml\n"
        "\n"
        "Exit code 4 where a promise is broken.");
    add_common(*check_verb, check);

    std::vector<const char*> words(argv, argv + argc);
    if (argc > 1 && std::string(argv[1]) == "help") {  // `jvari help run` asks what `jvari run --help` asks
        words.erase(words.begin() + 1);
        words.resize(std::min<std::size_t>(words.size(), 2));
        words.push_back("--help");
        argc = static_cast<int>(words.size());
        argv = words.data();
    }
    if (argc > 1 && argv[1][0] != '-') {
        std::vector<std::string> verbs;
        for (const auto* verb : app.get_subcommands([](const CLI::App*) { return true; })) verbs.push_back(verb->get_name());
        if (std::find(verbs.begin(), verbs.end(), argv[1]) == verbs.end()) throw store::UsageError(store::unknown("verb", argv[1], verbs));
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& asked) {
        std::ostringstream text, nothing;
        app.exit(asked, text, nothing);
        Console(false, false).print(text.str().substr(0, text.str().find_last_not_of('\n') + 1));
        return std::nullopt;
    } catch (const CLI::ParseError& e) {
        throw store::UsageError(std::string(e.what()) + " (see jvari " + (argc > 1 && argv[1][0] != '-' ? argv[1] + std::string(" ") : "") +
                                "--help)");
    }
    must_be_assignments(run.set);
    must_be_assignments(compare.set);
    must_be_assignments(certify.set);
    must_be_assignments(trim.set);
    run.options = scheme_options(run_options);
    compare.options = one_by_one(scheme_options(compare_options));
    compare.reference_modes = modes_of_reference(reference_modes);
    static const std::set<std::string> in_markdown{"schemes", "options", "facts", "keys", "columns"};
    if (list.markdown && !in_markdown.contains(list.what))
        throw store::UsageError("--markdown goes with `jvari list schemes`, and with options, facts, keys or columns in place of schemes");

    if (new_verb->parsed()) return fresh;
    if (list_verb->parsed()) return list;
    if (run_verb->parsed()) return run;
    if (compare_verb->parsed()) return compare;
    if (suite_verb->parsed()) return suite;
    if (certify_verb->parsed()) return certify;
    if (check_verb->parsed()) return check;
    if (diff_verb->parsed()) {
        if (diff.history.empty() && diff.after.empty())
            throw store::UsageError("diff: expected two folders, or --history DIR (see jvari diff --help)");
        return diff;
    }
    if (trim_verb->parsed()) return trim;
    return report;
}

}  // namespace jvari::bench::command
