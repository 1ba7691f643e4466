// Results of a population's strings: dimensionless numbers, the outcome for each variant of a
// scheme, and the error of the advice.
//
// A string can be decided within a tolerance if the reference's uncertainty is at most half the
// tolerance. A variant solves a string if the error of a trusted cell plus the uncertainty of the
// reference is within the tolerance. Each string has exactly one outcome per variant and tolerance,
// so the outcomes add up to strings times variants.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "analysis/statistics.hpp"
#include "bench/compare/advice.hpp"
#include "bench/compare/bound.hpp"
#include "bench/compare/compare_plan.hpp"
#include "bench/store/json.hpp"
#include "bench/store/system/interruption.hpp"
#include "bench/suite/suite.hpp"
#include "scenes/excitation.hpp"
#include "scenes/modes.hpp"
#include "scenes/pitch.hpp"
#include "schemes/run.hpp"

namespace jvari::bench::suite {

namespace {
using Json = nlohmann::ordered_json;
using store::Field;

constexpr double nudge = 1e-6;        // displacement of the obstacle over the swing
constexpr double longest_nudged = 3;  // limit for each of two runs [s of processor]
// uncertainty over tolerance: a larger ratio leaves a string undecided
constexpr double known_to = 0.5;
const std::size_t whole = study::measure("error_l2_whole");

std::string percent(double x) { return fmt::format("{:.4g} %", 100 * x); }

// ---- Dimensionless numbers

double static_compliance(const String& s, double x) {  // without bending stiffness [m/N]
    return x * (s.length - x) / (s.tension * s.length);
}

// Displacement at x [m] from the string's start, or from the pluck's largest force.
double swing(const String& s, double x) {
    const auto triangle = [&](double at, double height) {
        return std::fabs(height) * std::fmin(x / at, (s.length - x) / (s.length - at));
    };
    if (s.start)
        if (const auto* mode = std::get_if<ModeShape>(&*s.start))
            return std::fabs(mode->amplitude *
                             std::sin(mode->number * std::numbers::pi * x / s.length));
    if (s.start)
        if (const auto* t = std::get_if<TriangleShape>(&*s.start))
            return triangle(t->position, t->amplitude);
    return s.pluck ? triangle(s.pluck->position,
                              s.pluck->amplitude * static_compliance(s, s.pluck->position))
                   : nan;
}

double largest_swing(const String& s) {
    double most = 0;
    for (int k = 1; k < 64; ++k) most = std::fmax(most, swing(s, s.length * k / 64));
    return most;
}

struct Contact {  // the first contact
    double position = nan, width = nan, height = nan, stiffness = nan, exponent = nan;
};
Contact contact_of(const String& s) {
    if (s.barriers.empty()) return {};
    if (const auto* b = std::get_if<LumpedBarrier>(&s.barriers.front()))
        return {b->position, b->width, b->height, b->stiffness.k, b->exponent};
    const auto& b = std::get<ProfileBarrier>(s.barriers.front());
    const double wide = b.to - b.from;
    return {b.from + wide / 2, wide, 0, b.stiffness.K * wide, b.exponent};
}

using Ratios = std::vector<std::pair<const char*, Field>>;

// Numbers of a string: f_0 and modes below 20 kHz, then ratios. First come B, Q of the first mode,
// and place and width of the first contact over the length. Next is the contact's secant stiffness
// under the string's own force, times the string's compliance there. The exponent follows, then the
// contact's distance over the string's swing past the contact, then flags for further parts.
Ratios numbers_of(const Scene& scene) {
    const String& s = scene.strings.front();
    const Modes first = modes_of(s, 1);
    const Contact c = contact_of(s);
    const double beside = static_compliance(s, c.position), past = swing(s, s.length - c.position),
                 force = past / beside,
                 secant =
                     c.stiffness * std::pow(force / c.stiffness, (c.exponent - 1) / c.exponent);
    const Features needed = needed_by(scene);
    const auto yes = [&](Features f) { return needed.any(f) ? 1 : 0; };
    const auto number = [](double x) {
        return std::isfinite(x) ? Field::rounded(x, 6).number() : x;
    };
    const auto* triangle = s.start ? std::get_if<TriangleShape>(&*s.start) : nullptr;
    return {{"f0_hz", number(pitch_of(s))},
            {"modes_below_20khz", modes_below(s, 20e3)},
            {"inharmonicity", number(inharmonicity(s))},
            {"q_first", number(first.omega0[0] / (2 * first.sigma[0]))},
            {"contact", number(c.position / s.length)},
            {"width", number(c.width / s.length)},
            {"kappa", number(std::isinf(c.stiffness) ? c.stiffness : secant * beside)},
            {"exponent", number(c.exponent)},
            {"gap", number(-c.height / past)},
            {"smoothing", number(triangle ? triangle->smoothing / s.length : nan)},
            {"contacts", s.barriers.size() + s.masses.size()},
            {"profile", yes(any_profile)},
            {"rigid", yes(any_rigid)},
            {"loss", yes(Feature::contact_loss | Feature::clipped_loss)},
            {"thread", yes(Feature::thread)},
            {"pluck", yes(Feature::pluck)}};
}

// ---- Amplification and advice

// Amplification: the relative change in the nut force over the change in the obstacle's height,
// relative to the swing. NaN if no obstacle has a height. Uses half the reference's modes.
double amplification(const Scene& scene, const study::Truth& truth) {
    study::ReferenceChoice choice = truth.reference.choice;
    if (choice.oversampled > 0) return nan;
    choice.settings.modes = std::max(1, choice.settings.modes / 2);
    choice.kept = false;
    Scene moved = scene;
    bool lowered = false;
    for (String& s : moved.strings)
        for (Barrier& b : s.barriers)
            if (auto* lumped = std::get_if<LumpedBarrier>(&b)) {
                lumped->height -= nudge * largest_swing(s);
                lowered = true;
            }
    if (!lowered) return nan;
    const auto nut = [&](const Scene& one) {
        return study::run_reference({choice}, one, 1, store::Listener(), {longest_nudged}, true)
            .run.trace;
    };
    try {
        const study::Errors e = study::errors_of(nut(moved), nut(scene), {whole}, free_from(scene));
        return e.at(0)[whole] / nudge;
    } catch (const std::exception&) { return nan; }  // refused, or too slow
}

// True error with the advised settings, over the advice's window.
double true_error(const Scene& scene, const compare::Advice& a, const Trace& reference) {
    if (a.settings.tap_rate != reference.tap_rate) return nan;
    const Run r = run(*a.scheme, scene, a.settings);
    const double from = free_from(scene), rate = reference.tap_rate;
    const auto rows = static_cast<std::size_t>(std::lround(a.window * rate)) + 1;
    const auto window = [&](const Trace& t) {
        const auto all = rows_from(t.column(0), from, rate);
        return all.first(std::min(rows, all.size()));
    };
    return study::error_of(whole, window(r.trace), window(reference), rate);
}

Json advice_on(const Scene& scene, double within, const study::Truth* truth,
               const compare::Catalogue& catalogue) {
    Json j{{"tolerance", within}};
    try {
        compare::AdviceRequest request;
        request.within = fmt::format("{:g}%", 100 * within);
        const compare::Advice a =
            compare::advise(scene, request, catalogue, store::Listener()).back();
        j = compare::json_of(a);
        if (a.scheme && truth)
            j["error"] = store::text_of(true_error(scene, a, truth->reference.run.trace));
    } catch (const std::exception& e) { j["text"] = e.what(); }
    return j;
}
}  // namespace

std::string examined(const study::Point& point, const study::Truth* truth,
                     const compare::Catalogue& catalogue) {
    Json j{{"amplification", store::text_of(truth ? amplification(point.scene, *truth) : nan)},
           {"advice", Json::array()}};
    for (const double within : compare::accuracies)
        j["advice"].push_back(advice_on(point.scene, within, truth, catalogue));
    return store::compact(j);
}

// ---- Tables

namespace {
using study::Rows;
using study::TabledCell;

struct StringOf {
    const CellSet* set = nullptr;
    Rows rows{};  // rows of the string's cells
    Json examined = Json::object();
};

double number_in(const Json& j, const char* name) {
    if (!j.contains(name)) return nan;
    return j[name].is_number()   ? j[name].get<double>()
           : j[name].is_string() ? store::number_of(j[name].get<std::string>())
                                 : nan;
}

// Uncertainty of a string's reference.
double uncertainty_of(const study::Cells& cells, const Rows& rows) {
    for (const std::size_t i : rows)
        if (const double c = cells[i].figure(whole).certificate; !std::isnan(c)) return c;
    return nan;
}
std::string within_column(double within) { return fmt::format("within_{}", within); }
bool is_decided(double uncertainty, double within) { return uncertainty <= known_to * within; }

double error_of(const TabledCell& c) {  // upper bound for a trusted cell
    return compare::trusted(c) ? compare::bound_of(c, whole).most() : nan;
}

// Outcome for a variant. refused: by all settings; failed: no run was trusted; missed: other
// settings are needed.
const char* outcome_of(const study::Cells& cells, const Rows& rows, double within,
                       double uncertainty) {
    const auto all = [&](const auto& is) { return std::ranges::all_of(rows, is); };
    if (all([&](std::size_t i) { return cells[i].status == "refused"; })) return "refused";
    if (!all([&](std::size_t i) { return !(error_of(cells[i]) <= within); })) return "solved";
    if (!is_decided(uncertainty, within)) return "undecided";
    return all([&](std::size_t i) { return !compare::trusted(cells[i]); }) ? "failed" : "missed";
}

std::string reason_of(const study::Cells& cells, const Rows& rows) {
    for (const std::size_t i : rows)
        if (!compare::trusted(cells[i]))
            return cells[i].reason.empty() ? cells[i].flags : cells[i].reason;
    return "";
}

std::vector<Field> string_row(const StringOf& s, const study::Cells& cells) {
    const double uncertainty = uncertainty_of(cells, s.rows);
    const TabledCell& first = cells[s.rows.front()];
    const bool refused =
        std::ranges::all_of(s.rows, [&](std::size_t i) { return cells[i].status == "refused"; });
    std::string outcome = refused                   ? "refused"
                          : first.reference.empty() ? "failed"
                                                    : "undecided",
                reason =
                    refused || first.reference.empty() ? first.reason : first.reference_doubling;
    for (const double within : compare::accuracies)
        if (!refused && is_decided(uncertainty, within))
            outcome = "decided within " + percent(within);
    std::vector<Field> row{s.set->drawn->name};
    for (const auto& [name, value] : numbers_of(*s.set->drawn)) row.push_back(value);
    row.insert(row.end(), {s.set->drawn->duration - free_from(*s.set->drawn), first.reference,
                           first.reference_modes, uncertainty,
                           number_in(s.examined, "amplification"), outcome, reason});
    return row;
}

// Front: a variant's cheapest cells, each more accurate than all cheaper ones.
Rows front_of(const study::Cells& cells, Rows rows) {
    std::erase_if(rows, [&](std::size_t i) {
        return !(error_of(cells[i]) < 1) || !(cells[i].processor_s_per_s > 0);
    });
    std::ranges::stable_sort(rows, {}, [&](std::size_t i) { return cells[i].processor_s_per_s; });
    double best = HUGE_VAL;
    std::erase_if(rows, [&](std::size_t i) {
        const bool behind = !(error_of(cells[i]) < best);
        best = std::fmin(best, error_of(cells[i]));
        return behind;
    });
    return rows;
}

// Outcome of the advice: true if the true error plus the reference's uncertainty is within the
// tolerance.
const char* advice_outcome(const Json& a, double within, double error, double uncertainty) {
    if (!a.value("within", false)) return "none";
    if (error + uncertainty <= within) return "true";
    return error - (std::isnan(uncertainty) ? error : uncertainty) > within ? "false" : "undecided";
}

void add_advice(store::Table& t, const StringOf& s, double uncertainty) {
    const Json advice = s.examined.value("advice", Json::array());
    for (std::size_t k = 0; k < advice.size(); ++k) {
        const Json& a = advice[k];
        const double within = compare::accuracies[k], error = number_in(a, "error");
        t.rows.push_back({s.set->drawn->name, within, a.value("scheme", ""), a.value("options", ""),
                          number_in(a, "rate"), number_in(a, "modes"), number_in(a, "estimate"),
                          error, uncertainty, advice_outcome(a, within, error, uncertainty),
                          a.value("text", "")});
    }
}

std::string counted(const store::Table& t, const std::string& column, const std::string& where,
                    const Field& is) {
    std::map<std::string, int> counts;
    for (std::size_t i = 0; i < t.rows.size(); ++i)
        if (where.empty() || t.at(i, where) == is) ++counts[t.text(i, column)];
    std::string text;
    for (const auto& [what, count] : counts)
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
    return text;
}
}  // namespace

StringTables string_tables(const Suite& suite, const study::Cells& cells,
                           const std::vector<study::Record>& records) {
    std::map<std::string, StringOf> of;
    for (const CellSet& set : suite.sets) of[set.drawn->name].set = &set;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        StringOf& s = of.at(cells[i].scene);
        s.rows.push_back(i);
        if (!records[i].beside.empty()) s.examined = store::parsed(records[i].beside);
    }
    StringTables t;
    t.strings.columns = {"string"};
    for (const auto& [name, value] : numbers_of(*suite.sets.front().drawn))
        t.strings.columns.emplace_back(name);
    for (const char* column : {"window_s", "reference", "reference_modes", "uncertainty",
                               "amplification", "outcome", "reason"})
        t.strings.columns.emplace_back(column);
    t.outcomes.columns = {"string", "scheme", "options", "error"};
    for (const double within : compare::accuracies)
        t.outcomes.columns.push_back(within_column(within));
    t.outcomes.columns.emplace_back("reason");
    t.advice.columns = {"string",   "tolerance", "scheme",      "options", "rate", "modes",
                        "estimate", "error",     "uncertainty", "outcome", "text"};
    t.fronts.columns = {"string", "scheme", "options", "rate", "modes", "error", "cost_s_per_s"};
    for (const CellSet& set : suite.sets) {
        const StringOf& s = of.at(set.drawn->name);
        if (s.rows.empty()) continue;
        const double uncertainty = uncertainty_of(cells, s.rows);
        t.strings.rows.push_back(string_row(s, cells));
        add_advice(t.advice, s, uncertainty);
        for (const Rows& rows :
             study::alike(s.rows, [&](std::size_t i) { return cells[i].variant(); })) {
            double least = nan;
            for (const std::size_t i : rows) least = std::fmin(least, error_of(cells[i]));
            const TabledCell& c = cells[rows.front()];
            auto& row = t.outcomes.rows.emplace_back(
                std::vector<Field>{c.scene, c.scheme, store::options_text(c.options), least});
            for (const double within : compare::accuracies)
                row.emplace_back(outcome_of(cells, rows, within, uncertainty));
            row.emplace_back(reason_of(cells, rows));
            for (const std::size_t i : front_of(cells, rows))
                t.fronts.rows.push_back({c.scene, c.scheme, store::options_text(c.options),
                                         cells[i].rate, cells[i].modes, error_of(cells[i]),
                                         cells[i].processor_s_per_s});
        }
    }
    t.text = fmt::format("{} strings: {}\n", t.strings.rows.size(),
                         counted(t.strings, "outcome", "", ""));
    for (const double within : compare::accuracies) {
        t.text += fmt::format("within {}: {} (strings x variants)\n", percent(within),
                              counted(t.outcomes, within_column(within), "", ""));
        if (!t.advice.rows.empty())
            t.text +=
                fmt::format("  advice: {}\n", counted(t.advice, "outcome", "tolerance", within));
    }
    return t;
}

}  // namespace jvari::bench::suite
