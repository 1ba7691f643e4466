#include "bench/study/reference.hpp"

#include <fmt/core.h>
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>

#include "bench/store/encoding.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/json.hpp"
#include "bench/store/machine.hpp"
#include "bench/store/records.hpp"
#include "bench/store/system/file_lock.hpp"
#include "bench/store/system/interruption.hpp"
#include "bench/store/system/side_by_side.hpp"
#include "bench/study/cell.hpp"
#include "reference/references.hpp"
#include "scenes/excitation.hpp"
#include "scenes/modes.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::study {

namespace {
ProgressOf told_to(store::Done& done) {
    return
        [&done](long rows, long of) { done = static_cast<double>(rows) / static_cast<double>(of); };
}

Run reference_run(const ReferenceChoice& choice, const Scene& scene, const ProgressOf& progress) {
    const auto make = [&] {
        return run_heard(*choice.scheme, scene, choice.settings, {.progress = progress});
    };
    if (!choice.kept) return make();
    const std::string key = run_key(*choice.scheme, scene, choice.settings);
    const auto cached = [&] { return kept_run(kept_runs_folder(), key, make); };
    return choice.kept_in.empty() ? cached() : kept_run(choice.kept_in, key, cached, 0);
}

double last_instant(const Run& r) {
    return static_cast<double>(r.trace.rows - 1) / r.trace.tap_rate;
}

// Runs a scheme at three rates, the highest at the settings in `r.choice`; keeps the run at this
// rate and the error estimate.
void run_oversampled(Reference& r, const Scene& scene, const ProgressOf& progress) {
    Settings coarsest = r.choice.settings;
    coarsest.sample_rate /= r.choice.oversampled;
    try {
        Oversampled o = oversampled(*r.choice.scheme, scene, coarsest, r.choice.oversampled,
                                    {.progress = progress});
        if (o.rate == r.choice.settings.sample_rate) {
            r.run = std::move(o.run);
            r.trust = trust_of(o, last_instant(r.run) - free_from(scene));
            return;
        }
        r.trust.missing = fmt::format("at {:.6g} Hz it {}", o.rate, name_of(o.run.status.outcome));
    } catch (const Refusal& e) { r.trust.missing = e.what(); }
    r.run = reference_run(r.choice, scene, progress);  // coarser rate failed: no estimate
}

// Sorts the schemes that may stand in by their own error estimate.
void least_error_first(std::span<ReferenceChoice> choices, const Scene& scene,
                       const ProgressOf& progress) {
    std::vector<std::pair<double, ReferenceChoice>> tried;
    for (ReferenceChoice& c : choices) {
        Settings coarsest = c.settings;
        coarsest.sample_rate /= c.oversampled;
        tried.emplace_back(
            estimate_of(*c.scheme, scene, coarsest, c.oversampled, {.progress = progress}),
            std::move(c));
    }
    std::ranges::stable_sort(tried, {}, [](const auto& t) { return t.first; });
    for (std::size_t i = 0; i < tried.size(); ++i) choices[i] = std::move(tried[i].second);
}
}  // namespace

Run run_heard(const Descriptor& d, const Scene& scene, const Settings& settings,
              const RunOptions& options) {
    Run r = run(d, heard_too(d, scene), settings, options);
    r.trace.names.resize(scene.taps.size());
    return r;
}

int modes_held(const String& s, double rate) {
    constexpr double share = 20 / 44.1;
    return std::min(modes_below(s, share * rate), modes_measured(s).value_or(most_modes));
}

int modes_to_begin_with(const Scene& scene, double tap_rate, int cells) {
    int most = 0;
    for (const String& s : scene.strings) most = std::max(most, modes_held(s, tap_rate));
    const int carried = cells > 0 ? cells : modes_for(scene, {});
    return most > 0 && carried > 0 ? std::min(most, carried) : std::max(most, carried);
}

