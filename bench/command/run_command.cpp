// jvari run: runs one scheme on one scene. The trace goes to a file, the summary to standard
// output.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench/command/console.hpp"
#include "bench/command/run_outputs.hpp"
#include "bench/command/verbs.hpp"
#include "bench/compare/advice.hpp"
#include "bench/compare/catalogue.hpp"
#include "bench/compare/scene_notes.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/json.hpp"
#include "bench/study/cell.hpp"
#include "bench/study/judgement.hpp"

namespace jvari::bench::command {

namespace {
using Json = nlohmann::ordered_json;

struct RunRequest : Running, RunFiles {
    std::string scene, scheme, within, measure, tap;
    std::optional<double> rate;  // [Hz]
    int modes = 0;
    std::optional<double> duration;  // [s]
    std::optional<double> tap_rate;  // [Hz]
    bool facts = false;
    std::vector<std::string> set;
    std::vector<std::string> options;
};

// Names the most expensive part of a run besides its modes or nodes and its steps, according to its
// facts.
std::string dearest(const std::vector<Fact>& facts) {
    const double coupled = fact_of(facts, facts::coupled_contact_points);
    if (!(coupled > 8)) return "";
    return fmt::format(
        ". Dear is its contact: {:.0f} points that push each other are solved together, each step "
        "by up to the cube of those that touch; a shorter profile or a coarser grid has fewer",
        coupled);
}

// Lists all facts, or without `all` only the facts about approximations.
std::string facts_text(const Descriptor& d, const Scene& scene, const study::Summary& s, bool all) {
    // With several strings the name of the fact follows the last dot.
    const auto approximates = [&](const std::string& name) {
        return std::ranges::any_of(d.approximates, [&](const Approximation& a) {
            return name.substr(name.rfind('.') + 1) == a.fact.name &&
                   needed_by(scene).has(a.feature);
        });
    };
    std::string text;
    for (const Fact& f : s.facts)
        if (all || approximates(f.name))
            text += fmt::format("\n  {:<27} {:.6g} {}", f.name, f.value, f.unit);
    return text;
}

std::string text_for(const Descriptor& d, const Scene& scene, const study::Summary& s,
                     bool all_facts) {
    std::string text = fmt::format("{} on {}", s.scheme, s.scene);
    const auto line = [&text](const char* name, const std::string& value) {
        text += fmt::format("\n  {:<27} {}", name, value);
    };
    for (const String& string : scene.strings) line("string", compare::tuning_text(string));
    if (s.status.outcome == Outcome::ok) line("status", "ok");
    else line("status", fmt::format("{} at step {}", name_of(s.status.outcome), s.status.step));
    line("rate", std::isnan(s.rate) ? "continuous time" : fmt::format("{} Hz", s.rate));
    line("modes", fmt::format("{}  ({} doubles of state)", s.modes, s.dofs));
    line("rows", fmt::format("{}  ({:.6g} s, {} steps)", s.rows, s.duration, s.steps));
    line("wall time",
         fmt::format(
             "{:.4g} s{}{}", s.wall_seconds,
             std::isnan(s.ns_per_step) ? "" : fmt::format(", {:.1f} ns per step", s.ns_per_step),
             std::isnan(s.times_real_time)
                 ? ""
                 : fmt::format(", {:.4g} times real time", s.times_real_time)));
    if (!std::isnan(s.energy_residual_per_step))
        line("energy residual",
             fmt::format("{:.2e} of one row, {:.2e} accumulated", s.energy_residual_per_step,
                         s.energy_residual_accumulated));
    if (!std::isnan(s.smallest_contact_force))
        line("smallest contact force", fmt::format("{:.6g} N", s.smallest_contact_force));
    if (!std::isnan(s.largest_contact_force))
        line("largest contact force", fmt::format("{:.6g} N", s.largest_contact_force));
    if (!std::isnan(s.deepest_penetration))
        line("deepest penetration", fmt::format("{:.6g} m", s.deepest_penetration));
    text += facts_text(d, scene, s, all_facts);
    for (const study::Flag& f : study::flags_of(s)) text += "\n! " + f.sentence;
    if (const std::string untouched = compare::untouched_text(scene, s); !untouched.empty())
        text += "\n! " + untouched;
    return text;
}

Json json_of(const study::Summary& s) {
    Json j{{"scheme", s.scheme}, {"scene", s.scene}, {"status", name_of(s.status.outcome)}};
    if (s.status.outcome != Outcome::ok) j["step"] = s.status.step;
    each_figure(s, [&j](const std::string& name, auto figure) {  // NaN becomes null
        if (name != "processor_seconds")                         // not measured here
            j[name] = figure;
    });
    j["flags"] = Json::object();
    for (const study::Flag& f : study::flags_of(s)) j["flags"][f.name] = f.sentence;
    j["facts"] = Json::object();
    for (const Fact& f : s.facts) j["facts"][f.name] = f.value;
    return j;
}

// Chooses scheme, rate and modes if the request asks for advice; the last advice counts.
std::optional<compare::Advice> advised(const RunRequest& r, const Scene& scene,
                                       const compare::Catalogue& catalogue,
                                       const Console& console) {
    const compare::AdviceRequest request{r.within, r.measure,  r.tap,
                                         r.scheme, r.tap_rate, scheme_options(r.options)};
    if (!compare::asks_for_advice(request, r.rate.has_value(), r.modes)) return std::nullopt;
    const auto all = compare::advise(scene, request, catalogue, console);
    for (const compare::Advice& advice : all)
        if (advice.within) console.print(compare::text_of(advice));
        else console.note(compare::text_of(advice));
    if (!all.back().within && compare::is_to_run(all.back(), r.within))
        console.note("no tolerance was asked for, so these settings run");
    return all.back();
}

Run run_with_progress(const Descriptor& d, const Settings& settings, RunOutputs& outputs,
                      const Console& console) {
    const Scene& scene = outputs.scene();
    const auto progress = console.begin(fmt::format("{} on {}", d.name, scene.name));
    RunOptions options = outputs.options();
    options.progress = [&](long done, long rows) {
        if (done > 0) outputs.check_reports();
        progress->show(static_cast<double>(done) / static_cast<double>(rows));
    };
    options.slow = [&](long done, long rows, const std::vector<Fact>& facts) {
        console.note(fmt::format("{} on {}: {} of {} rows in {} s{}", d.name, scene.name, done,
                                 rows, long_run, dearest(facts)));
    };
    return run(d, scene, settings, options);
}

int end_of(const Run& result, const Console& console) {
    if (result.status.outcome == Outcome::ok) return exit_code::done;
    console.note(fmt::format("{} at step {}: {} rows are valid", name_of(result.status.outcome),
                             result.status.step, result.trace.rows));
    return exit_code::run_failed;
}

int run_command(const RunRequest& r) {
    const Console console(r.json, r.quiet);
    const compare::Catalogue catalogue(r.plugins);
    compare::note_slow_plugins(console);
    const Scene scene = compare::load_scene(r.scene, r.set, r.duration);
    store::must_not_replace(
        {{"--out", r.out}, {"--state", r.state}, {"--impacts", r.impacts}, {"--plot", r.plot}},
        files_read(scene, r.scene, r.plugins));
    compare::note_scene(scene, console);
    const auto advice = advised(r, scene, catalogue, console);
    if (advice && !compare::is_to_run(*advice, r.within)) {
        console.print_json(
            store::indented({{"status", "none"}, {"advice", compare::json_of(*advice)}}));
        return exit_code::run_failed;
    }
    const Descriptor& d = advice ? *advice->scheme : catalogue.find(r.scheme);
    const Settings settings = advice
                                  ? advice->settings
                                  : compare::settings_of_run(d, r.rate.value_or(44100), r.tap_rate,
                                                             r.modes, scheme_options(r.options));
    compare::note_force_files(scene, settings.sample_rate, console);
    compare::note_modes(d, scene, settings, console);
    RunOutputs outputs(r, d, scene, settings);
    if (r.rate && d.clock == Clock::continuous)
        console.note(fmt::format("{} has no sample rate: --rate is left aside", d.name));
    const Run result = run_with_progress(d, settings, outputs, console);
    const study::Summary summary = study::summary_of(d, outputs.scene(), settings, result);
    Json json = json_of(summary);
    if (advice) json["advice"] = compare::json_of(*advice);
    std::string text = text_for(d, scene, summary, r.facts);
    outputs.write(result, summary, json, text);
    console.print(text);
    console.print_json(store::indented(json));
    return end_of(result, console);
}
}  // namespace

Act run_verb(CLI::App& program) {
    Verb<RunRequest> v(program, "run", "one scheme on one scene");
    v.scene(v.r.scene);
    v.set(v.r.set);
    v.modes(v.r.modes);
    v.options(v.r.options);
    v.option("--scheme", v.r.scheme, {"NAME"},
             "a scheme or a reference; absent: the one of --within, 1% where that is absent too");
    v.option("--within", v.r.within, {"ERROR"},
             "chooses scheme, rate and modes by their estimated error, 1%, or 3dB with --of "
             "third_octave_db: two runs tell what doubling rate and modes changes");
    v.option("--of", v.r.measure, {"MEASURE"},
             "of --within: the waveform over 8 periods of the string (absent), l2_10ms, l2_50ms, "
             "l2_whole or third_octave_db");
    v.option("--tap", v.r.tap, {"NAME"},
             "of --within: what is listened to; absent: the first nut force, else the first tap");
    v.option("--rate", v.r.rate, hertz, "sample rate; 44100 where absent");
    v.option(compare::fields::duration, v.r.duration, seconds);
    v.option("--tap-rate", v.r.tap_rate, hertz,
             "rows per second; 44100 where absent, or the rate where that is no multiple of it");
    v.flag("--energy", v.r.energy,
           "probe the energy: three more columns, and the residuals of the balance");
    v.flag("--facts", v.r.facts,
           "every fact that the scheme reports, its solver's counters among them; --json always "
           "has them");
    v.option("--out", v.r.out, {"FILE"}, "writes the trace, .csv, or what is heard of it, .wav");
    v.option("--state", v.r.state, {"FILE.csv"},
             "writes displacement and velocity of each mode in the last row: another run goes on "
             "from there by --set string.0.start=FILE.csv");
    v.option("--impacts", v.r.impacts, {"FILE"},
             "writes what each contact did, .csv: when, how hard, how fast in and out, what it "
             "lost; a scheme knows instants to a step, exact_contact as they are");
    v.option("--width", v.r.width, {"WIDTH"}, "of the picture, as 85mm for a column of a paper");
    v.option("--plot", v.r.plot, {"FILE"},
             "draws the run, .svg or .html: taps, spectrum, spectrogram, energy ledger, contact "
             "times (turns --energy on)");
    return v.does(run_command,
                  "Example: jvari run tanpura_c3 --within 1% --out c3.wav\n"
                  "         jvari run tanpura_c3 --scheme modal_two_point --rate 176400 --duration "
                  "0.2 --out c3.csv");
}

}  // namespace jvari::bench::command
