// jvari compare: the main command. Results go to a folder and a page first and to the terminal
// last, so that nothing is lost if nobody reads the terminal.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <sstream>

#include "bench/command/console.hpp"
#include "bench/command/verbs.hpp"
#include "bench/compare/bound.hpp"
#include "bench/compare/record/cheapest.hpp"
#include "bench/compare/record/findings.hpp"
#include "bench/compare/scene_notes.hpp"
#include "bench/judge/judge.hpp"
#include "bench/store/system/interruption.hpp"
#include "scenes/excitation.hpp"
#include "schemes/contact/compliance.hpp"

namespace jvari::bench::command {

namespace {
namespace fs = std::filesystem;

struct CompareCall : Running, compare::CompareRequest {
    bool resume = false;
    std::vector<std::string> option_lists, costs;  // costs: NAME=S,...
    std::string modes_of_reference = "0";
};

// Costs by scheme, from --cost.
std::map<std::string, judge::Costs> costs_of(const CompareCall& r, const compare::Catalogue& all) {
    std::map<std::string, judge::Costs> costs;
    for (const compare::SchemeOption& o : scheme_options(r.costs)) {
        const std::string what = fmt::format("--cost {}={}", o.name, o.value);
        judge::must_be_untimed(all.find(o.name));
        if (r.modes.size() > 1) throw store::UsageError(what + ": found more than one of --modes");
        std::istringstream values(o.value);
        std::size_t count = 0;
        for (std::string text; std::getline(values, text, ','); ++count) {
            if (const std::string wrong = positive.check(text); !wrong.empty())
                throw store::UsageError(what + ": " + wrong);
            if (count < r.rates.size()) costs[o.name][r.rates[count]] = store::number_of(text);
        }
        if (count != r.rates.size())
            throw store::UsageError(
                fmt::format("{}: found {} costs for {} --rates, expected one each", what, count,
                            r.rates.size()));
    }
    return costs;
}

bool names_compliance(const compare::SchemeOption& o) { return o.name == compliance_option.name; }

std::string kept_text(const study::Kept& keep) {
    if (keep.folder.empty()) return "interrupted: nothing is kept, for there is no --out DIR";
    if (keep.of == 0)
        return "interrupted: no cell has its errors yet; long runs of references are kept";
    return fmt::format(
        "interrupted: the errors of {} of {} cells are kept in {}; --resume goes on from there",
        keep.kept.load(), keep.of.load(), keep.folder.parent_path().string());
}

std::string floor_text(const compare::Comparison& c) {
    std::string text;
    for (std::size_t k = 0; k < study::measures().size(); ++k) {
        const study::Measure& m = study::measures()[k];
        const double floor = c.against.floor[c.headline.tap(m)][k];
        if (m.less_is_better && !std::isnan(floor))
            text +=
                fmt::format("{}{} {:.1e}", text.empty() ? "noise floor: " : ", ", m.column, floor);
    }
    return text;
}

// Describes the reference, and the time after which waveforms cannot be compared, if that is before
// the end.
std::string truth_text(const compare::Comparison& c) {
    std::string text =
        "reference: " + (c.against.doubling.empty() ? fmt::format("{} modes, those of the schemes",
                                                                  c.reference_summary.modes)
                                                    : c.against.doubling);
    const double from = free_from(c.scene());
    const auto until = [&](double t, const char* who) {
        const double whole = c.scene().duration - from;
        if (t < whole && compare::time_text(t) != compare::time_text(whole))
            text += fmt::format("\n{} agree within 10 % for the first {}{} only", who,
                                compare::time_text(t), from > 0 ? " after the last pluck" : "");
    };
    until(study::horizon_of(c.against.floor, c.headline),
          "two runs of it whose starts differ by 1e-12");
    until(c.horizon, "it and a run with half of its modes");
    return text + "\n";
}

std::string certificate_text(const compare::Comparison& c) {
    const study::Trust& t = c.against.trust;
    const std::string note = c.reference.note.empty() ? "" : "\n" + c.reference.note;
    if (!t.any()) return "its uncertainty is unknown, so no error is certain" + note;
    if (c.reference.oversampled)
        return fmt::format(
            "errors are against a string of as many modes, and no bounds: what those leave out is "
            "unknown. The step alone errs by about {:.1e}, by {}{}",
            t.in_model(c.headline.nut, 2), t.against, note);
    std::string by = t.against;
    if (!t.doubled.empty())
        by += (by.empty() ? "doubling its " : " and by doubling its ") + t.doubled;
    return fmt::format("its uncertainty is in the first line of the table, by {}{}", by,
                       t.file.empty() ? ""
                                      : " (" + fs::path(t.file).filename().string() +
                                            (t.of_this_program ? ")" : ", of another program)")) +
           (std::isnan(t.of_scene(c.headline.nut, 2)) ? ", which ends before this run does" : "") +
           note;
}

int compare_command(CompareCall r) {
    r.options = listed_options(r.option_lists);
    r.search =
        r.schemes.empty() || r.rates.empty() || std::ranges::none_of(r.options, names_compliance);
    if (r.modes_of_reference == "cell") r.reference_modes = std::nullopt;
    else r.reference_modes = static_cast<int>(store::number_of(r.modes_of_reference));
    const Console console(r.json, r.quiet);
    const compare::Catalogue catalogue(r.plugins);
    const auto costs = costs_of(r, catalogue);
    compare::note_slow_plugins(console);
    if (r.resume && r.out.empty())
        throw store::UsageError("--resume: there is no --out DIR to resume from");
    study::Kept keep;
    keep.resume = r.resume;
    const report::OwnFolder own(r.out, "comparison of " + compare::load_scene(r).name,
                                compare::identity_of(r), console);
    keep.folder = own.cells;
    std::optional<store::WhenInterrupted> last_word(std::in_place,
                                                    [&] { console.note(kept_text(keep)); });
    compare::Comparison c = compare::compare(r, catalogue, console, keep);
    last_word.reset();
    for (const auto& [scheme, by_rate] : costs) judge::report_costs(c, scheme, by_rate);
    if (r.resume)
        console.note(fmt::format("the errors of {} of {} cells were read back", c.outcome.read_back,
                                 keep.of.load()));
    const report::Written results = report::written(c, r, console);
    const study::Cells& cells = results.cells;
    const double rate = c.reference_summary.rate;
    for (const String& string : c.scene().strings)
        console.print("string: " + compare::tuning_text(string));
    std::string rows;
    for (const study::Point& p : c.plan.points)
        rows += fmt::format("{}{}", rows.empty() ? "" : " and ",
                            p.references.front().settings.tap_rate);
    console.print(fmt::format(
        "{} against {}{}, {} s, {} rows a second; L2 and horizon of {}, third octaves of {}",
        c.scene().name, c.reference.name(), std::isnan(rate) ? "" : fmt::format(" at {} Hz", rate),
        c.scene().duration, rows, c.scene().taps.at(c.headline.nut).name,
        c.scene().taps.at(c.headline.bridge).name));
    console.print(headline_lines(cells, Console::width()));
    console.print(truth_text(c) + certificate_text(c) + "\n" + floor_text(c));
    console.print(compare::cheapest_lines(results.cheapest, cells));
    if (c.advice)
        console.print("advice: " + text_of(*c.advice) + "\n" + verdict_on(*c.advice, cells).text);
    for (const std::string& warning : compare::warnings_of(cells))
        console.print("warning: " + warning, store::Mark::doubtful);
    if (!r.out.empty()) console.print("written: " + r.out);
    const int code = code_of(c.outcome.records);
    console.print_json(with_results({{"scene", c.scene().name},
                                     {"reference", c.reference.name()},
                                     {"status", exit_code::status(code)}},
                                    results));
    return code;
}
}  // namespace

Act compare_verb(CLI::App& program) {
    namespace fields = compare::fields;
    Verb<CompareCall> v(program, "compare",
                        "schemes at several rates against a reference: error and cost of each");
    v.scene(v.r.scene);
    v.set(v.r.set);
    v.option(fields::modes, v.r.modes, {"N,...", counting.check})->delimiter(',');
    v.options(v.r.option_lists);
    v.option(fields::schemes, v.r.schemes, {"A,B,..."})->delimiter(',');
    v.flag("--controls", v.r.controls,
           "controls, known to be wrong somewhere, can be the cheapest; with no --schemes they run "
           "as well");
    v.option(fields::rates, v.r.rates, {"HZ,...", hertz.check})->delimiter(',');
    v.option(fields::reference_modes, v.r.modes_of_reference,
             {"N|cell", CLI::Validator(
                            [](std::string& text) {
                                const std::string wrong =
                                    text == "cell" ? "" : counting_or_0.check(text);
                                return wrong.empty() ? wrong : wrong + ", or cell";
                            },
                            "")});
    v.option(fields::duration, v.r.duration, seconds);
    v.option(fields::tap_rate, v.r.tap_rate, hertz);
    v.option("--cost", v.r.costs, {"NAME=S,..."},
             "of a scheme that is not timed (--external): its computing time per second of sound, "
             "one for each of --rates; shown as reported (repeatable)")
        ->allow_extra_args(false);
    v.option(fields::repeats, v.r.repeats, counting);
    v.jobs(v.r.jobs);
    v.flag("--resume", v.r.resume,
           "reads back the errors of the cells that DIR holds and runs the others; all are timed "
           "again");
    v.comparison_folder(v.r.out);
    return v.does(compare_command,
                  "Example: jvari compare tanpura_c3_release --schemes modal_two_point --rates "
                  "44100,176400 --out report\n"
                  "\n"
                  "It searches settings unless schemes, rates and compliance are all named.");
}

}  // namespace jvari::bench::command