std::vector<ReferenceChoice> references_of(const Scene& scene, const Settings& at,
                                           const Descriptor* named, const Descriptor* stand_in) {
    std::vector<ReferenceChoice> all;
    const auto add = [&](const Descriptor& d, const std::string& note) {
        const bool solver = std::ranges::any_of(references(), [&d](auto& r) { return &r == &d; });
        const bool continuous = d.clock == Clock::continuous;
        const int multiple = solver || continuous ? 0 : oversampling;
        ReferenceChoice& c = all.emplace_back(ReferenceChoice{&d, at, note, multiple, solver});
        c.settings.sample_rate *= continuous ? 0 : std::max(1, multiple);
    };
    if (named) {
        add(*named, "");
        return all;
    }
    for (const Descriptor* d : jvari::references_of(scene)) add(*d, "");
    if (!stand_in) return all;
    auto able = stand_ins(scene);
    if (able.empty()) able.push_back(stand_in);
    const std::string why = all.empty() ? "no reference represents scene " + scene.name
                                        : "no reference gets scene " + scene.name + " going";
    for (const Descriptor* scheme : able)
        add(*scheme,
            fmt::format(
                "{}: {} oversampled to {} Hz, {} times the highest rate, stands in; its "
                "error is estimated from three rates, not bounded, and errors are against a "
                "string of as many modes{}",
                why, scheme->name, oversampling * at.sample_rate, oversampling,
                able.size() > 1 ? ", and was the least of those that could" : ""));
    return all;
}

Reference run_reference(const std::vector<ReferenceChoice>& choices, const Scene& scene, int jobs,
                        const store::Listener& listener, TimeLimit limit, bool alone) {
    if (const double from = free_from(scene); from >= scene.duration && !alone)
        throw Refusal(fmt::format(
            "a pluck of {} ends at {:.6g} s, and the run at {:.6g} s: errors are measured once "
            "nothing pushes the string any "
            "more, or with a steady force, so there is nothing to measure; a --duration of {:.6g} "
            "covers the first 50 ms",
            scene.name, from, scene.duration, from + 50e-3));
    std::string refusals;
    bool ordered = false;
    std::vector<ReferenceChoice> in_turn = choices;
    for (std::size_t k = 0; k < in_turn.size(); ++k) try {
            if (in_turn[k].oversampled && k + 1 < in_turn.size() && !ordered) {
                const std::span<ReferenceChoice> rest(in_turn.begin() + static_cast<long>(k),
                                                      in_turn.end());
                store::side_by_side(
                    {1}, 1, listener, "stand-in", [&](std::size_t, store::Done& done) {
                        least_error_first(rest, scene, store::within(limit.seconds, told_to(done)));
                    });
                ordered = true;
            }
            const ReferenceChoice& choice = in_turn[k];
            Reference r{choice, {}, {}, {}};
            store::side_by_side(std::vector<double>(alone ? 1 : 2, 1), jobs, listener, "reference",
                                [&](std::size_t i, store::Done& done) {
                                    const ProgressOf progress = store::within(
                                        limit.seconds, told_to(done), limit.judged_after);
                                    if (i == 1)
                                        r.moved = reference_run(
                                            choice, moved(scene, 1 + floor_displacement), progress);
                                    else if (choice.oversampled)
                                        run_oversampled(r, scene, progress);
                                    else r.run = reference_run(choice, scene, progress);
                                });
            if (r.run.trace.rows < 2) {
                refusals += fmt::format("; {} failed at its start", choice.scheme->name);
                continue;
            }
            if (alone && r.run.status.outcome != Outcome::ok) {
                refusals +=
                    fmt::format("; {} {}", choice.scheme->name, name_of(r.run.status.outcome));
                continue;
            }
            if (!choice.oversampled && !alone)
                r.trust =
                    trust_of(scene, choice.scheme->name, choice.settings, last_instant(r.run));
            for (auto& figure : r.trust.figure)
                if (r.run.trace.columns() == r.run.trace.taps()) figure.back() = nan;  // not heard
            return r;
        } catch (const Refusal& e) {
            refusals += std::string("; ") + e.what();
        } catch (const store::PastItsLimit& e) {
            throw store::PastItsLimit(fmt::format("reference {}: {}", in_turn[k].name(), e.what()));
        }
    throw Refusal("reference: none represents scene " + scene.name + refusals);
}

namespace fs = std::filesystem;

namespace {
using Json = nlohmann::ordered_json;
// File layout: a checksum, a line of JSON, the columns in this machine's byte order.
constexpr int file_format = 3;
constexpr long most_values = 1L << 26;     // total over all columns: half a gigabyte
constexpr std::size_t checksum_size = 32;  // hexadecimal digits
}  // namespace

