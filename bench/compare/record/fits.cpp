#include "bench/compare/record/fits.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "analysis/convergence.hpp"
#include "bench/compare/bound.hpp"
#include "bench/store/cell_rows.hpp"
#include "bench/study/elements.hpp"
#include "schemes/facts.hpp"

namespace jvari::bench::compare {

namespace {
struct Window {
    const char *column, *name;
};
constexpr Window windows[] = {{"error_l2_10ms", "10ms"}, {"error_l2_50ms", "50ms"}, {"error_l2_whole", "whole"}};

std::vector<std::string> taps_of(const store::Table& cells) {
    std::vector<std::string> taps;
    const std::string prefix = std::string(windows[0].column) + "_";
    for (const std::string& name : cells.columns)
        if (name.starts_with(prefix)) taps.push_back(name.substr(prefix.size()));
    return taps;
}
}  // namespace

store::Table convergence_of(const store::Table& cells) {
    store::Table t;
    t.columns = store::naming_columns(cells);
    const std::vector<std::string> naming = t.columns;
    for (const char* name : {"modes", "tap", "window", "order", "half_width", "points", "from_hz", "to_hz"}) t.columns.push_back(name);
    for (const store::Rows& rows : store::differing_in_rate(cells, store::all_rows(cells), naming))
        for (const std::string& tap : taps_of(cells))
            for (const Window& w : windows) {
                const Fall fall = fall_over_rates(cells, rows, std::string(w.column) + "_" + tap);
                const Order& o = fall.order;
                if (std::isnan(o.order)) continue;
                std::set<std::string> modes;
                double from = HUGE_VAL, to = 0;
                for (const std::size_t i : fall.rows) {
                    modes.insert(cells.at(i, "modes"));
                    from = std::min(from, cells.number(i, "rate"));
                    to = std::max(to, cells.number(i, "rate"));
                }
                auto& row = t.rows.emplace_back();
                for (const std::string& name : naming) row.push_back(cells.at(rows.front(), name));
                for (const std::string& field : {modes.size() == 1 ? *modes.begin() : "", tap, std::string(w.name), store::text_of(o.order),
                                                 std::isfinite(o.half_width) ? store::text_of(o.half_width) : "", std::to_string(o.points),
                                                 store::text_of(from), store::text_of(to)})
                    row.push_back(field);
            }
    return t;
}

namespace {
struct Nanoseconds {
    double median, lower, upper;  // of a step
};

// cells.csv quotes quartiles of the cost per second of sound; a step is the same share of each. Of processor time where there is one: what
// else the machine does meanwhile has no part in it.
Nanoseconds step_of(const store::Table& cells, std::size_t row) {
    const double share = cells.number(row, "ns_per_step") / cells.number(row, "cost_s_per_s");
    const bool processor = cells.column("processor_s_per_s") >= 0 && cells.number(row, "processor_s_per_s") > 0;
    const auto of = [&](const char* wall, const char* own) { return share * cells.number(row, processor ? own : wall); };
    return {of("cost_s_per_s", "processor_s_per_s"), of("cost_lower", "processor_lower"), of("cost_upper", "processor_upper")};
}

class Scaling {
public:
    explicit Scaling(const store::Table& cells) : cells_(cells) {
        naming_ = store::with_machine(cells, store::naming_columns(cells));
        std::erase(naming_, "element");
        into_.columns = naming_;
        for (const char* name : {"at", "what", "x", "ns_per_step", "ns_lower", "ns_upper", "exponent", "exponent_half_width", "extra_ns",
                                 "extra_lower", "extra_upper"})
            into_.columns.push_back(name);
    }

    void add(const store::Rows& set) {
        whole_.clear();
        changed_.clear();
        for (const std::size_t row : set)
            if (cells_.at(row, "status") == "ok" && cells_.number(row, "ns_per_step") > 0)
                (cells_.at(row, "element").empty() ? whole_ : changed_).push_back(row);
        against("modes", "modes", with(naming_, {"rate"}), "");
        for (const store::Rows& rows : store::differing_in_rate(cells_, whole_, naming_)) add_series("rate", "rate", rows, "");
        for (const std::string& key : store::swept_keys(cells_)) {
            std::vector<std::string> held = with(naming_, {"rate", "modes"});
            if (std::erase(held, key) > 0) against("contacts", ("fact_" + std::string(facts::contact_points.name)).c_str(), held, key);
        }
        for (const std::size_t row : changed_) add_element(row);
    }
    store::Table table() && { return std::move(into_); }

private:
    static std::vector<std::string> with(std::vector<std::string> names, std::initializer_list<const char*> more) {
        names.insert(names.end(), more.begin(), more.end());
        return names;
    }

