// jvari run: runs one scheme on one scene. The trace goes to a file, the summary to standard
// output.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench/command/console.hpp"
#include "bench/command/player.hpp"
#include "bench/command/verbs.hpp"
#include "bench/compare/advice.hpp"
#include "bench/compare/catalogue.hpp"
#include "bench/compare/scene_notes.hpp"
#include "bench/report/report.hpp"
#include "bench/report/vega.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/json.hpp"
#include "bench/store/records.hpp"
#include "bench/store/trace_file.hpp"
#include "bench/store/usage.hpp"
#include "bench/study/cell.hpp"
#include "bench/study/judgement.hpp"
#include "schemes/impacts.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::command {

namespace {
using Json = nlohmann::ordered_json;

struct RunRequest : Running {
    std::string scene, scheme, within, measure, tap;
    std::optional<double> rate;  // [Hz]
    int modes = 0;
    std::optional<double> duration;  // [s]
    std::optional<double> tap_rate;  // [Hz]
    bool energy = false, facts = false;
    std::vector<std::string> set;
    std::vector<std::string> options;
    std::string out, impacts, plot, width, state;
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

std::string text_for(const RunRequest& r, const Descriptor& d, const Scene& scene,
                     const study::Summary& s) {
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
    text += facts_text(d, scene, s, r.facts);
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

// Tests before a long run that its output can be written. Returns the player if --out names a sound
// file.
std::optional<Player> checked_output(const RunRequest& r, const Scene& scene, double tap_rate) {
    if (is_audio(r.out)) return Player(r.out, scene, tap_rate);
    if (!r.out.empty()) store::check_trace_file(r.out);
    return std::nullopt;
}

// Tests before a long run that its final state can be written.
void check_state(const RunRequest& r, const Descriptor& d, const Scene& scene, Settings settings) {
    if (r.state.empty()) return;
    store::must_be_writable(r.state);
    if (d.clock == Clock::continuous) settings.sample_rate = 0;
    if (make_scheme(d, scene, settings)->state().displacement.empty())
        throw store::UsageError(
            fmt::format("--state: {} keeps more than displacement and velocity of each mode here, "
                        "and a run from these alone would be another. Expected one string without "
                        "masses and rigid barriers, by modal_two_point without compliance=matched "
                        "or by a reference",
                        d.name));
}

// Table with a row per contact, in the order of their starts. A contact lasting beyond the run has
// no end, no speed out and no loss; a contact that began earlier has no speed in.
store::Table impacts_table(const std::vector<Impacts>& of_strings, const Scene& scene,
                           double until) {
    std::vector<std::pair<int, Impact>> all;  // string number, impact
    for (const Impacts& of : of_strings)
        for (Impact i : of.all()) {
            if (i.end >= until) i.end = i.speed_out = i.energy_lost = nan;
            if (i.start <= 0) i.speed_in = nan;
            if (i.start < until) all.emplace_back(&of - of_strings.data(), i);
        }
    std::ranges::stable_sort(all, {}, [](const auto& one) { return one.second.start; });
    store::Table t{{"string", "barrier", "start_s", "end_s", "largest_force_N", "impulse_N_s",
                    "speed_in_m_per_s", "speed_out_m_per_s", "energy_lost_J"},
                   {}};
    for (const auto& [string, i] : all) {
        const int mass = i.barrier - static_cast<int>(scene.strings[string].barriers.size());
        t.rows.push_back({string, mass < 0 ? store::Field(i.barrier) : fmt::format("mass.{}", mass),
                          i.start, i.end, i.largest_force, i.impulse, i.speed_in, i.speed_out,
                          i.energy_lost});
    }
    return t;
}

// Extracts the taps for a scene from the trace for a scene with more taps.
Trace part_of(const Trace& all, std::size_t first, const Scene& of) {
    Trace part = all;
    part.names.clear();
    for (const Tap& tap : of.taps) part.names.push_back(tap.name);
    const auto begin = all.tap.begin() + static_cast<long>(first) * all.stride;
    part.tap.assign(begin, begin + static_cast<long>(of.taps.size()) * all.stride);
    return part;
}

// Tests before a long run that its picture can be drawn.
std::optional<report::Vega> vega_for(const RunRequest& r) {
    if (r.plot.empty() && !r.width.empty())
        throw store::UsageError("--width goes with --plot FILE");
    if (r.plot.empty()) return std::nullopt;
    if (!r.width.empty()) report::width_of(r.width);  // throws UsageError before the run
    const std::string extension = std::filesystem::path(r.plot).extension();
    if (extension != ".svg" && extension != ".html")
        throw store::UsageError("--plot " + r.plot +
                                ": expected a name that ends in .svg or .html");
    store::must_be_writable(r.plot);
    report::Vega vega = report::find_vega();
    if (!vega.missing.empty()) throw store::UsageError("--plot " + r.plot + ": " + vega.missing);
    return vega;
}

void draw(const std::string& file, const Descriptor& d, const Scene& scene, const study::Summary& s,
          const Trace& trace, const report::Vega& vega, const std::string& width) {
    const std::string rate =
        std::isnan(s.rate) ? "continuous time" : fmt::format("{:g} kHz", s.rate / 1000);
    const std::string flags = names_of(study::flags_of(s));
    const std::string subtitle = fmt::format("{}, {}{}", rate, scene.source,
                                             flags.empty() ? "" : "; not to be trusted: " + flags);
    Json data = report::run_data(
        {fmt::format("{} on {}", d.name, scene.name), subtitle, d.name, scene, trace});
    if (file.ends_with(".html"))
        return store::write_fresh(file,
                                  report::page_of(data, report::vega_scripts(vega).value_or("")));
    if (!width.empty()) data["width"] = report::width_of(width) * report::pixels_per_mm;
    const report::Drawn drawn = report::draw(vega, data);
    if (drawn.svgs.empty())
        throw store::Unwritable(file + ": " +
                                (drawn.notes.empty() ? "nothing was drawn" : drawn.notes.front()));
    store::write_fresh(file, drawn.svgs.front().second);
}

// Chooses scheme, rate and modes if the request asks for advice; the last advice counts.
std::vector<compare::Advice> advised(const RunRequest& r, const Scene& scene,
                                     const compare::Catalogue& catalogue, const Console& console) {
    const compare::AdviceRequest request{r.within, r.measure,  r.tap,
                                         r.scheme, r.tap_rate, scheme_options(r.options)};
    if (!compare::asks_for_advice(request, r.rate.has_value(), r.modes)) return {};
    const auto all = compare::advise(scene, request, catalogue, console);
    for (const compare::Advice& advice : all)
        if (advice.within) console.print(compare::text_of(advice));
        else console.note(compare::text_of(advice));
    return all;
}

// Tests the outputs and the size of a run before it begins.
void check_outputs(const RunRequest& r, const Scene& scene, double tap_rate, bool energy) {
    if (!r.impacts.empty()) {
        if (std::ranges::all_of(scene.strings, [](const String& s) { return !s.has_contacts(); }))
            throw store::UsageError("--impacts: no string of the scene has a barrier or a mass");
        store::must_be_writable(r.impacts);
    }
    if (scene.duration * tap_rate * (scene.taps.size() + 3.0 * energy) > 2e9)
        throw store::UsageError(
            fmt::format("{} s at {} rows a second do not fit in memory", scene.duration, tap_rate));
}

Run run_with_progress(const RunRequest& r, const Descriptor& d, const Scene& scene,
                      const Settings& settings, bool energy, std::vector<Impacts>& impacts,
                      const Console& console) {
    const auto progress = console.begin(fmt::format("{} on {}", d.name, scene.name));
    RunOptions options;
    options.energy = energy;
    options.state = !r.state.empty();
    if (!r.impacts.empty()) options.impacts = impacts.data();
    options.progress = [&](long done, long rows) {
        if (options.impacts && done > 0 && std::ranges::none_of(impacts, &Impacts::reported))
            throw store::UsageError(
                fmt::format("--impacts: {} does not tell what its contacts do; exact_contact, "
                            "modal schemes and those of grids do",
                            d.name));
        progress->show(static_cast<double>(done) / static_cast<double>(rows));
    };
    options.slow = [&](long done, long rows, const std::vector<Fact>& facts) {
        console.note(fmt::format("{} on {}: {} of {} rows in {} s{}", d.name, scene.name, done,
                                 rows, long_run, dearest(facts)));
    };
    return run(d, scene, settings, options);
}

void write_state(const RunRequest& r, const Scene& scene, const ModalState& state, Json& json,
                 std::string& text) {
    std::string rows =
        fmt::format("# state of {}\nmode,displacement_m,velocity_m_per_s\n", scene.name);
    for (std::size_t i = 0; i < state.displacement.size(); ++i)
        rows += fmt::format("{},{},{}\n", i + 1, state.displacement[i], state.velocity[i]);
    store::write_fresh(r.state, rows);
    json["state"] = r.state;
    text += fmt::format("\n  {:<28}{}", "state of the last row", r.state);
}

// Writes the trace or the sound. The picture's taps come before the sound's in a run for both.
void write_out(const RunRequest& r, const std::optional<Player>& player, std::size_t drawn,
               const Scene& sounding, const Trace& trace, Json& json, std::string& text) {
    std::string level;
    if (player && drawn > 0) level = player->write(part_of(trace, drawn, sounding));
    else if (player) level = player->write(trace);
    else store::write_trace(r.out, trace);
    json["out"] = r.out;
    if (!level.empty()) json["level"] = level;
    text +=
        fmt::format("\n  {:<28}{}{}", "written", r.out, level.empty() ? "" : "  (" + level + ")");
}

void write_impacts(const RunRequest& r, const std::vector<Impacts>& impacts, const Scene& scene,
                   double seconds, Json& json, std::string& text) {
    const store::Table table = impacts_table(impacts, scene, seconds);
    store::write_fresh(r.impacts, store::csv(table));
    json["impacts"] = store::rows_json(table);
    text += fmt::format("\n  {:<28}{}  ({} contacts)", "written", r.impacts, table.rows.size());
}

int end_of(const Run& result, const Console& console) {
    if (result.status.outcome == Outcome::ok) return exit_code::done;
    console.note(fmt::format("{} at step {}: {} rows are valid", name_of(result.status.outcome),
                             result.status.step, result.trace.rows));
    return exit_code::run_failed;
}

int run_command(RunRequest r) {
    const Console console(r.json, r.quiet);
    const compare::Catalogue catalogue(r.plugins);
    compare::note_slow_plugins(console);
    // Picture and sound need different taps: the picture shows the scene's own taps, the sound uses
    // others. A run for both has the scene's own taps first.
    const bool played = is_audio(r.out);
    const Scene own = compare::load_scene(r.scene, r.set, r.duration),
                sounding = played ? audible(own) : own;
    store::must_not_replace(
        {{"--out", r.out}, {"--state", r.state}, {"--impacts", r.impacts}, {"--plot", r.plot}},
        files_read(own, r.scene, r.plugins));
    const std::size_t drawn = played && !r.plot.empty() ? own.taps.size() : 0;
    Scene scene = sounding;
    scene.taps.insert(scene.taps.begin(), own.taps.begin(),
                      own.taps.begin() + static_cast<long>(drawn));
    compare::note_scene(scene, console);
    const auto advice = advised(r, own, catalogue, console);
    if (!advice.empty() && !advice.back().within) {
        console.print_json(
            store::indented({{"status", "none"}, {"advice", compare::json_of(advice.back())}}));
        return exit_code::run_failed;
    }
    const Descriptor& d = advice.empty() ? catalogue.find(r.scheme) : *advice.back().scheme;
    const Settings settings = advice.empty()
                                  ? compare::settings_of_run(d, r.rate.value_or(44100), r.tap_rate,
                                                             r.modes, scheme_options(r.options))
                                  : advice.back().settings;
    compare::note_force_files(scene, settings.sample_rate, console);
    compare::note_modes(d, scene, settings, console);
    const std::optional<report::Vega> vega = vega_for(r);
    check_state(r, d, scene, settings);
    const std::optional<Player> player = checked_output(r, sounding, settings.tap_rate);
    std::vector<Impacts> impacts(scene.strings.begin(), scene.strings.end());
    check_outputs(r, scene, settings.tap_rate, r.energy || vega);
    if (r.rate && d.clock == Clock::continuous)
        console.note(fmt::format("{} has no sample rate: --rate is left aside", d.name));

    const Run result = run_with_progress(r, d, scene, settings, r.energy || vega, impacts, console);
    const study::Summary summary = study::summary_of(d, scene, settings, result);
    Json json = json_of(summary);
    if (!advice.empty()) json["advice"] = compare::json_of(advice.back());
    std::string text = text_for(r, d, scene, summary);
    if (!r.out.empty()) write_out(r, player, drawn, sounding, result.trace, json, text);
    if (!r.state.empty() && result.status.outcome == Outcome::ok)
        write_state(r, scene, result.state, json, text);
    if (!r.impacts.empty())
        write_impacts(r, impacts, scene,
                      static_cast<double>(result.trace.rows - 1) / settings.tap_rate, json, text);
    if (vega) {
        if (drawn > 0) draw(r.plot, d, own, summary, part_of(result.trace, 0, own), *vega, r.width);
        else draw(r.plot, d, own, summary, result.trace, *vega, r.width);
        json["plot"] = r.plot;
        text += fmt::format("\n  {:<28}{}", "drawn", r.plot);
    }
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