fs::path kept_runs_folder() {
    if (const char* set = std::getenv("JVARI_CACHE")) return set;
    if (const char* set = std::getenv("XDG_CACHE_HOME"); set && *set)
        return fs::path(set) / "jvari";
    if (const char* home = std::getenv("HOME"); home && *home)
        return fs::path(home) / ".cache" / "jvari";
    return {};
}

std::string run_key(const Descriptor& reference, const Scene& scene, const Settings& s) {
    return store::hash_of(store::compact(Json{file_format, store::run_identity(), reference.name,
                                              scene_hash(scene), store::text_of(s.sample_rate),
                                              store::text_of(s.tap_rate), s.modes, s.options}));
}

void write_run(const fs::path& path, const std::string& key, const Run& r) {
    Json facts = Json::array();
    for (const Fact& f : r.facts) facts.push_back({f.name, store::text_of(f.value), f.unit});
    const Json head{{"key", key},
                    {"outcome", name_of(r.status.outcome)},
                    {"failed_step", r.status.step},
                    {"dofs", r.dofs},
                    {"steps", r.steps},
                    {"wall_seconds", r.wall_seconds},
                    {"facts", facts},
                    {"worst_block", r.worst_block},
                    {"tap_rate", r.trace.tap_rate},
                    {"stride", r.trace.stride},
                    {"rows", r.trace.rows},
                    {"names", r.trace.names},
                    {"columns", r.trace.columns()}};
    std::string content = store::compact(head) + "\n";
    for (int k = 0; k < r.trace.columns(); ++k)
        content.append(reinterpret_cast<const char*>(r.trace.column(k).data()),
                       r.trace.column(k).size_bytes());
    store::write_fresh(path, store::hash_of(content) + content);
}

std::optional<Run> read_run(const fs::path& path, const std::string& key) noexcept {
    try {
        if (!fs::is_regular_file(path)) return std::nullopt;
        const std::string file = store::read_whole(path),
                          content = file.substr(std::min(checksum_size, file.size()));
        const auto head_size = content.find('\n');
        if (!file.starts_with(store::hash_of(content)) || head_size == std::string::npos)
            return std::nullopt;
        const Json j = store::parsed(content.substr(0, head_size));
        if (j.at("key") != key) return std::nullopt;
        Run r;
        r.status = {store::outcome_named(j.at("outcome")), store::whole<long>(j.at("failed_step"))};
        r.dofs = store::whole<int>(j.at("dofs"));
        r.steps = store::whole<long>(j.at("steps"));
        r.wall_seconds = j.at("wall_seconds");
        r.worst_block = j.at("worst_block");
        for (const Json& f : j.at("facts"))
            r.facts.push_back({f.at(0), store::number_of(f.at(1)), f.at(2)});
        Trace& t = r.trace;
        t.tap_rate = j.at("tap_rate");
        t.rows = store::whole<long>(j.at("rows"));
        t.stride = store::whole<long>(j.at("stride"));
        t.names = j.at("names").get<std::vector<std::string>>();
        if (t.stride < 1 || t.rows < 0 || t.rows > t.stride) return std::nullopt;
        const auto columns = store::whole<long>(j.at("columns"));
        if (columns != t.taps() && columns != 2 * t.taps()) return std::nullopt;
        if (columns > 0 && t.stride > most_values / columns) return std::nullopt;
        const std::size_t column = static_cast<std::size_t>(t.rows) * sizeof(double);
        if (content.size() - head_size - 1 != column * columns) return std::nullopt;
        t.tap.assign(t.stride * columns, 0.0);
        for (int k = 0; k < t.columns(); ++k)
            std::memcpy(t.tap.data() + k * t.stride,
                        content.data() + head_size + 1 + static_cast<std::size_t>(k) * column,
                        column);
        return r;
    } catch (const std::exception&) { return std::nullopt; }
}

Run kept_run(const fs::path& folder, const std::string& key, const std::function<Run()>& make,
             double least) {
    if (folder.empty()) return make();
    const fs::path path = folder / (key + ".run");
    if (auto kept = read_run(path, key)) return std::move(*kept);
    std::error_code error;
    fs::create_directories(folder, error);
    const store::FileLock lock(path, "makes " + path.string());
    if (auto kept = read_run(path, key)) return std::move(*kept);
    Run r = make();
    if (r.wall_seconds < least) return r;
    try {
        store::sweep_parts(folder);
        write_run(path, key, r);
    } catch (const std::exception&) {  // Keeping the run is only a convenience.
    }
    return r;
}

}  // namespace jvari::bench::study
