#include "bench/trim/trim.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/compare/compare_plan.hpp"
#include "bench/store/encoding.hpp"
#include "bench/store/json.hpp"
#include "bench/store/machine.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/controls.hpp"

namespace jvari::bench::trim {

namespace {
constexpr int rounds = 7, rounds_of_needs = 5;  // rounds of timing

std::vector<const Descriptor*> schemes_of(const Request& r, const Scene& scene,
                                          const compare::Catalogue& catalogue) {
    if (r.scheme != "any") return {&catalogue.find(r.scheme)};
    std::vector<const Descriptor*> sound = catalogue.schemes;
    std::erase_if(sound, [&scene](const Descriptor* d) { return left_out_unasked(*d, scene); });
    return sound;
}

std::vector<std::string> not_tried(const Judge& judge, const Request& r, const Path& path) {
    std::vector<std::string> left{
        fmt::format("rates below {:g} Hz, at which rows are compared, and rates other than 1, 2, "
                    "4, 8, 16, 32 times it",
                    r.tap_rate),
        "references as models, and more than four times the modes below 20 kHz",
        "several parts left out at once where each alone is beyond the tolerance",
        "other values of a part than those named, stiffness by factors other than 10 and 100",
        fmt::format("what happens after {:g} s, and other starts than those named",
                    judge.scene().duration),
        fmt::format("models that need more than {:g} s of computing, or {:g} times what serves "
                    "already, for one judged run",
                    longest, judged_over_timed),
        r.options.empty()
            ? "options other than compliance=matched and with it profile_points=8 and 4"
            : "values of options other than those named, and those that trim tries by itself"};
    if (r.scheme != "any") left.push_back("schemes other than " + r.scheme);
    else left.emplace_back("controls, which are known to be wrong somewhere: each by its name");
    if (!path.passed_over.empty())
        left.push_back(fmt::format("beyond a first look, whose errors do not fall fast enough: {}",
                                   fmt::join(path.passed_over, ", ")));
    if (judge.scene().strings.front().pluck || judge.scene().strings.front().start)
        left.emplace_back("plainer excitations: they are the question");
    if (judge.target().name != "decay")
        left.emplace_back(
            "losses of string and contact left out: --of decay judges how the sound dies away, "
            "over the whole scene");
    if (judge.scene().body)
        left.emplace_back("the body: no tap is heard through it, and what moves is all left in");
    left.push_back(fmt::format(
        "schemes that do not represent the scene or what is left of it; those that do: {}",
        fmt::join(path.tried, ", ")));
    return left;
}

// Nothing if two runs give no estimate, or no rung is within.
std::optional<compare::Advice> advice_on(const Judge& judge, const Request& r,
                                         const compare::Catalogue& catalogue,
                                         const store::Listener& listener) {
    try {
        compare::AdviceRequest request{r.within, r.measure, judge.tap().name};
        if (r.scheme != "any") request.scheme = r.scheme;
        request.tap_rate = r.tap_rate;
        request.options = r.options;
        const compare::Advice a =
            compare::advise(judge.scene(), request, catalogue, listener).back();
        listener.note("advice before any reference: " + text_of(a));
        if (a.within) return a;
    } catch (const Refusal&) {
    } catch (const store::UsageError&) {}
    return std::nullopt;
}

Verified verified(Judge& judge, const Model& m, int start, bool judged_by) {
    const Judged j = judge.judged(m, start);
    return {start,
            name_of_start(judge.scene(), start),
            j.trusted() ? j.error : nan,
            judge.certificate(start),
            judge.within(j, start),
            judged_by,
            judge.certain(start)};
}

// False if the reference is no better than the tolerance: then there is no verdict.
bool fails(const Verified& v, const Target& target) {
    return !v.within && v.certificate < target.most;
}

std::vector<Need> needs_of(Judge& judge, const Model& whole, const Model& trimmed,
                           const std::vector<int>& starts) {
    std::vector<Need> needs;
    std::vector<Model> timed{whole};
    std::vector<std::size_t> timed_needs;
    std::vector<bool> gone;  // missing from the whole model already: an unjudged tap
    for (int k = 0; k < static_cast<int>(judge.reductions().size()); ++k) {
        if (!judge.may_go(k)) continue;
        const Reduction& r = judge.reductions()[k];
        const Model alone = toggled(whole, k);
        Need n{r.key,        r.becomes,    judge.worst_error(alone, starts),
               std::nan(""), std::nan(""), std::ranges::binary_search(trimmed.left_out, k),
               true};
        if (!std::isnan(n.error)) {
            n.needed = !std::ranges::all_of(
                starts, [&](int s) { return judge.within(judge.judged(alone, s), s); });
            timed.push_back(alone);
            timed_needs.push_back(needs.size());
            gone.push_back(std::ranges::binary_search(whole.left_out, k));
        }
        n.error_in_trimmed = judge.worst_error(toggled(trimmed, k), starts);
        needs.push_back(n);
    }
    const std::vector<Spread> costs = judge.costs(timed, rounds_of_needs);
    for (std::size_t k = 0; k < timed_needs.size(); ++k) {
        const double whole_cost = costs[0].median, other = costs[k + 1].median;
        needs[timed_needs[k]].saved = gone[k] ? 1 - whole_cost / other : 1 - other / whole_cost;
    }
    return needs;
}
}  // namespace

Trimmed trimmed(Judge& judge, const Request& r, const compare::Catalogue& catalogue,
                const store::Listener& listener) {
    Trimmed t{judge.scene(), judge.scene(), judge.own_duration(), {}, {}, {}, {}, {}};
    const std::optional<compare::Advice> advised = advice_on(judge, r, catalogue, listener);
    const Target& target = judge.target();
    if (!judge.certain(0))
        throw Refusal(fmt::format(
            "what is within {} cannot be decided: the uncertainty of the reference {} "
            "({}) is {}. {} --reference-modes may help",
            target.text(target.most), judge.truth(0).reference.choice.name(),
            judge.truth(0).description, target.text(judge.certificate(0), "unknown"),
            study::is_waveform(target.measure) ? "A shorter --duration or more" : "More"));
    const std::vector<const Descriptor*> schemes = schemes_of(r, judge.scene(), catalogue);
    std::vector<bool> used(r.options.size());
    for (const Descriptor* d : schemes) compare::combinations_of(r.options, *d, used);
    compare::must_be_used(r.options, used);
    for (std::vector<int> by{0};;) {
        t.path = search(judge, schemes, by, listener, advised ? &*advised : nullptr);
        t.verified.clear();
        if (!t.path.within_tolerance) break;
        for (int s = 0; s < starts; ++s)
            if (s == 0 || started(judge.scene(), s).strings != judge.scene().strings)
                t.verified.push_back(
                    verified(judge, t.last().model, s, std::ranges::count(by, s) > 0));
        const auto worst = std::ranges::max_element(t.verified, {}, [&](const Verified& v) {
            return !fails(v, target) ? -1 : std::isnan(v.error) ? HUGE_VAL : v.error;
        });
        if (!fails(*worst, target)) {
            Model whole = t.last().model;
            whole.left_out = t.path.steps[1].model.left_out;
            const bool runs = judge.judged(whole, 0).verdict < Verdict::refused;
            if (!runs) whole = t.path.steps[1].model;
            t.scene = judge.scene_of(t.last().model);
            t.needs = needs_of(judge, whole, t.last().model, by);
            break;
        }
        listener.note(
            fmt::format("started otherwise ({}) it errs by {}: that start is judged by as well",
                        worst->name, target.text(worst->error)));
        by.push_back(worst->start);
    }
    if (!t.path.steps.empty()) {
        std::vector<Model> models;
        for (const Step& step : t.path.steps) models.push_back(step.model);
        t.costs = judge.costs(models, rounds);
    }
    t.not_tried = not_tried(judge, r, t.path);
    t.judged = judge.runs();
    t.read_back = judge.read_back();
    return t;
}

namespace {
using Json = nlohmann::ordered_json;

// three digits, the precision of errors and times
store::Field rounded(double x) { return store::Field::rounded(x, 3); }

// Line of TOML, safe for any name in the text.
std::string comment(std::string text) {
    std::ranges::replace_if(
        text, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
    return "#" + text + "\n";
}

std::string within_text(const Judge& judge) {
    const Target& target = judge.target();
    return fmt::format("within {} of {} ({}), tap {}", target.text(target.most), target.name,
                       target.title, judge.tap().name);
}
}  // namespace

store::Table needs_table(const Trimmed& t) {
    store::Table table{{"part", "becomes", "error_without", "cost_saved", "needed",
                        "in_trimmed_model", "error_if_turned_round"},
                       {}};
    for (const Need& n : t.needs)
        table.rows.push_back({n.part, n.becomes.empty() ? "left out" : n.becomes, rounded(n.error),
                              rounded(n.saved), n.needed ? "yes" : "no",
                              n.left_out ? "left out" : "kept", rounded(n.error_in_trimmed)});
    return table;
}

store::Table path_table(const Trimmed& t, Judge& judge) {
    store::Table table{
        {"step", "change", "scheme", "options", "modes", "rate", "error", "certificate", "within",
         "cost_s_per_s", "cost_lower", "cost_upper", "parts_left_out", "measure", "target"},
        {}};
    for (std::size_t k = 0; k < t.path.steps.size(); ++k) {
        const Step& s = t.path.steps[k];
        table.rows.push_back(
            {k, s.change, s.model.scheme->name, store::options_text(s.model.settings.options),
             s.model.settings.modes > 0 ? store::Field(s.model.settings.modes) : store::Field(),
             s.model.settings.sample_rate, rounded(s.error), rounded(judge.certificate(0)),
             s.within ? "yes" : "no", rounded(t.costs[k].median), rounded(t.costs[k].lower),
             rounded(t.costs[k].upper), s.model.left_out.size(), judge.target().title,
             rounded(judge.target().most)});
    }
    return table;
}

std::string command_of(const Trimmed& t, const std::string& file) {
    return fmt::format("jvari run {} {}", store::shell_word(file),
                       compare::arguments_of(*t.last().model.scheme, t.last().model.settings));
}

std::string trimmed_toml(const Trimmed& t, const Judge& judge) {
    const Step &full = t.full(), &last = t.last();
    const Target& target = judge.target();
    std::string text = comment(fmt::format(" The cheapest model of {} that `jvari trim` found {}.",
                                           t.whole.name, within_text(judge)));
    text += comment("   " + command_of(t, "trimmed.toml"));
    for (const Verified& v : t.verified)
        text += comment(
            fmt::format(" Error {}, and how far the reference is certain is {}; started from {}{}.",
                        target.text(v.error), target.text(v.certificate, "unknown"), v.name,
                        !v.decided    ? ": not enough to be sure"
                        : v.judged_by ? ""
                                      : ", which the search did not know"));
    if (t.independent() == 0)
        text +=
            comment(" Every start that there is judged the search: none was left to verify it.");
    text += comment(
        fmt::format(" It costs {:.3g} s of computing per second of sound; {}, with all parts "
                    "and its own compliance, {:.3g} for an error of {}.",
                    t.costs.back().median, full.model.settings_text(), t.costs.front().median,
                    target.text(full.error)));
    text += comment("") + comment(" What went:");
    for (const int k : last.model.left_out) {
        const Reduction& r = judge.reductions()[k];
        const auto need = std::ranges::find_if(
            t.needs, [&](const Need& n) { return n.part == r.key && n.becomes == r.becomes; });
        const bool known = need != t.needs.end() && !std::isnan(need->error);
        text += comment("   " + r.description() +
                        (known ? fmt::format(" (alone: error {})", target.text(need->error)) : ""));
    }
    if (t.own_duration > t.scene.duration)
        text += comment(fmt::format("   duration = {:g} s in place of {:g} s: no more was judged",
                                    t.scene.duration, t.own_duration));
    text += "\n";
    Scene named = t.scene;
    named.name = t.whole.name + "_trimmed";
    return text + write_scene(named);
}

Json manifest_of(const Trimmed& t, Judge& judge, const Request& r) {
    Json verified = Json::array(), truths = Json::array();
    for (const Verified& v : t.verified)
        verified.push_back({{"start", v.name},
                            {"error", v.error},
                            {"certificate", v.certificate},
                            {"within", v.within},
                            {"decided", v.decided},
                            {"judged_by", v.judged_by}});
    for (int s = 0; s < std::max(1, static_cast<int>(t.verified.size())); ++s) {
        const study::Truth& truth = judge.truth(s);
        truths.push_back({{"reference", truth.reference.choice.name()},
                          {"said", truth.description},
                          {"modes", truth.reference.choice.settings.modes},
                          {"certificate", judge.certificate(s)},
                          {"floor", judge.floor(s)},
                          {"horizon_s", truth.horizon}});
    }
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
                     {"found", t.path.within_tolerance},
                     {"command", t.path.within_tolerance ? command_of(t, "trimmed.toml") : ""},
                     {"verified", verified},
                     {"truths", truths},
                     {"judged", t.judged},
                     {"read_back", t.read_back},
                     {"not_tried", t.not_tried},
                     {"trimmed", t.whole.name}});
    return manifest;
}

}  // namespace jvari::bench::trim
