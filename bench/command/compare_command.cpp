// jvari compare: the main job. What it found goes to a folder and a page; then, that nothing is lost where nobody reads it, to a table.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench/command/commands.hpp"
#include "bench/command/compare_text.hpp"
#include "bench/command/console.hpp"
#include "bench/command/results_folder.hpp"
#include "bench/compare/bound.hpp"
#include "bench/compare/diagnosis.hpp"
#include "bench/compare/record/cheapest.hpp"
#include "bench/compare/record/compare_record.hpp"
#include "bench/compare/record/convergence_table.hpp"
#include "bench/compare/record/matching_note.hpp"
#include "bench/compare/record/spread.hpp"
#include "bench/compare/scene_notes.hpp"
#include "bench/report/report.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/indented.hpp"
#include "bench/store/system/interruption.hpp"
#include "bench/study/columns.hpp"
#include "bench/study/run.hpp"

namespace jvari::bench::command {

namespace {
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

std::string kept_text(const study::Kept& keep) {
    if (keep.folder.empty()) return "interrupted: nothing is kept, for there is no --out DIR";
    if (keep.of == 0) return "interrupted: no cell has its errors yet; long runs of references are kept";
    return fmt::format("interrupted: the errors of {} of {} cells are kept in {}; --resume goes on from there", keep.kept.load(),
                       keep.of.load(), keep.folder.parent_path().string());
}

std::string floor_text(const compare::Comparison& c) {
    std::string text;
    for (std::size_t k = 0; k < study::measures().size(); ++k) {
        const study::Measure& m = study::measures()[k];
        const double floor = c.against.floor[c.headline.tap(m)][k];
        if (m.less_is_better && !std::isnan(floor))
            text += fmt::format("{}{} {:.1e}", text.empty() ? "noise floor: " : ", ", m.column, floor);
    }
    return text;
}

// What the reference is, and from when on waveforms cannot be compared, where that is before the end.
std::string truth_text(const compare::Comparison& c) {
    std::string text =
        "reference: " +
        (c.against.doubling.empty() ? fmt::format("{} modes, those of the schemes", c.reference_summary.modes) : c.against.doubling);
    const auto until = [&](double t, const char* who) {
        if (t < c.scene().duration - 1e-3) text += fmt::format("\n{} agree within 10 % for the first {} only", who, compare::time_text(t));
    };
    until(study::horizon_of(c.against.floor, c.headline), "two runs of it whose starts differ by 1e-12");
    until(c.horizon, "it and a run with half of its modes");
    return text + "\n";
}

std::string certificate_text(const compare::Comparison& c) {
    const trust::Trust& t = c.against.trust;
    const std::string note = c.reference.note.empty() ? "" : "\n" + c.reference.note;
    if (!t.any()) return "its uncertainty is unknown, so no error is certain" + note;
    std::string by = t.against;
    if (!t.doubled.empty()) by += (by.empty() ? "doubling its " : " and by doubling its ") + t.doubled;
    return fmt::format(
               "its uncertainty is in the first line of the table, by {}{}", by,
               t.file.empty() ? "" : " (" + fs::path(t.file).filename().string() + (t.of_this_program ? ")" : ", of another program)")) +
           (std::isnan(t.of_scene(c.headline.nut, 2)) ? ", which ends before this run does" : "") + note;
}
}  // namespace

int compare_command(const CompareCall& r) {
    const Console console(r.json, r.quiet);
    const compare::Catalogue catalogue(r.plugins);
    compare::note_slow_plugins(console);
    if (r.resume && r.out.empty()) throw store::UsageError("--resume: there is no --out DIR to resume from");
    study::Kept keep;
    keep.resume = r.resume;
    if (!r.out.empty()) {
        must_be_ours(r.out, "comparison of " + compare::load_scene(r.scene, r.set, r.duration).name, console);
        make_folder(r.out);
        keep.folder = fs::path(r.out) / "cells";
    }
    std::optional<store::WhenInterrupted> last_word(std::in_place, [&] { console.note(kept_text(keep)); });
    const compare::Comparison c = compare::compare(r, catalogue, console, keep);
    last_word.reset();
    if (r.resume) console.note(fmt::format("the errors of {} of {} cells were read back", c.outcome.read_back, keep.of.load()));
    const store::Table cells = compare::cells_of(c);
    const std::string manifest = compare::manifest_of(c, r);

    const store::Table cheapest =
        compare::cheapest_of(cells, "", r.controls ? compare::Controls::compete : compare::Controls::stand_beside);
    Json files = Json::array();
    if (!r.out.empty()) {
        const fs::path folder = r.out;
        for (const std::string& file : write_tables(folder, cells)) files.push_back(file);
        store::write_fresh(folder / "manifest.json", manifest + "\n");
        compare::write_sounds(c, folder);
        files.push_back((folder / "manifest.json").string());
        for (const std::string& name : report::write_report(folder, console)) files.push_back((folder / name).string());
    }

    const double rate = c.reference_summary.rate;
    for (const String& string : c.scene().strings) console.print("string: " + compare::tuning_text(string));
    console.print(fmt::format("{} against {}{}, {} s, {} rows a second; L2 and horizon of {}, third octaves of {}", c.scene().name,
                              c.reference.name(), std::isnan(rate) ? "" : fmt::format(" at {} Hz", rate), c.scene().duration,
                              c.reference.settings.tap_rate, c.scene().taps.at(c.headline.nut).name,
                              c.scene().taps.at(c.headline.bridge).name));
    console.print(headline_text(cells) + "\n" + truth_text(c) + certificate_text(c) + "\n" + floor_text(c));
    if (!cheapest.rows.empty()) console.print(compare::cheapest_text(cheapest));
    if (const std::string note = compare::matching_note(cells); !note.empty()) console.print(note);
    if (const std::string busy = compare::busy_text(cells); !busy.empty()) console.print("warning: " + busy);
    if (!r.out.empty()) console.print("written: " + r.out);
    const int code = code_of(c.outcome.records);
    console.print_json(
        store::indented(with_results({{"scene", c.scene().name}, {"reference", c.reference.name()}, {"status", exit_code::status(code)}},
                                     manifest, cells, cheapest, files)));
    return code;
}

}  // namespace jvari::bench::command
