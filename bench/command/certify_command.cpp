// jvari certify: compares the references that represent a scene with one another. The result goes
// to a file and a table, and compare and suite add it to their errors.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/command/console.hpp"
#include "bench/command/verbs.hpp"
#include "bench/compare/catalogue.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/json.hpp"
#include "bench/store/records.hpp"
#include "bench/store/system/file_lock.hpp"
#include "bench/store/system/interruption.hpp"
#include "bench/store/system/listener.hpp"
#include "bench/store/usage.hpp"
#include "bench/study/certificate_library.hpp"
#include "bench/study/reference.hpp"

namespace jvari::bench::command {

namespace {
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;
using study::Certificate;

struct CertifyRequest : Running {
    std::string scene, out;
    int modes = 0;
    std::optional<double> duration, tap_rate;  // [s], [Hz]
    std::vector<std::string> set;
};

// The default name for a changed scene differs from the name for the original scene.
fs::path path_for(const CertifyRequest& r, const Scene& scene) {
    if (!r.out.empty()) {
        if (fs::path(r.out).extension() != ".json" || r.out.ends_with(".cost.json"))
            throw store::UsageError(
                fmt::format("--out {}: expected a name that ends in .json (its costs go beside it, "
                            "to .cost.json)",
                            r.out));
        return r.out;
    }
    const fs::path folder = "results/certificates";
    store::make_folder(folder);
    return folder /
           (study::file_stem(scene.name) +
            (r.set.empty() ? "" : "-" + study::timeless_hash(scene).substr(0, 8)) + ".json");
}

std::string entries_text(const Certificate& c) {
    TextTable t{
        {{""}, {"reference", true}, {"status", true}, {"until", false, 1}, {"cost", false, 2}}, {}};
    for (std::size_t i = 0; i < c.entries.size(); ++i) {
        const auto& e = c.entries[i];
        const std::string name =
            store::variant_name(
                e.reference +
                    (e.sample_rate > 0 ? fmt::format(" at {:.10g} Hz", e.sample_rate) : ""),
                store::options_text(e.options)) +
            (e.doubled.empty() ? "" : ", twice the " + e.doubled);
        const bool refused = !e.reason.empty();
        t.rows.push_back(
            {' ',
             {std::to_string(i + 1), name, refused ? "refused" : name_of(e.status.outcome),
              refused ? "-" : fmt::format("{:.4g} s", e.reached),
              refused || std::isnan(e.wall_seconds) ? "-"
                                                    : fmt::format("{:.3g} s", e.wall_seconds)}});
    }
    std::string text = t.text(Console::width());
    for (std::size_t i = 0; i < c.entries.size(); ++i)
        if (!c.entries[i].reason.empty())
            text += fmt::format("  {} refused: {}\n", i + 1, c.entries[i].reason);
    return text;
}

std::vector<std::size_t> windows_of(const Certificate& c) {
    std::vector<std::size_t> windows;
    for (std::size_t w = 0; w + 1 < agreement_windows.size(); ++w)
        if (agreement_windows[w] < (c.duration - c.from) * (1 - 1e-9)) windows.push_back(w);
    windows.push_back(agreement_windows.size() - 1);
    return windows;
}

std::vector<std::string> numbers(const Certificate::ByWindow& values,
                                 const std::vector<std::size_t>& windows) {
    std::vector<std::string> fields;
    for (const std::size_t w : windows)
        fields.push_back(std::isnan(values[w]) ? "-" : fmt::format("{:.1e}", values[w]));
    return fields;
}

std::vector<std::string> instants(const Agreement& a, double duration, double tap_rate) {
    std::vector<std::string> fields;
    for (const double t : a.until)
        fields.push_back(t >= duration - 0.5 / tap_rate ? "end"
                                                        : fmt::format("{:.2f} ms", 1e3 * t));
    return fields;
}

std::string figures_text(const Certificate& c) {
    const auto windows = windows_of(c);
    TextTable t{{{"pair", true}, {"tap", true}}, {}};
    for (const std::size_t w : windows)
        t.columns.push_back({w + 1 < agreement_windows.size()
                                 ? fmt::format("{:.0f} ms", 1e3 * agreement_windows[w])
                                 : "whole"});
    for (const double level : agreement_levels)
        t.columns.push_back({fmt::format("to 1e{:.0f}", std::log10(level)), false, 1});
    const auto add = [&](const std::string& name, std::size_t tap,
                         const Certificate::ByWindow& values,
                         const std::vector<std::string>& until) {
        TextTable::Row row{' ', {name, c.taps[tap]}};
        for (const auto& fields : {numbers(values, windows), until})
            row.fields.insert(row.fields.end(), fields.begin(), fields.end());
        t.rows.push_back(row);
    };
    for (const auto& p : c.pairs) {
        const double common =
            std::min(c.entries[p.first].reached, c.entries[p.second].reached) - c.from;
        for (std::size_t k = 0; k < c.taps.size(); ++k)
            add(fmt::format("{} against {}", p.first + 1, p.second + 1), k, p.taps[k].relative_l2,
                instants(p.taps[k], common, c.tap_rate));
    }
    for (std::size_t i = 0; i < c.entries.size(); ++i)
        for (std::size_t k = 0; k < c.entries[i].estimate.size(); ++k)
            add(fmt::format("{} itself", i + 1), k, c.entries[i].estimate[k],
                std::vector<std::string>(agreement_levels.size()));
    for (std::size_t k = 0; k < c.taps.size(); ++k)
        add("noise floor", k, c.floor[k].relative_l2,
            instants(c.floor[k], c.duration - c.from, c.tap_rate));
    return t.text(Console::width());
}

std::string text_of(const Certificate& c) {
    const bool estimated = std::any_of(c.entries.begin(), c.entries.end(),
                                       [](const auto& e) { return !e.estimate.empty(); });
    return fmt::format(
               "{}: {} modes, {:.10g} rows a second, {:.6g} s{}\n\n{}\n{}", c.scene, c.modes,
               c.tap_rate, c.duration,
               c.from > 0
                   ? fmt::format(", judged from {:.6g} s on, where the last pluck ends", c.from)
                   : "",
               entries_text(c), figures_text(c)) +
           "relative L2 difference over the first 10 ms and so on, and how long a pair stays "
           "closer than 1e-3, 1e-6, 1e-9" +
           (estimated
                ? "; \"itself\": its own estimate by Richardson's rule, of a string of as many "
                  "modes: what those leave out is unknown"
                : "") +
           "\nnoise floor: the first against itself, started a relative 1e-12 apart";
}

// Tests whether the old certificate says more about the same scene than the requested one would: it
// covers a longer duration.
bool covers_more(const Certificate& old, const Certificate& fresh) {
    if (old.scene_hash != fresh.scene_hash || old.modes != fresh.modes ||
        old.tap_rate != fresh.tap_rate)
        return false;
    const auto is_stand_in = [](const Certificate& c) { return c.entries.front().oversampled(); };
    // A reference has learned to represent the scene.
    if (is_stand_in(old) && !is_stand_in(fresh)) return false;
    return old.duration > fresh.duration * (1 + 1e-9);
}

Json json_of(const Certificate& c, const Scene& scene, const fs::path& path, bool cached,
             bool good) {
    Json costs = Json::array();
    for (const auto& e : c.entries) costs.push_back(e.wall_seconds);
    return {{"scene", scene.name},
            {"status", good ? "ok" : "failed"},
            {"cached", cached},
            {"file", path.string()},
            {"cost_file", study::cost_path(path).string()},
            {"certificate", store::parsed(study::json_of(c))},
            {"wall_seconds", costs}};
}

int certify_command(const CertifyRequest& r) {
    const Console console(r.json, r.quiet);
    const compare::Catalogue catalogue(r.plugins);
    const Scene scene = compare::load_scene(r.scene, r.set, r.duration);
    const double tap_rate = r.tap_rate.value_or(44100);
    if (scene.duration * tap_rate * static_cast<double>(scene.taps.size()) > 1e8)
        throw store::UsageError(
            fmt::format("{} s at {} rows a second do not fit in memory", scene.duration, tap_rate));
    Certificate c = study::certificate_plan(scene, {r.modes, tap_rate});
    const fs::path path = path_for(r, scene);
    store::must_be_writable(path);
    store::must_be_writable(study::cost_path(path));

    bool cached = false;
    std::error_code error;
    // Another process may be making the same certificate.
    const auto lock = store::lock_of(path, "makes " + path.string(), console);
    if (fs::exists(path, error)) {
        auto found = study::read_certificate(path);
        if (found && covers_more(*found, c))
            throw store::UsageError(fmt::format(
                "{} covers more of this scene than is asked for: {:g} s against {:g} s; it is "
                "kept. --out FILE writes elsewhere",
                path.string(), found->duration, c.duration));
        cached = found && found->identity() == c.identity();
        if (cached) c = std::move(*found);
        else
            console.note(fmt::format("{} {}; it is made again", path.string(),
                                     !found ? "is not whole, or no certificate of this format"
                                     : found->of_this_program()
                                         ? "is of another scene or setting"
                                         : "was made by another program (sources, compiler, "
                                           "flags, vector instructions)"));
    }
    if (cached) {
        study::read_costs(path, c);
    } else {
        const fs::path runs = study::kept_runs_folder();
        const store::WhenInterrupted last_word([&] {
            console.note(runs.empty() ? "interrupted: nothing is kept, until all runs of a "
                                        "certificate are done"
                                      : "interrupted: runs that took half a second and more are "
                                        "kept in " +
                                            runs.string());
        });
        c = study::certify(scene, std::move(c), console, runs);
        store::write_fresh(study::cost_path(path), study::cost_json_of(c));
        store::write_fresh(path, study::json_of(c));
    }
    console.print(text_of(c));
    console.print((cached ? "read: " : "written: ") + path.string());

    const auto& entries = c.entries;
    const bool good = std::any_of(entries.begin(), entries.end(), [](const auto& e) {
        return e.reason.empty() && e.status.outcome == Outcome::ok;
    });
    console.print_json(store::indented(json_of(c, scene, path, cached, good)));
    return good ? exit_code::done : exit_code::run_failed;
}
}  // namespace

Act certify_verb(CLI::App& program) {
    Verb<CertifyRequest> v(program, "certify",
                           "how well the reference solution of a scene is known");
    v.scene(v.r.scene);
    v.set(v.r.set);
    v.modes(v.r.modes);
    v.option("--duration", v.r.duration, seconds,
             "in place of the scene's; compare uses a certificate as far as it reaches");
    v.option("--tap-rate", v.r.tap_rate, hertz,
             "rows per second that are compared; 44100 where absent");
    v.option("--out", v.r.out, {"FILE"},
             "the file, .json; results/certificates/<scene>.json where absent, with part of the "
             "scene's hash in its name where --set "
             "changes the scene. What a clock measured goes beside it, to .cost.json");
    return v.does(certify_command,
                  "Example: jvari certify tanpura_c3_release --duration 0.1\n"
                  "\n"
                  "Every reference that represents the scene runs, the best one at two settings of "
                  "its accuracy; where there is none, the best "
                  "scheme\n"
                  "at 16, 32 and 64 tap rates, with its own estimate. The table says, pair by "
                  "pair, how far they are apart and for how long they\n"
                  "agree. compare and suite print these figures with their errors: an error below "
                  "them is shown as \"\u2264\" the figure, but for a scheme in place of a "
                  "reference.");
}

}  // namespace jvari::bench::command
