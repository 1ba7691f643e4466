// The first thing on the page: who is the cheapest at each accuracy, at which rate, at what cost and how certainly; then what the truth is,
// what was compared with what, and how busy the machine was.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/compare/bound.hpp"
#include "bench/compare/record/cheapest.hpp"
#include "bench/compare/record/spread.hpp"
#include "bench/report/chart_data.hpp"
#include "bench/report/identity.hpp"
#include "bench/report/sections/page_sections.hpp"

namespace jvari::bench::report {

namespace {
using Json = nlohmann::ordered_json;

std::string wanted(const store::Table& cheapest, std::size_t i) {
    const std::string &measure = cheapest.at(i, "measure"), goal = compare::goal_name(cheapest, i);
    if (measure == "third_octave_db") return "third octaves within " + goal;
    return "waveform within " + goal +
           (measure == "error_l2_50ms"   ? ", first 50 ms"
            : measure == "error_l2_10ms" ? ", first 10 ms"
                                         : ", whole run");
}

std::string two_digits(double x) {  // "1.4", "230"
    return fmt::format("{:g}", store::number_of(fmt::format("{:.1e}", x)));
}

std::string error_text(double error, const std::string& measure) {
    return measure == "third_octave_db" ? fmt::format("{:.2g}\u00a0dB", error) : fmt::format("{:.2g}\u00a0%", 100 * error);
}

// A row of cheapest_of: its error as it is quoted, with the uncertainty of the reference where that is more than a tenth of it.
struct Found {
    Found(const store::Table& cheapest, std::size_t i)
        : bounded(cheapest.number(i, "bound") - cheapest.number(i, "error") > 0.1 * cheapest.number(i, "error")),
          error(cheapest.number(i, bounded ? "bound" : "error")) {}
    bool bounded;
    double error;
};

// The trusted cell that comes nearest, where none is near enough.
std::string nearest_text(const store::Table& cells, const std::string& measure, compare::Controls controls) {
    double least = HUGE_VAL;
    std::size_t best = 0;
    for (std::size_t i = 0; i < cells.rows.size(); ++i)
        if (const double shown = compare::bound_of(cells, i, measure).shown(); compare::may_win(cells, i, controls) && shown < least) {
            least = shown;
            best = i;
        }
    if (!std::isfinite(least)) return "no trusted run has this error";
    return fmt::format("closest: {}, {}", store::run_name(cells, best), error_text(least, measure));
}

std::vector<Answer> answers_of(const store::Table& own, const store::Table& cheapest, compare::Controls controls) {
    std::vector<Answer> answers;
    for (std::size_t i = 0; i < cheapest.rows.size(); ++i) {
        const std::string &measure = cheapest.at(i, "measure"), &status = cheapest.at(i, "status"), &options = cheapest.at(i, "options");
        if (status != "found") {
            const bool open = status == "not_known";
            const std::string &why = cheapest.at(i, "why"), &perhaps = cheapest.at(i, "perhaps");
            answers.push_back({wanted(cheapest, i), open ? "cannot be decided" : "none", "", "", "", "",
                               open ? why + (perhaps.empty() ? "" : "; candidates: " + perhaps) : nearest_text(own, measure, controls)});
            continue;
        }
        const Found found(cheapest, i);
        const std::string &ties = cheapest.at(i, "ties"), &perhaps = cheapest.at(i, "perhaps");
        std::string certain = found.bounded ? "upper bound: includes the uncertainty of the reference" : "measured";
        if (const std::string& why = cheapest.at(i, "why"); !why.empty()) certain = why;
        if (!ties.empty()) certain += "; a tie with " + ties;
        if (!perhaps.empty()) certain += "; perhaps for less " + perhaps;
        if (const std::string& published = cheapest.at(i, "as_published"); !published.empty())
            certain += "; without matched compliance: " + published;
        const std::string name = store::variant_name(cheapest.at(i, "scheme"), options);
        answers.push_back({wanted(cheapest, i), name, cheapest.at(i, "modes"), rate_text(cheapest.number(i, "rate")),
                           (found.bounded ? "\u2264 " : "") + error_text(found.error, measure),
                           fmt::format("{:.2g} ms", 1e3 * cheapest.number(i, "cost_s_per_s")), certain,
                           identities_of({name}).front().colour});
    }
    return answers;
}

// The cheapest within 1 % of the waveform, else the first that is found: what it does, and how fast.
std::string finding_of(const std::string& scene, const store::Table& cheapest) {
    std::size_t best = cheapest.rows.size();
    for (std::size_t i = cheapest.rows.size(); i-- > 0;)
        if (cheapest.at(i, "status") == "found" && (best == cheapest.rows.size() || cheapest.number(best, "target") != 0.01)) best = i;
    if (best == cheapest.rows.size()) return "No scheme is known to be near enough on " + scene;
    const Found found(cheapest, best);
    const std::string &measure = cheapest.at(best, "measure"), &options = cheapest.at(best, "options");
    const bool matched = options.find("compliance=matched") != std::string::npos;
    const std::string rate = rate_text(cheapest.number(best, "rate"));
    const double cost = cheapest.number(best, "cost_s_per_s");
    return fmt::format("{}{} errs by {}{}{}, {} times {} than real time", cheapest.at(best, "scheme"),
                       matched ? " with matched compliance" : "", found.bounded ? "at most " : "", error_text(found.error, measure),
                       rate.empty() ? "" : " at " + rate, two_digits(cost < 1 ? 1 / cost : cost), cost < 1 ? "faster" : "slower");
}

std::string truth_text(const Results& r, const store::Table& own) {
    std::string name = own.column("reference") >= 0 && !own.rows.empty() ? own.at(0, "reference") : "", modes, until;
    try {
        const Json m = Json::parse(r.manifest);
        if (m.contains("reference")) name = m.at("reference").at("name");
    } catch (const Json::exception&) {
    }
    if (name.empty()) return "";
    const double count = own.column("reference_modes") >= 0 ? own.number(0, "reference_modes") : std::nan("");
    const double horizon = own.column("reference_horizon_s") >= 0 ? own.number(0, "reference_horizon_s") : std::nan("");
    const std::string headline = compare::headline_error(own, store::all_rows(own));
    const double certain = compare::bound_of(own, 0, headline).certificate;
    std::string text = "Reference: " + name;
    if (!std::isnan(count)) text += fmt::format(" with {:g} modes", count);
    text += std::isnan(certain) ? ". Its uncertainty is unknown"
                                : fmt::format(". Its uncertainty is {} in the first error of the table", error_text(certain, headline));
    if (!std::isnan(horizon))
        text += fmt::format(". Two reference runs whose starting points differ by 1e-12 agree within 10 % for {:.3g} s", horizon);
    return text + ".";
}

std::string machine_text(const Results& r, const store::Table& own) {
    std::string text;
    try {
        const Json m = Json::parse(r.manifest);
        if (m.contains("cpu")) text = "Timed on " + m.at("cpu").get<std::string>();
        if (m.contains("load") && m.contains("cores"))
            text += fmt::format(", {} cores, at a load of {:.2g}", m.at("cores").get<int>(), m.at("load").get<double>());
    } catch (const Json::exception&) {
    }
    const double spread = compare::median_spread(own);
    if (text.empty() || std::isnan(spread)) return "";
    return text + fmt::format("; the costs scatter by \u00b1{:.0f} % between their quartiles (median).", 100 * spread);
}

// Schemes that carry another number of modes than the reference: their error is of the cut as well.
std::string modes_text(const store::Table& own) {
    if (own.column("reference_modes") < 0 || own.rows.empty()) return "";
    const double of_reference = own.number(0, "reference_modes");
    std::set<std::string> others;
    for (std::size_t i = 0; i < own.rows.size(); ++i)
        if (const double modes = own.number(i, "modes"); own.at(i, "status") == "ok" && modes > 0 && modes != of_reference)
            others.insert(own.at(i, "scheme"));
    if (others.empty() || std::isnan(of_reference)) return "";
    std::string names;
    for (const std::string& name : others) names += (names.empty() ? "" : ", ") + name;
    return fmt::format("The reference has {:g} modes. These schemes have fewer or more, and that difference is part of their error: {}.",
                       of_reference, names);
}
}  // namespace

std::vector<Verdict> verdicts_of(const Results& r) {
    std::vector<Verdict> verdicts;
    for (const std::string& problem : distinct(r.cells, "problem")) {
        const store::Table own = rows_where(r.cells, "problem", problem);
        const store::Table cheapest = compare::cheapest_of(without_names(own), r.name, r.controls);
        Verdict v{problem, finding_of(problem, cheapest), answers_of(own, cheapest, r.controls), {}};
        std::size_t ok = 0, flagged = 0, refused = 0, left_out = 0;
        for (std::size_t i = 0; i < own.rows.size(); ++i) {
            ok += own.at(i, "status") == "ok";
            refused += own.at(i, "status") == "refused";
            left_out += own.at(i, "status") == "not_needed";
            flagged += own.at(i, "status") == "ok" && !compare::trusted(own, i);
        }
        if (v.answers.empty()) v.sentences.push_back("No scheme can be called the cheapest here: none has a cost, an error and no flag.");
        for (const std::string& text : {truth_text(r, own), modes_text(own)})
            if (!text.empty()) v.sentences.push_back(text);
        v.sentences.push_back(fmt::format(
            "{} runs succeeded{}{}{}{}.", ok == own.rows.size() ? fmt::format("All {}", ok) : fmt::format("{} of {}", ok, own.rows.size()),
            flagged ? fmt::format(", {} of them with a flag against them", flagged) : "",
            own.rows.size() > ok + refused + left_out ? fmt::format(", {} failed", own.rows.size() - ok - refused - left_out) : "",
            left_out ? fmt::format(", {} left out, because a cheaper one does as well", left_out) : "",
            refused ? fmt::format(", {} were refused", refused) : ""));
        if (const std::string machine = machine_text(r, own); !machine.empty()) v.sentences.push_back(machine);
        if (const std::string busy = compare::busy_text(own); !busy.empty()) v.sentences.push_back("Costs: " + busy + ".");
        verdicts.push_back(std::move(v));
    }
    return verdicts;
}

}  // namespace jvari::bench::report
