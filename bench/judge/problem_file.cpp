#include "bench/judge/judge.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/error.hpp"
#include "bench/compare/compare_plan.hpp"
#include "bench/store/json.hpp"
#include "bench/store/machine.hpp"
#include "bench/store/usage.hpp"
#include "scenes/excitation.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/open/problem.hpp"

namespace jvari::bench::judge {

namespace {
using Json = nlohmann::ordered_json;
constexpr const char* format = "jvari problem 1";
constexpr double most_steps = 1e7;  // steps for plucks: 200 MB of text

Json numbers(const double* data, std::int64_t n) { return std::vector<double>(data, data + n); }
Json json_of(const Matrix& m) {
    if (m.rows < 0) return numbers(m.data, m.columns);
    Json rows = Json::array();
    for (std::int64_t r = 0; r < m.rows; ++r)
        rows.push_back(numbers(m.data + r * m.columns, m.columns));
    return rows;
}
Json json_of(const Words& w) { return std::vector<std::string>(w.data, w.data + w.count); }
template <class Plain>
Json json_of(const Plain& value) {
    return value;
}

Json reference_json(const Scene& scene, const study::Truth& truth) {
    const study::Reference& r = truth.reference;
    const Trace &trace = r.run.trace, &moved = r.moved.trace;
    const int nut = study::headline_of(scene).nut;
    const double from = free_from(scene);
    const auto free = [&](const Trace& t) { return rows_from(t.column(nut), from, t.tap_rate); };
    Json j{{"name", r.choice.name()},
           {"source", r.choice.scheme->source},
           {"modes", r.choice.settings.modes},
           {"doubling", truth.description},
           {"rows", trace.rows},
           {"free_from_s", from},
           {"horizon_of_1e-12_s", horizon(free(moved), free(trace), trace.tap_rate)},
           {"horizon_of_half_s", truth.horizon}};
    for (std::size_t w = 0; w < study::Trust::columns.size(); ++w) {
        if (study::measures()[w].heard) continue;  // the trace below has all modes
        const std::string window =
            std::string(study::Trust::columns[w]).substr(std::string("certificate_").size());
        Json known = Json::array();
        for (std::size_t k = 0; k < scene.taps.size(); ++k) known.push_back(r.trust.of_scene(k, w));
        j["uncertainty_" + window] = known;
    }
    Json taps = Json::array();
    for (int k = 0; k < trace.taps(); ++k)
        taps.push_back(numbers(trace.column(k).data(), trace.rows));
    j["trace"] = taps;
    return j;
}
}  // namespace

Exported exported(const compare::CompareRequest& request) {
    Exported e{compare::load_scene(request), {}};
    e.settings.sample_rate = request.rates.front();
    e.settings.tap_rate = compare::tap_rate_for(request, request.rates);
    e.settings.modes = request.modes.empty() ? 0 : request.modes.front();
    refuse_beyond_arrays(e.scene);
    if (const double ratio = e.settings.sample_rate / e.settings.tap_rate;
        !(std::abs(ratio - std::round(ratio)) < 1e-9 * ratio) || ratio < 0.5)
        throw store::UsageError(
            fmt::format("--tap-rate: found {:.12g}; {:.12g} Hz is no whole multiple of it",
                        e.settings.tap_rate, e.settings.sample_rate));
    double steps = 0;  // each step has a force for every pluck
    for (const String& s : e.scene.strings)
        if (s.pluck)
            steps += e.settings.sample_rate *
                     std::min(s.pluck->start + s.pluck->duration, e.scene.duration);
    if (steps > most_steps)
        throw store::UsageError(
            fmt::format("the pluck takes {:.2g} steps at {:.12g} Hz, and the file holds at most "
                        "{:.0e}: export at a lower rate",
                        steps, e.settings.sample_rate, most_steps));
    return e;
}

study::Truth reference_of(const compare::CompareRequest& request, const Exported& e,
                          const compare::Catalogue& catalogue, const store::Listener& listener) {
    compare::CompareRequest plain = request;
    plain.modes.clear();
    plain.search = false;
    return study::run_truth(compare::references_of(plain, catalogue, e.scene), e.scene,
                            request.reference_modes.value_or(0), request.jobs, listener);
}

std::string problem_json(const Exported& e, const study::Truth* truth) {
    const Problem problem(e.scene, e.settings);
    Json j{{"format", format},
           {"program", "jvari " + store::machine().version},
           {"scene_hash", scene_hash(e.scene)}};
    each_member(problem.arrays(),
                [&j](const char* name, const auto& value) { j[name] = json_of(value); });
    if (truth) j["reference"] = reference_json(e.scene, *truth);
    std::string text;  // one member per line
    for (const auto& [key, value] : j.items())
        text += (text.empty() ? "{\n" : ",\n") + store::compact(key) + ": " + store::compact(value);
    return text + "\n}\n";
}

}  // namespace jvari::bench::judge
