// Verbs for a scheme of one's own: export and judge for an external program, and check.
#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <optional>

#include "bench/check/promise.hpp"
#include "bench/command/console.hpp"
#include "bench/command/verbs.hpp"
#include "bench/compare/catalogue.hpp"
#include "bench/judge/judge.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/json.hpp"
#include "bench/store/usage.hpp"
#include "schemes/registry.hpp"

namespace jvari::bench::command {

// ---- jvari export: writes the problem for a scheme of one's own as arrays.

namespace {
struct ExportRequest : Common, compare::CompareRequest {
    double rate = 44100;  // [Hz]
    int modes_of_each = 0;
    bool without_reference = false;
};

int export_command(ExportRequest r) {
    const Console console(r.json, r.quiet);
    r.rates = {r.rate};
    if (r.modes_of_each > 0) r.modes = {r.modes_of_each};
    store::must_not_replace({{"--out", r.out}}, files_read(compare::load_scene(r), r.scene, {}));
    store::must_be_writable(r.out);
    const judge::Exported problem = judge::exported(r);
    std::optional<study::Truth> truth;
    if (!r.without_reference)
        truth = judge::reference_of(r, problem, compare::Catalogue(), console);
    store::write_fresh(r.out, judge::problem_json(problem, truth ? &*truth : nullptr));
    console.print(fmt::format(
        "{} at {:.12g} Hz, {:.12g} rows a second{}", problem.scene.name, r.rate,
        problem.settings.tap_rate,
        truth ? "; reference: " + truth->reference.choice.name() + ", " + truth->description : ""));
    console.print("written: " + r.out);
    console.print_json(
        store::indented({{"scene", problem.scene.name}, {"status", "ok"}, {"files", {r.out}}}));
    return exit_code::done;
}
}  // namespace

Act export_verb(CLI::App& program) {
    Verb<ExportRequest> v(
        program, "export",
        "the problem as arrays, for a scheme of one's own, and the reference trace");
    v.scene(v.r.scene);
    v.set(v.r.set);
    v.modes(v.r.modes_of_each);
    v.option("--rate", v.r.rate, hertz, "steps per second of the scheme; 44100 where absent");
    v.option(compare::fields::tap_rate, v.r.tap_rate, hertz);
    v.option(compare::fields::duration, v.r.duration, seconds);
    v.option("--tap", v.r.tap, {"NAME"}, "of the scene's taps this one alone");
    v.flag("--without-reference", v.r.without_reference, "the problem alone: no reference is run");
    v.option("--out", v.r.out, {"FILE"}, "the file, JSON")->required();
    return v.does(export_command,
                  "Example: jvari export tanpura_c3_release --duration 0.05 --out problem.json\n"
                  "\n"
                  "The file holds frequencies, decay rates, weights of contact, thread, pluck and "
                  "taps, and the reference trace with its\n"
                  "uncertainty: what a script of a modal scheme or a grid begins with. "
                  "docs/own-scheme/README.md has the unit, the shape and the\n"
                  "equation of each field, and schemes in Python, Octave, Julia and C to copy. "
                  "`jvari judge` says how wrong their traces are.");
}

// ---- jvari judge: measures the error in a trace made by any program.

namespace {
struct JudgeRequest : Running, compare::CompareRequest {
    std::string name = "mine";
    std::vector<std::string> files;  // HZ=FILE
    std::vector<double> costs;
    int modes_of_each = 0;
};

struct NamedFile {
    double rate;
    std::string path;
};
NamedFile named_file(const std::string& text) {
    const auto equals = text.find('=');
    std::string rate = text.substr(0, equals);
    if (equals == std::string::npos || !hertz.check(rate).empty() || equals + 1 == text.size())
        throw store::UsageError(
            "--trace " + text +
            ": expected HZ=FILE, the sample rate of the scheme and the file that it wrote");
    return {store::number_of(rate), text.substr(equals + 1)};
}

judge::Candidate candidate_of(JudgeRequest& r) {
    judge::Candidate c;
    c.name = r.name;
    std::vector<NamedFile> files;
    for (const std::string& text : r.files) files.push_back(named_file(text));
    for (const NamedFile& f : files) r.rates.push_back(f.rate);
    if (!r.costs.empty() && r.costs.size() != files.size())
        throw store::UsageError(
            fmt::format("--cost: found {} costs for {} traces, expected one each", r.costs.size(),
                        files.size()));
    const Scene scene = compare::load_scene(r);
    compare::tap_named(scene, "");
    const judge::Rows rows = judge::rows_for(r, scene);
    for (std::size_t k = 0; k < files.size(); ++k) {
        const NamedFile& f = files[k];
        auto trace =
            std::make_shared<const Trace>(judge::read_trace(f.path, scene, rows.rate, rows.count));
        judge::must_be_whole(*trace, f.path, rows.count);
        if (!c.traces.emplace(f.rate, std::move(trace)).second)
            throw store::UsageError(
                fmt::format("--trace: found more than one at {:.12g} Hz", f.rate));
        if (!r.costs.empty()) c.costs[f.rate] = r.costs[k];
        c.contents += fmt::format("{}={}\n", f.rate, store::read_whole(f.path));
    }
    return c;
}

int judge_command(JudgeRequest r) {
    const Console console(r.json, r.quiet);
    if (r.modes_of_each > 0) r.modes = {r.modes_of_each};
    judge::Candidate candidate = candidate_of(r);
    const report::OwnFolder folder(r.out, "comparison of " + compare::load_scene(r).name,
                                   compare::identity_of(r) + candidate.contents, console);
    study::Kept keep{folder.cells, true};
    const compare::Comparison c = judge::judge(std::move(candidate), r, r.plugins, console, keep);
    const report::Written results = report::written(c, r, console);
    const std::string verdict = judge::verdict_of(c);
    std::vector<study::Record> own;
    std::ranges::copy_if(c.outcome.records, std::back_inserter(own),
                         [](const study::Record& one) { return judge::is_candidate(one.cell); });
    const int code = code_of(own);
    console.print(headline_lines(results.cells, Console::width()));
    console.print(verdict);
    if (!r.out.empty()) console.print("written: " + r.out);
    console.print_json(with_results({{"scene", c.scene().name},
                                     {"reference", c.reference.name()},
                                     {"status", exit_code::status(code)},
                                     {"verdict", verdict}},
                                    results));
    return code;
}
}  // namespace

Act judge_verb(CLI::App& program) {
    Verb<JudgeRequest> v(program, "judge", "how wrong is a trace that another program made?");
    v.scene(v.r.scene);
    v.set(v.r.set);
    v.option("--trace", v.r.files, {"HZ=FILE"},
             "the sample rate of the scheme, and what it wrote (repeatable, a file a rate): .csv "
             "with time_s and a column for each tap by its name, or .wav of one tap")
        ->required()
        ->allow_extra_args(false);
    v.option("--name", v.r.name, {"NAME"}, "what tables and pictures call it; mine where absent");
    v.option("--cost", v.r.costs, {"S,...", positive.check},
             "its computing time per second of sound, one for each trace; shown as reported")
        ->delimiter(',');
    v.option("--schemes", v.r.schemes, {"A,B,..."},
             "run and timed beside it, at its rates: it is said how far the traces differ; "
             "absent: none")
        ->delimiter(',');
    v.option("--tap", v.r.tap, {"NAME"}, "judged alone; absent: all taps of the scene");
    v.modes(v.r.modes_of_each);
    v.option(compare::fields::duration, v.r.duration, seconds);
    v.option(compare::fields::tap_rate, v.r.tap_rate, hertz);
    v.jobs(v.r.jobs);
    v.comparison_folder(v.r.out);
    return v.does(judge_command,
                  "Example: jvari judge tanpura_c3_release --duration 0.05 --trace 44100=trace.csv "
                  "--out report\n"
                  "\n"
                  "Row n of a trace is at n/44100 s, from the start on; contact forces are means "
                  "over the interval that ends at the row.\n"
                  "A file that is no trace of the scene is refused with exit code 2, and nothing "
                  "is written: other row times, a missing tap, other than\n"
                  "all rows. NaN is a failure at that rate, and the other rates are judged. "
                  "`jvari export` writes the problem.");
}

// ---- jvari check: tests whether a scheme, built in or from a plugin, keeps the promises every
// scheme makes.

namespace {
struct CheckRequest : Running {
    std::vector<std::string> schemes;  // none: the plugins' schemes
    check::Asked selection;
    std::string junit;
};

std::string promise_lines() {
    std::string text;
    for (const check::Promise& p : check::promises())
        text += fmt::format("\n  {:<48}  {}", p.name, p.sentence);
    return text;
}

int check_command(const CheckRequest& r) {
    const Console console(r.json, r.quiet);
    const compare::Catalogue catalogue(r.plugins);
    std::vector<Descriptor> chosen;
    for (const std::string& name : r.schemes) chosen.push_back(catalogue.find(name));
    if (chosen.empty())
        for (const Guest* g : guests())
            for (const Descriptor& d : g->schemes) chosen.push_back(catalogue.find(d.name));
    if (chosen.empty())
        throw store::UsageError(
            "check: expected a scheme, or --plugin LIB.so (see jvari check --help)");
    std::vector<store::NamedFile> read;
    for (const std::string& file : r.plugins) read.push_back({"a plugin", file});
    store::must_not_replace({{"--junit", r.junit}}, read);
    if (!r.junit.empty()) store::must_be_writable(r.junit);
    check::must_exist(r.selection);
    std::vector<check::Checked> checked;
    bool broken = false;
    for (const Descriptor& one : chosen) {
        const Descriptor d = judge::declared(one);
        console.print(fmt::format("{}{} ({})", checked.empty() ? "" : "\n", d.name, d.source));
        checked.push_back(check::check(d, r.selection, console,
                                       [&](const check::Checked& c, const check::Promise& p) {
                                           console.print(check::line_of(c, p));
                                       }));
        console.print(check::conclusion_of(checked.back()));
        broken = broken || checked.back().broken();
    }
    if (!r.junit.empty()) store::write_fresh(r.junit, check::junit_of(checked));
    console.print_json(check::json_of(checked));
    return broken ? exit_code::run_failed : exit_code::done;
}
}  // namespace

Act check_verb(CLI::App& program) {
    Verb<CheckRequest> v(program, "check",
                         "does a scheme keep what every scheme promises: the contract, and what it "
                         "claims in numbers");
    v.option("schemes", v.r.schemes, {"SCHEME"},
             "schemes or references; absent: those of the plugins");
    v.option("--only", v.r.selection.promises, {"PROMISE,..."}, "these promises alone")
        ->delimiter(',')
        ->allow_extra_args(false);
    v.option("--scene", v.r.selection.scenes, {"NAME,..."},
             "what is promised on scenes, on these alone; without what is examined once")
        ->delimiter(',')
        ->allow_extra_args(false);
    v.option("--junit", v.r.junit, {"FILE"},
             "also writes JUnit XML, as continuous integration reads it");
    return v.does(check_command,
                  "Example: jvari check --plugin build/libmy_scheme.so --junit check.xml\n"
                  "\n"
                  "Exit code 4 where a promise is broken. The last line counts: 19 kept, 2 not "
                  "asked, and why.\n"
                  "A program (--external) is called with the one word `represents`. It may print "
                  "`represents: damping, thread` and\n"
                  "`balance: exact`; else it is asked for everything, and refuses by exit code 3.\n"
                  "docs/ci.md has a recipe for continuous integration.\n"
                  "\n"
                  "Promises" +
                      promise_lines());
}

}  // namespace jvari::bench::command
