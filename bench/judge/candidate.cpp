#include "bench/judge/judge.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "analysis/error.hpp"
#include "bench/compare/bound.hpp"
#include "bench/compare/compare_plan.hpp"
#include "bench/compare/record/findings.hpp"
#include "bench/compare/scene_notes.hpp"
#include "bench/store/usage.hpp"
#include "bench/study/cause.hpp"
#include "reference/agreement.hpp"
#include "scenes/excitation.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"

namespace jvari::bench::judge {

namespace {
std::unique_ptr<Scheme> row_player(const Descriptor& d, const Scene&, const Settings& settings) {
    const auto& traces = static_cast<const Candidate*>(d.own)->traces;
    const auto found = traces.find(settings.sample_rate);
    if (found == traces.end())
        throw Refusal(fmt::format("{} has no trace at {:.12g} Hz", d.name, settings.sample_rate));
    return played(found->second);
}

std::string enter(Candidate candidate) {  // adds a guest; returns its path
    const std::string path = "trace " + candidate.name;
    const auto kept = std::make_shared<const Candidate>(std::move(candidate));
    Descriptor d{kept->name.c_str(), "traces of another program",
                 every_feature,      Balance::none,
                 Clock::stepped,     row_player};
    d.all_strings = true;
    d.own = kept.get();
    d.untimed = "not reported";
    try {
        add_guest({path, {d}, kept->contents, kept});
    } catch (const std::runtime_error& e) { throw store::UsageError(e.what()); }
    return path;
}

const Trace& trace_of(const study::Cell& cell) {  // for a candidate's cell
    return *static_cast<const Candidate*>(cell.scheme->own)->traces.at(cell.settings.sample_rate);
}

// Removes errors in the model that may be wrong. A trace does not say which compliance its string
// has. The trace may be closer to the scene than to a string with the same number of modes and
// their own compliance. Then the trace does not belong to such a string, and its error in the model
// is unknown.
void forget_errors_in_other_models(compare::Comparison& c) {
    const std::size_t whole = study::measure("error_l2_whole"),
                      nut = static_cast<std::size_t>(c.headline.nut);
    for (study::Record& r : c.outcome.records)
        if (is_candidate(r.cell) && !r.cell.in_model.empty() &&
            r.cell.in_model[nut][whole] > r.cell.errors[nut][whole])
            r.cell.in_model.clear();
}

std::string sentence_of(const study::Cells& cells, const study::TabledCell& cell) {
    const std::size_t headline = compare::headline_error(cells, study::all_rows(cells));
    const compare::Bound bound = compare::bound_of(cell, headline);
    std::string text = cell.run() + ": ";
    using Says = compare::Bound::Says;
    switch (bound.says()) {
        case Says::nothing: return text + "no error can be told";
        case Says::measured:
            text += fmt::format("errs by {}", compare::percent(bound.error));
            break;
        case Says::at_most:
            text +=
                fmt::format("measured error {}, {} at most, as the reference itself may err by {}",
                            compare::percent(bound.error), compare::percent(bound.most()),
                            compare::percent(bound.certificate));
            break;
        case Says::unknown:
            return text + fmt::format("cannot be judged: the reference is uncertain by {}",
                                      compare::percent(bound.certificate));
        case Says::unsure:
            text += fmt::format("differs by {} from a reference whose own uncertainty is unknown",
                                compare::percent(bound.error));
    }
    if (const double own = cell.figure(headline).in_model; std::isfinite(own))
        text += fmt::format("; {} against a string of as many modes", compare::percent(own));
    const double horizon = cell.figure(study::measure("horizon_s")).value,
                 octaves = cell.figure(study::measure("third_octave_db")).value;
    text += fmt::format(" ({}); within 10 % for {}{}", study::measures()[headline].column,
                        compare::time_text(horizon), compare::after_pluck(cell));
    return std::isfinite(octaves) ? text + fmt::format("; third octaves {:.2g} dB apart", octaves)
                                  : text;
}

// Tests whether a tap is louder in the last quarter of the trace than in the first.
bool rises(const Trace& trace, double from) {
    constexpr double louder = 1.05;
    for (int k = 0; k < trace.taps(); ++k) {
        const auto rows = rows_from(trace.column(k), from, trace.tap_rate);
        const std::size_t quarter = rows.size() / 4;
        double first = 0, last = 0;
        for (std::size_t n = 0; n < quarter; ++n)
            first += rows[n] * rows[n], last += std::pow(rows[rows.size() - 1 - n], 2);
        if (last > louder * louder * first) return true;
    }
    return false;
}

// Cause for the whole trace, because a diverged run has only its first rows. The cause at the
// headline's tap is preferred, then the first tap with a cause.
std::string cause_in(const study::Ran& ran) {
    const Scene& scene = ran.point.true_scene();
    const auto at = [&](int tap) {
        return study::cause_of(scene, trace_of(ran.cell), *ran.reference, tap, free_from(scene));
    };
    std::string text = at(study::headline_of(scene).nut);
    for (int k = 0; text.empty() && k < ran.reference->taps(); ++k)
        if (text = at(k); !text.empty()) text += fmt::format(", at its tap {}", scene.taps[k].name);
    return text;
}

// Sentence after the error. Growth is detected by comparison with the energy of the scene.
std::string cause_sentence(const study::Cell& cell, const Scene& scene) {
    constexpr double beyond_doubt = 1.05;
    const study::Summary& s = cell.summary;
    const bool diverged = cell.status() == "diverged",
               beyond = diverged || s.largest_over_bound > beyond_doubt;
    if (!cell.cause.empty() && !(beyond && cell.cause.starts_with(study::too_slowly)))
        return "it " + cell.cause;
    if (s.energy_gain > gain_allowed_unpromised)
        return fmt::format("it grows: {:.3g} of its energy is gained", s.energy_gain);
    if (!beyond) return cell.cause.empty() ? "" : "it " + cell.cause;
    return (rises(trace_of(cell), free_from(scene)) ? "it grows: " : "it is too large: ") +
           (diverged ? cell.reason +
                           ": its taps or its own energies go beyond what ten times the "
                           "energy of the scene could make"
                     : fmt::format("a tap reaches {:.3g} times what start and pluck allow",
                                   s.largest_over_bound));
}

// Distance between the trace and each scheme at the same rate, tap by tap: shows whether two
// programs compute the same.
std::string beside(const compare::Comparison& c, const study::Record& own) {
    const Trace& trace = trace_of(own.cell);
    std::string text;
    for (const study::Record& r : c.outcome.records) {
        const Settings& settings = r.cell.settings;
        if (is_candidate(r.cell) || r.cell.status() != "ok" ||
            settings.sample_rate != own.cell.settings.sample_rate)
            continue;
        const std::vector<double> apart =
            relative_l2(trace, run(*r.cell.scheme, c.scene(), settings).trace);
        text += fmt::format(
            "\n  it differs from {} by",
            store::variant_name(r.cell.scheme->name, store::options_text(settings.options)));
        for (std::size_t k = 0; k < apart.size(); ++k)
            text += fmt::format("{} {:.2g} ({})", k > 0 ? "," : "", apart[k], trace.names[k]);
    }
    return text;
}
}  // namespace

void must_be_untimed(const Descriptor& d) {
    if (!*d.untimed)
        throw store::UsageError(fmt::format(
            "cost of {}: this scheme is timed; a cost is given to one that is not", d.name));
}

void report_costs(compare::Comparison& c, const std::string& scheme, const Costs& costs) {
    for (study::Record& r : c.outcome.records) {
        const auto cost = costs.find(r.cell.settings.sample_rate);
        if (r.cell.scheme->name != scheme || !r.cell.ran() || !r.cell.needed || r.cell.added ||
            cost == costs.end())
            continue;
        const double wall = cost->second * r.cell.summary.duration;
        r.cell.clock.wall = r.cell.clock.processor = spread_of(std::vector<double>{wall});
        r.cell.settings.options.emplace_back("cost", "as_reported");
    }
}

bool is_candidate(const study::Cell& cell) { return cell.scheme->make == row_player; }

Rows rows_for(const compare::CompareRequest& request, const Scene& scene) {
    Settings settings;
    settings.tap_rate = compare::tap_rate_for(request, request.rates);
    return {settings.tap_rate, rows_of(scene, settings)};
}

compare::Comparison judge(Candidate candidate, compare::CompareRequest request,
                          const std::vector<std::string>& plugins, const store::Listener& listener,
                          study::Kept& keep) {
    request.rates.clear();
    for (const auto& [rate, trace] : candidate.traces) request.rates.push_back(rate);
    request.schemes.insert(request.schemes.begin(), candidate.name);
    request.search = false;
    const std::string name = candidate.name;
    const Costs costs = candidate.costs;
    std::vector<std::string> all = plugins;
    all.push_back(enter(std::move(candidate)));
    compare::Comparison c = compare::compare(request, compare::Catalogue(all), listener, keep,
                                             [](const study::Ran& ran, study::Record& r) {
                                                 if (is_candidate(ran.cell) && ran.reference)
                                                     r.cell.cause = cause_in(ran);
                                             });
    report_costs(c, name, costs);
    for (study::Record& r : c.outcome.records)
        if (is_candidate(r.cell) && r.cell.status() == "diverged")
            if (const std::string why = no_number_in(trace_of(r.cell)); !why.empty())
                r.cell.reason = why;
    forget_errors_in_other_models(c);
    return c;
}

std::string verdict_of(const compare::Comparison& c) {
    const study::Cells cells = compare::cells_of(c);
    std::string text;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const study::Cell& cell = c.outcome.records[i].cell;
        if (!is_candidate(cell)) continue;
        text += text.empty() ? "" : "\n";
        const std::string cause = cause_sentence(cell, c.scene());
        if (cell.status() != "diverged")
            text += sentence_of(cells, cells[i]) + (cause.empty() ? "" : "\n  " + cause) +
                    beside(c, c.outcome.records[i]);
        else if (!no_number_in(trace_of(cell)).empty()) text += cells[i].run() + ": " + cell.reason;
        else text += cells[i].run() + ": " + cause;
    }
    const std::string own = c.outcome.records.front().cell.scheme->name;
    for (const compare::Rising& r : compare::rising_with_the_rate(cells))
        if (cells[r.low].scheme == own)
            text += fmt::format("\n{} at {:g} Hz", r.text, cells[r.high].rate);
    for (const compare::ObservedOrder& o : compare::convergence_of(cells))
        if (cells[o.first].scheme == own && o.measure == study::measure("error_l2_50ms") &&
            o.tap == cells[o.first].headline_nut)
            text += fmt::format(
                "\nobserved order of convergence over 50 ms: {:.2f}{}", o.order.order,
                std::isfinite(o.order.half_width) ? fmt::format(" +- {:.2f}", o.order.half_width)
                                                  : ", of two rates");
    return text;
}

}  // namespace jvari::bench::judge
