#include "bench/trim/trim_record.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/compare/bound.hpp"
#include "bench/store/json.hpp"
#include "bench/store/machine.hpp"
#include "scenes/scene_file.hpp"

namespace jvari::bench::trim {

namespace {
using Json = nlohmann::ordered_json;

std::string rounded(double x) {  // three digits: no more is known of an error or a clock
    return std::isfinite(x) ? fmt::format("{:.3g}", x) : "";
}

// a line of TOML, whatever stands in the names that it holds
std::string comment(std::string text) {
    std::ranges::replace_if(
        text, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
    return "#" + text + "\n";
}

std::string within_text(const Judge& judge) {
    return fmt::format(
        "within {} of {} ({}), tap {}", text_of(*judge.target().measure, judge.target().most),
        judge.target().measure->name, judge.target().measure->title, judge.tap().name);
}
}  // namespace

store::Table needs_table(const Trimmed& t, const Judge&) {
    store::Table table{{"part", "becomes", "error_without", "cost_saved", "needed",
                        "in_trimmed_model", "error_if_turned_round"},
                       {}};
    for (const Need& n : t.needs)
        table.rows.push_back({n.part, n.becomes, rounded(n.error), rounded(n.saved),
                              n.needed ? "yes" : "no", n.left_out ? "left out" : "kept",
                              rounded(n.error_in_trimmed)});
    return table;
}

store::Table path_table(const Trimmed& t, const Judge& judge) {
    store::Table table{
        {"step", "change", "scheme", "options", "modes", "rate", "error", "certificate", "within",
         "cost_s_per_s", "cost_lower", "cost_upper", "parts_left_out", "measure", "target"},
        {}};
    for (std::size_t k = 0; k < t.path.steps.size(); ++k) {
        const Step& s = t.path.steps[k];
        table.rows.push_back(
            {std::to_string(k), s.change, s.model.scheme->name,
             store::options_text(s.model.settings.options),
             s.model.settings.modes > 0 ? std::to_string(s.model.settings.modes) : "",
             store::text_of(s.model.settings.sample_rate), rounded(s.error),
             rounded(t.truths.front().certificate), s.within ? "yes" : "no",
             rounded(t.costs[k].median), rounded(t.costs[k].lower), rounded(t.costs[k].upper),
             std::to_string(s.model.left_out.size()), judge.target().measure->title,
             rounded(judge.target().most)});
    }
    return table;
}

std::string command_of(const Trimmed& t, const std::string& file) {
    return fmt::format("jvari run {} {}", file,
                       compare::arguments_of(*t.last().model.scheme, t.last().model.settings));
}

std::string trimmed_toml(const Trimmed& t, const Judge& judge) {
    const Step &full = t.full(), &last = t.last();
    const auto error_text = [&judge](double error) {
        return text_of(*judge.target().measure, error);
    };
    std::string text = comment(fmt::format(" The cheapest model of {} that `jvari trim` found {}.",
                                           t.whole.name, within_text(judge)));
    text += comment("   " + command_of(t, "trimmed.toml"));
    for (const Verified& v : t.verified)
        text += comment(fmt::format(
            " Error {}, and how far the reference is certain is {}; started from {}{}.",
            error_text(v.error), certainty_text(*judge.target().measure, v.certificate), v.said,
            !v.decided    ? ": not enough to be sure"
            : v.judged_by ? ""
                          : ", which the search did not know"));
    if (t.independent() == 0)
        text +=
            comment(" Every start that there is judged the search: none was left to verify it.");
    text +=
        comment(fmt::format(" It costs {} s of computing per second of sound; {}, with all parts "
                            "and its own compliance, {} for an error of {}.",
                            rounded(t.costs.back().median), full.model.settings_text(),
                            rounded(t.costs.front().median), error_text(full.error)));
    text += comment("") + comment(" What went:");
    for (const int k : last.model.left_out) {
        const Reduction& r = judge.reductions()[k];
        const auto need = std::ranges::find_if(t.needs, [&](const Need& n) {
            return n.part == r.key && (r.becomes.empty() || n.becomes == r.becomes);
        });
        const bool known = need != t.needs.end() && !std::isnan(need->error);
        text += comment("   " + r.said() +
                        (known ? fmt::format(" (alone: error {})", error_text(need->error)) : ""));
    }
    if (t.own_duration > t.scene.duration)
        text += comment(fmt::format("   duration = {:g} s in place of {:g} s: no more was judged",
                                    t.scene.duration, t.own_duration));
    text += "\n";
    Scene named = t.scene;
    named.name = t.whole.name + "_trimmed";
    return text + write_scene(named);
}

Json manifest_of(const Trimmed& t, const Judge& judge, const Request& r) {
    Json verified = Json::array(), truths = Json::array();
    for (const Verified& v : t.verified)
        verified.push_back({{"start", v.said},
                            {"error", v.error},
                            {"certificate", v.certificate},
                            {"within", v.within},
                            {"decided", v.decided},
                            {"judged_by", v.judged_by}});
    for (const Truth& x : t.truths)
        truths.push_back({{"reference", x.reference},
                          {"said", x.said},
                          {"modes", x.modes},
                          {"certificate", x.certificate},
                          {"floor", x.floor},
                          {"horizon_s", x.horizon}});
    Json manifest = store::made_by();
    manifest.update({{"suite", "trim " + t.whole.name},
                     {"source", t.whole.source},
                     {"asked",
                      {{"scene", r.scene},
                       {"within", r.within},
                       {"of", r.measure},
                       {"tap", judge.tap().name},
                       {"scheme", r.scheme},
                       {"duration", t.whole.duration}}},
                     {"found", t.path.found},
                     {"command", t.path.found ? command_of(t, "trimmed.toml") : ""},
                     {"verified", verified},
                     {"truths", truths},
                     {"judged", t.judged},
                     {"read_back", t.read_back},
                     {"not_tried", t.not_tried}});
    return manifest;
}

}  // namespace jvari::bench::trim
