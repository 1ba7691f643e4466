#include "bench/suite/facet.hpp"

#include <fmt/core.h>

#include <cmath>
#include <map>
#include <numbers>

#include "analysis/ensemble.hpp"
#include "bench/store/cell_rows.hpp"
#include "bench/store/system/memo.hpp"
#include "reference/certificate.hpp"
#include "reference/references.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/run.hpp"

namespace jvari::bench::suite {

namespace {
using Runs = std::vector<std::vector<Trait>>;

// From -1 to 1, evenly and no value twice (the golden ratio's multiples).
double start(int k) {
    const double turns = k * (std::numbers::phi - 1);
    return 2 * (turns - std::floor(turns)) - 1;
}

// Strings that no body moves do not act on each other: runs of one string are one scene of many, which a scheme may advance together.
Runs runs_of(const Descriptor& d, const Scene& scene, const Settings& settings, int tap, int first) {
    std::vector<Scene> starts;
    for (int k = first; k < first + ensemble_runs; ++k) {
        starts.push_back(moved(scene, 1 + ensemble_spread * start(k)));
        starts.back().taps = {scene.taps[tap]};
    }
    if (scene.strings.size() == 1 && !needed_by(scene).has(Feature::moving_body)) {
        Scene all = starts.front();
        for (int k = 1; k < ensemble_runs; ++k) {
            all.strings.push_back(starts[k].strings.front());
            all.taps.push_back(all.taps.front());
            all.taps.back().string = k;
        }
        all.taps.front().string = 0;
        starts = {all};
    }
    Runs runs;
    for (const Scene& s : starts) {
        const jvari::Run r = run(d, s, settings);
        if (r.status.outcome != Outcome::ok) return {};
        for (int k = 0; k < r.trace.taps(); ++k) runs.push_back(traits_of(r.trace.column(k), settings.tap_rate));
    }
    return runs;
}

}  // namespace

store::Table ensemble_rows(const MeasuredCell& c) {
    store::Table t;
    t.columns = {"kind", "where", "reference", "candidate", "p", "apart"};
    const Descriptor* reference = best_reference(c.scene);
    if (!reference) return t;
    const Settings settings = beside(c, *reference);
    static store::Memo<Runs> references;  // all cells of a scene share theirs
    const std::string key = fmt::format("{} {} {} {} {} {}", reference->name, scene_hash(c.scene), settings.tap_rate, settings.modes, c.tap,
                                        store::options_text(settings.options));
    const Runs& theirs = references.get(key, [&] { return runs_of(*reference, c.scene, settings, c.tap, 0); });
    const Runs mine = runs_of(c.scheme, c.scene, c.settings, c.tap, ensemble_runs);
    int apart = 0;
    for (const Told& told : told_apart(mine, theirs)) {
        apart += told.apart;
        t.rows.push_back({told.reference.kind, store::text_of(told.reference.where), store::text_of(told.reference.value),
                          store::text_of(told.candidate), store::text_of(told.p), told.apart ? "1" : "0"});
    }
    if (!t.rows.empty()) t.rows.insert(t.rows.begin(), {"any", "", "", "", "", std::to_string(apart)});
    return t;
}

std::string ensemble_text(const store::Table& rows) {
    store::Table any = rows;
    std::erase_if(any.rows, [k = any.column("kind")](const auto& row) { return row[k] != "any"; });
    std::string text;
    for (const store::Rows& series : store::alike(any, store::all_rows(any), store::naming_columns(any))) {
        std::map<double, bool> same;  // by rate
        for (const std::size_t i : series) same[any.number(i, "rate")] = any.number(i, "apart") == 0;
        double from = std::nan("");
        for (auto it = same.rbegin(); it != same.rend() && it->second; ++it) from = it->first;
        std::string name;
        for (const std::string& column : store::naming_columns(any))
            if (!any.at(series.front(), column).empty()) name += (name.empty() ? "" : " ") + any.at(series.front(), column);
        text += fmt::format("  {:<60} {}\n", name,
                            std::isnan(from) ? "told from the reference at the highest rate too"
                                             : fmt::format("statistically the reference from {:g} Hz on", from));
    }
    if (!text.empty()) text.pop_back();
    return text;
}

}  // namespace jvari::bench::suite
