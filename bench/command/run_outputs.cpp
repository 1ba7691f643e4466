#include "bench/command/run_outputs.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "bench/report/report.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/records.hpp"
#include "bench/store/trace_file.hpp"
#include "bench/store/usage.hpp"
#include "bench/study/judgement.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::command {

namespace {
using Json = nlohmann::ordered_json;

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

std::optional<report::Vega> vega_for(const RunFiles& f) {
    if (f.plot.empty() && !f.width.empty())
        throw store::UsageError("--width goes with --plot FILE");
    if (f.plot.empty()) return std::nullopt;
    if (!f.width.empty()) report::width_of(f.width);  // throws UsageError before the run
    const std::string extension = std::filesystem::path(f.plot).extension();
    if (extension != ".svg" && extension != ".html")
        throw store::UsageError("--plot " + f.plot +
                                ": expected a name that ends in .svg or .html");
    store::must_be_writable(f.plot);
    report::Vega vega = report::find_vega();
    if (!vega.missing.empty()) throw store::UsageError("--plot " + f.plot + ": " + vega.missing);
    return vega;
}
}  // namespace

RunOutputs::RunOutputs(const RunFiles& files, const Descriptor& scheme, const Scene& scene,
                       const Settings& settings)
    : files_(files),
      scheme_(scheme),
      own_(scene),
      sounding_(is_audio(files.out) ? audible(scene) : scene),
      scene_(sounding_),
      drawn_(is_audio(files.out) && !files.plot.empty() ? scene.taps.size() : 0),
      vega_(vega_for(files)),
      impacts_(scene.strings.begin(), scene.strings.end()) {
    scene_.taps.insert(scene_.taps.begin(), own_.taps.begin(),
                       own_.taps.begin() + static_cast<long>(drawn_));
    files_.energy = files_.energy || vega_;
    if (!files_.state.empty()) check_state(settings);
    if (is_audio(files_.out)) player_.emplace(files_.out, sounding_, settings.tap_rate);
    else if (!files_.out.empty()) store::check_trace_file(files_.out);
    if (!files_.impacts.empty()) check_impacts();
    if (scene_.duration * settings.tap_rate * (scene_.taps.size() + 3.0 * files_.energy) > 2e9)
        throw store::UsageError(fmt::format("{} s at {} rows a second do not fit in memory",
                                            scene_.duration, settings.tap_rate));
}

void RunOutputs::check_state(Settings settings) const {
    store::must_be_writable(files_.state);
    if (scheme_.clock == Clock::continuous) settings.sample_rate = 0;
    if (make_scheme(scheme_, scene_, settings)->state().displacement.empty())
        throw store::UsageError(
            fmt::format("--state: {} keeps more than displacement and velocity of each mode here, "
                        "and a run from these alone would be another. Expected one string without "
                        "masses and rigid barriers, by modal_two_point without compliance=matched "
                        "or by a reference",
                        scheme_.name));
}

void RunOutputs::check_impacts() const {
    if (std::ranges::all_of(scene_.strings, [](const String& s) { return !s.has_contacts(); }))
        throw store::UsageError("--impacts: no string of the scene has a barrier or a mass");
    store::must_be_writable(files_.impacts);
}

RunOptions RunOutputs::options() {
    RunOptions options;
    options.energy = files_.energy;
    options.state = !files_.state.empty();
    if (!files_.impacts.empty()) options.impacts = impacts_.data();
    return options;
}

void RunOutputs::check_reports() const {
    if (!files_.impacts.empty() && std::ranges::none_of(impacts_, &Impacts::reported))
        throw store::UsageError(
            fmt::format("--impacts: {} does not tell what its contacts do; exact_contact, modal "
                        "schemes and those of grids do",
                        scheme_.name));
}

void RunOutputs::write(const Run& run, const study::Summary& summary, Json& json,
                       std::string& text) const {
    if (!files_.out.empty()) write_out(run.trace, json, text);
    if (!files_.state.empty() && run.status.outcome == Outcome::ok)
        write_state(run.state, json, text);
    if (!files_.impacts.empty())
        write_impacts(static_cast<double>(run.trace.rows - 1) / run.trace.tap_rate, json, text);
    if (vega_) draw(summary, drawn_ > 0 ? part_of(run.trace, 0, own_) : run.trace, json, text);
}

void RunOutputs::write_out(const Trace& trace, Json& json, std::string& text) const {
    std::string level;
    if (player_) level = player_->write(drawn_ > 0 ? part_of(trace, drawn_, sounding_) : trace);
    else store::write_trace(files_.out, trace);
    json["out"] = files_.out;
    if (!level.empty()) json["level"] = level;
    text += fmt::format("\n  {:<28}{}{}", "written", files_.out,
                        level.empty() ? "" : "  (" + level + ")");
}

void RunOutputs::write_state(const ModalState& state, Json& json, std::string& text) const {
    std::string rows =
        fmt::format("# state of {}\nmode,displacement_m,velocity_m_per_s\n", scene_.name);
    for (std::size_t i = 0; i < state.displacement.size(); ++i)
        rows += fmt::format("{},{},{}\n", i + 1, state.displacement[i], state.velocity[i]);
    store::write_fresh(files_.state, rows);
    json["state"] = files_.state;
    text += fmt::format("\n  {:<28}{}", "state of the last row", files_.state);
}

void RunOutputs::write_impacts(double seconds, Json& json, std::string& text) const {
    const store::Table table = impacts_table(impacts_, scene_, seconds);
    store::write_fresh(files_.impacts, store::csv(table));
    json["impacts"] = store::rows_json(table);
    text +=
        fmt::format("\n  {:<28}{}  ({} contacts)", "written", files_.impacts, table.rows.size());
}

void RunOutputs::draw(const study::Summary& s, const Trace& trace, Json& json,
                      std::string& text) const {
    const std::string rate =
        std::isnan(s.rate) ? "continuous time" : fmt::format("{:g} kHz", s.rate / 1000);
    const std::string flags = names_of(study::flags_of(s));
    const std::string subtitle = fmt::format("{}, {}{}", rate, own_.source,
                                             flags.empty() ? "" : "; not to be trusted: " + flags);
    Json data = report::run_data(
        {fmt::format("{} on {}", scheme_.name, own_.name), subtitle, scheme_.name, own_, trace});
    if (files_.plot.ends_with(".html")) {
        store::write_fresh(files_.plot,
                           report::page_of(data, report::vega_scripts(*vega_).value_or("")));
    } else {
        if (!files_.width.empty())
            data["width"] = report::width_of(files_.width) * report::pixels_per_mm;
        const report::Drawn drawn = report::draw(*vega_, data);
        if (drawn.svgs.empty())
            throw store::Unwritable(
                files_.plot + ": " +
                (drawn.notes.empty() ? "nothing was drawn" : drawn.notes.front()));
        store::write_fresh(files_.plot, drawn.svgs.front().second);
    }
    json["plot"] = files_.plot;
    text += fmt::format("\n  {:<28}{}", "drawn", files_.plot);
}

}  // namespace jvari::bench::command