    // The row's name; `varied` is a swept key that stands in x.
    std::vector<std::string> name_of_row(std::size_t row, const std::string& varied) const {
        std::vector<std::string> fields;
        for (const std::string& name : naming_) fields.push_back(name == varied ? "" : cells_.at(row, name));
        return fields;
    }

    std::string at(std::size_t row, bool rate, bool modes) const {
        std::string text = rate ? cells_.at(row, "rate") + " Hz" : "";
        if (modes) text += (text.empty() ? "" : ", ") + cells_.at(row, "modes") + " modes";
        return text;
    }

    void against(const char* what, const char* column, const std::vector<std::string>& held, const std::string& varied) {
        for (const store::Rows& rows : store::alike(cells_, whole_, held)) add_series(what, column, rows, varied);
    }

    void add_series(const std::string& what, const char* column, const store::Rows& rows, const std::string& varied) {
        std::vector<double> x, ns;
        std::set<std::string> modes;
        for (const std::size_t row : rows) {
            x.push_back(cells_.number(row, column));
            ns.push_back(step_of(cells_, row).median);
            modes.insert(cells_.at(row, "modes"));
        }
        const Order fit = observed_order(x, ns);
        if (std::isnan(fit.order)) return;  // one value of x, or none
        for (std::size_t k = 0; k < rows.size(); ++k) {
            if (!(x[k] > 0)) continue;
            const Nanoseconds step = step_of(cells_, rows[k]);
            auto& row = into_.rows.emplace_back(name_of_row(rows[k], varied));
            for (const std::string& field :
                 {at(rows[k], what != "rate", what != "modes" && modes.size() == 1), what, store::text_of(x[k]),
                  store::text_of(step.median), store::text_of(step.lower), store::text_of(step.upper), store::text_of(-fit.order),
                  std::isfinite(fit.half_width) ? store::text_of(fit.half_width) : std::string(), std::string(), std::string(),
                  std::string()})
                row.push_back(field);
        }
    }

    // The same scene, scheme, options and rate, whole; of the same modes where there are several.
    std::optional<std::size_t> whole_of(std::size_t changed) const {
        store::Rows candidates, same_modes;
        for (const std::size_t row : whole_) {
            if (name_of_row(row, "") != name_of_row(changed, "") || cells_.at(row, "rate") != cells_.at(changed, "rate")) continue;
            candidates.push_back(row);
            if (cells_.at(row, "modes") == cells_.at(changed, "modes")) same_modes.push_back(row);
        }
        const auto& found = same_modes.empty() ? candidates : same_modes;
        return found.size() == 1 ? std::optional(found.front()) : std::nullopt;
    }

    void add_element(std::size_t changed) {
        const auto whole = whole_of(changed);
        if (!whole) return;
        for (const study::Element e : study::elements()) {
            if (cells_.at(changed, "element") != change_of(e)) continue;
            const Nanoseconds step = step_of(cells_, changed), other = step_of(cells_, *whole);
            const Nanoseconds &more = is_added(e) ? step : other, &less = is_added(e) ? other : step;
            auto& row = into_.rows.emplace_back(name_of_row(changed, ""));
            for (const std::string& field :
                 {at(changed, true, true), std::string(name_of(e)), std::string(), store::text_of(step.median), store::text_of(step.lower),
                  store::text_of(step.upper), std::string(), std::string(), store::text_of(more.median - less.median),
                  store::text_of(more.lower - less.upper), store::text_of(more.upper - less.lower)})
                row.push_back(field);
        }
    }

    const store::Table& cells_;
    std::vector<std::string> naming_;  // what names a problem and a scheme, before the rate
    store::Rows whole_, changed_;      // of the set: timed rows of scenes as they are, and of scenes with an element less or more
    store::Table into_;
};
}  // namespace

store::Table scaling_of(const store::Table& cells, const std::vector<store::Rows>& sets) {
    Scaling scaling(cells);
    for (const store::Rows& set : sets) scaling.add(set);
    return std::move(scaling).table();
}

}  // namespace jvari::bench::compare
