// jvari trim: finds the cheapest sufficient model for a scene. DIR gets trimmed.toml, needs.csv,
// path.csv, manifest.json, the report and cells/.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "bench/command/console.hpp"
#include "bench/command/verbs.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/json.hpp"
#include "bench/store/system/interruption.hpp"
#include "bench/store/trace_file.hpp"
#include "bench/trim/trim.hpp"
#include "schemes/run.hpp"

namespace jvari::bench::command {

namespace {
namespace fs = std::filesystem;

struct TrimCall : Running, trim::Request {
    std::vector<std::string> option_lists;
};

std::string needs_text(const trim::Trimmed& t, const trim::Judge& judge) {
    TextTable table{{{"part", true}, {"error"}, {"cost"}, {"needed"}, {"in the model", true}}, {}};
    for (const trim::Need& n : t.needs)
        table.rows.push_back(
            {' ',
             {n.part + (n.becomes.empty() ? "" : " = " + n.becomes), judge.target().text(n.error),
              std::isnan(n.saved) ? "-" : fmt::format("{:+.0f} %", -100 * n.saved),
              n.needed ? "yes" : "no", n.left_out ? "left out" : "kept"}});
    return table.text(Console::width());
}

std::string path_text(const trim::Trimmed& t, const trim::Judge& judge) {
    TextTable table{{{"from the whole scene to the trimmed one", true},
                     {"error"},
                     {"s per s"},
                     {"model", true, 1}},
                    {}};
    for (std::size_t k = 0; k < t.path.steps.size(); ++k) {
        const trim::Step& s = t.path.steps[k];
        table.rows.push_back(
            {' ',
             {s.change + (s.within ? "" : " (not within)"), judge.target().text(s.error),
              fmt::format("{:.3g}", t.costs[k].median), s.model.settings_text()}});
    }
    return table.text(Console::width());
}

std::string verdict_text(const trim::Trimmed& t, trim::Judge& judge) {
    const trim::Target& target = judge.target();
    std::string text =
        fmt::format("truth: {}, {}; certain to {}, noise floor {}\n",
                    judge.truth(0).reference.choice.name(), judge.truth(0).description,
                    target.text(judge.certificate(0), "unknown"), target.text(judge.floor(0)));
    if (!t.path.within_tolerance)
        return text + fmt::format("none of {} is within {} over {:g} s",
                                  fmt::join(t.path.tried, ", "), target.text(target.most),
                                  t.whole.duration);
    for (const trim::Verified& v : t.verified)
        text += fmt::format("verified: {} from {}{}\n", target.text(v.error), v.name,
                            !v.decided    ? fmt::format(", whose reference is certain to {} only",
                                                        target.text(v.certificate, "unknown"))
                            : v.judged_by ? std::string()
                                          : ", which the search did not know");
    if (t.independent() == 0)
        text += "every start that there is judged the search: none was left to verify it\n";
    text += fmt::format(
        "{:.3g} times cheaper than the whole scene without matched compliance{}",
        t.costs.front().median / t.costs.back().median,
        t.full().within ? "" : fmt::format(" (which errs by {})", target.text(t.full().error)));
    if (t.costs.size() > 2)
        text += fmt::format(", {:.3g} times cheaper than the whole scene's cheapest settings",
                            t.costs[1].median / t.costs.back().median);
    return text;
}

// Writes sounds of the whole scene and of the trimmed model for the player: sounds.csv,
// sounds/*.wav. The sound of the whole scene is the reference for the other.
void keep_sounds(const fs::path& folder, const trim::Trimmed& t, const trim::Judge& judge) {
    constexpr double longest = 2;  // [s]
    std::vector<store::Sound> sounds;
    for (const trim::Step* step : {&t.full(), &t.last()}) {
        Scene scene = judge.scene_of(step->model);
        scene.duration = std::min(t.own_duration, longest);
        const Run r = run(*step->model.scheme, scene, step->model.settings);
        const auto tap = std::ranges::find(r.trace.names, judge.tap().name);
        if (r.status.outcome != Outcome::ok || tap == r.trace.names.end()) return;
        sounds.push_back(store::sound_of(
            r.trace.column(static_cast<int>(tap - r.trace.names.begin())), r.trace.tap_rate));
        if (sounds.back().samples.empty()) return;
    }
    const trim::Model& model = t.last().model;
    const auto named = [&](std::vector<store::Field> who, const char* file,
                           const store::Sound& sound, const char* reference) {
        return store::NamedSound{std::move(who),   file,
                                 judge.tap().name, name_of(judge.tap().quantity),
                                 &sound,           reference};
    };
    store::write_sounds(
        folder, {"scheme", "options", "rate", "modes", "what"},
        {named({"reference", "", "", "", "the whole scene"}, "whole", sounds[0], ""),
         named({model.scheme->name, store::options_text(model.settings.options),
                model.settings.sample_rate, model.settings.modes, "the trimmed model"},
               "trimmed", sounds[1], "whole")});
}

int trim_command(TrimCall r) {
    r.options = listed_options(r.option_lists);
    const Console console(r.json, r.quiet);
    const compare::Catalogue catalogue(r.Running::plugins);
    compare::note_slow_plugins(console);
    trim::Request request = r;
    request.plugins = r.Running::plugins;
    std::optional<store::WhenInterrupted> last_word;
    if (!r.out.empty())
        last_word.emplace([&] {
            console.note("interrupted: what was judged is kept in " + r.out +
                         "; the same command goes on from there");
        });
    const report::OwnFolder own(r.out, "trim of " + compare::load_scene(r.scene, r.set, {}).name,
                                trim::identity_of(request), console);
    trim::Judge judge(request, catalogue, console);
    const trim::Trimmed t = trim::trimmed(judge, request, catalogue, console);
    const auto manifest = trim::manifest_of(t, judge, request);
    const store::Table needs = trim::needs_table(t), path = trim::path_table(t, judge);
    report::ResultsFolder folder(r.out, console);
    if (t.path.within_tolerance) folder.add("trimmed.toml", trim::trimmed_toml(t, judge));
    if (t.path.within_tolerance && folder) keep_sounds(r.out, t, judge);
    folder.add("needs.csv", store::csv(needs));
    folder.add("path.csv", store::csv(path));
    folder.add_manifest(manifest);
    folder.add_report();
    console.print(fmt::format("{} within {} of {}, tap {}, {:g} s; {} models judged, {} read back",
                              t.whole.name, judge.target().text(judge.target().most),
                              judge.target().title, judge.tap().name, t.whole.duration, t.judged,
                              t.read_back));
    if (!t.path.steps.empty()) console.print(path_text(t, judge));
    if (t.path.within_tolerance) console.print(needs_text(t, judge));
    console.print(verdict_text(t, judge));
    std::string left = "not tried:";
    for (const std::string& what : t.not_tried) left += "\n  " + what;
    console.print(left);
    if (t.path.within_tolerance && !r.out.empty())
        console.print("written: " + r.out + "\n" +
                      trim::command_of(t, (fs::path(r.out) / "trimmed.toml").string()));
    console.print_json(store::indented({{"status", t.path.within_tolerance ? "ok" : "none"},
                                        {"manifest", manifest},
                                        {"path", store::rows_json(path)},
                                        {"needs", store::rows_json(needs)},
                                        {"files", folder.files}}));
    return t.path.within_tolerance ? exit_code::done : exit_code::run_failed;
}
}  // namespace

Act trim_verb(CLI::App& program) {
    Verb<TrimCall> v(program, "trim",
                     "the cheapest model of a scene within a tolerance: no more than it needs");
    v.scene(v.r.scene);
    v.option("--within", v.r.within, {"ERROR"},
             "the tolerance: 1%, or 1dB where the measure is in dB")
        ->required();
    v.option("--of", v.r.measure, {"MEASURE"},
             "l2_50ms (absent), heard, third_octave_db, stft, centroid or decay");
    v.option("--tap", v.r.tap, {"NAME"},
             "what is listened to; absent: the first nut force, else the first tap");
    v.option("--scheme", v.r.scheme, {"NAME|any"},
             "a scheme; any: all that represent the scene or what is left of it");
    v.set(v.r.set);
    v.options(v.r.option_lists);
    v.option(
        "--duration", v.r.duration, seconds,
        "how much of the scene is run; absent: to 50 ms after the last pluck, for decay all of it");
    v.option(
        "--tap-rate", v.r.tap_rate, hertz,
        "rows per second that are compared, and the lowest rate that is tried; 44100 where absent");
    v.option("--reference-modes", v.r.reference_modes, counting_or_0,
             "modes of the reference; absent: doubled until nothing moves, as far as twenty "
             "seconds reach");
    v.jobs(v.r.jobs);
    v.option("--out", v.r.out, {"DIR"},
             "folder for trimmed.toml, needs.csv, path.csv, trim.svg, report.html; what was judged "
             "is kept in its cells/");
    return v.does(trim_command, "Example: jvari trim tanpura_c3_release --within 1% --out trimmed");
}

}  // namespace jvari::bench::command
