#include "bench/trim/trim.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "bench/compare/variants.hpp"
#include "bench/trim/cheapest_settings.hpp"
#include "schemes/controls.hpp"

namespace jvari::bench::trim {

namespace {
constexpr int rounds = 7;

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
        "other values of a part than those named: widths between, stiffness by factors other than "
        "10 and 100",
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
    if (judge.scene().strings.front().pluck || judge.scene().strings.front().initial)
        left.emplace_back("plainer excitations: they are the question");
    if (judge.target().measure->name != "decay")
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

Verified verified(Judge& judge, const Model& m, int start, bool judged_by) {
    const Verdict v = judge.verdict(m, start);
    return {start,
            name_of_start(started(judge.scene(), start)),
            v.status == "ok" ? v.error : std::nan(""),
            judge.truth(start).certificate,
            judge.within(v, start),
            judged_by,
            judge.certain(start)};
}

// where the reference is no better than the tolerance nothing is told
bool fails(const Verified& v, const Target& target) {
    return !v.within && v.certificate < target.most;
}
constexpr int rounds_of_needs = 5;

std::vector<Need> needs_of(Judge& judge, const Model& whole, const Model& trimmed,
                           const std::vector<int>& starts) {
    std::vector<Need> needs;
    std::vector<Model> timed{whole};
    std::vector<std::size_t> timed_needs;
    std::vector<bool> gone;  // from the whole model already: a tap that is not judged
    for (int k = 0; k < static_cast<int>(judge.reductions().size()); ++k) {
        if (!judge.may_go(k)) continue;
        const Reduction& r = judge.reductions()[k];
        const Model alone = toggled(whole, k);
        Need n{r.key,
               r.becomes.empty() ? "left out" : r.becomes,
               judge.worst_error(alone, starts),
               std::nan(""),
               std::nan(""),
               std::ranges::binary_search(trimmed.left_out, k),
               true};
        if (!std::isnan(n.error)) {
            n.needed = !std::ranges::all_of(
                starts, [&](int s) { return judge.within(judge.verdict(alone, s), s); });
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
    Trimmed t{judge.scene(), judge.scene(), judge.own_duration(), {}, {}, {}, {}, {}, {}, 0, 0};
    const Measure& measure = *judge.target().measure;
    if (!judge.certain(0))
        throw Refusal(
            fmt::format("what is within {} cannot be decided: how far the reference {} ({}) is "
                        "certain is {}. A shorter "
                        "--duration or more --reference-modes may help",
                        text_of(measure, judge.target().most), judge.truth(0).reference,
                        judge.truth(0).said, certainty_text(measure, judge.truth(0).certificate)));
    const std::vector<const Descriptor*> schemes = schemes_of(r, judge.scene(), catalogue);
    std::vector<bool> used(r.options.size());
    for (const Descriptor* d : schemes) compare::asked_of(r.options, *d, used);
    compare::must_be_used(r.options, used);
    for (std::vector<int> by{0};;) {
        t.path = search(judge, schemes, by, listener);
        t.verified.clear();
        if (!t.path.found) break;
        for (int s = 0; s < starts; ++s)
            t.verified.push_back(verified(judge, t.last().model, s, std::ranges::count(by, s) > 0));
        const auto worst = std::ranges::max_element(t.verified, {}, [&](const Verified& v) {
            return !fails(v, judge.target()) ? -1 : std::isnan(v.error) ? HUGE_VAL : v.error;
        });
        if (!fails(*worst, judge.target())) {
            Model whole = t.last().model;
            whole.left_out = t.path.steps[1].model.left_out;
            if (judge.verdict(whole, 0).status == "refused") whole = t.path.steps[1].model;
            t.scene = judge.scene_of(t.last().model);
            t.needs = needs_of(judge, whole, t.last().model, by);
            break;
        }
        listener.note(
            fmt::format("started otherwise ({}) it errs by {}: that start is judged by as well",
                        worst->said, text_of(measure, worst->error)));
        by.push_back(worst->start);
    }
    for (std::size_t s = 0; s < std::max<std::size_t>(1, t.verified.size()); ++s)
        t.truths.push_back(judge.truth(static_cast<int>(s)));
    if (!t.path.steps.empty()) {
        std::vector<Model> models;
        for (const Step& step : t.path.steps) models.push_back(step.model);
        t.costs = judge.costs(models, rounds);
    }
    t.not_tried = not_tried(judge, r, t.path);
    t.judged = judge.judged();
    t.read_back = judge.read_back();
    return t;
}

}  // namespace jvari::bench::trim
