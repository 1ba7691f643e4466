#include "bench/trim/search.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "bench/trim/cheapest_settings.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::trim {

namespace {
struct Candidate {
    int part;
    // saved: in twentieths of the cost; what is less a clock cannot tell, and then the error
    // decides
    double saved_per_error, error;
};

// The parts that may be left out or put back, in the order in which they are tried: what saves most
// for the error that it costs goes first, what is put back or not within at these settings last.
std::vector<Candidate> candidates(CheapestSettings& s, const Found& now) {
    std::vector<Candidate> order;
    for (int k = 0; k < static_cast<int>(s.judge().reductions().size()); ++k) {
        if (!s.judge().may_go(k)) continue;
        const Model m = toggled(now.model, k);
        Candidate c{k, -1, HUGE_VAL};
        try {
            if (const auto e = s.error_within(m, now.cost);
                e && m.left_out.size() > now.model.left_out.size()) {
                const double saved =
                    std::max(0.0, std::floor((1 - s.judge().cost(m) / now.cost) / (1 - worth)));
                c = {k, saved / std::max(1e-3 * s.judge().target().most, *e - now.error), *e};
            }
        } catch (const std::exception&) {
            continue;  // what is left makes no scene
        }
        order.push_back(c);
    }
    std::ranges::stable_sort(order, [](const Candidate& a, const Candidate& b) {
        return a.saved_per_error > b.saved_per_error ||
               (a.saved_per_error == b.saved_per_error && a.error < b.error);
    });
    return order;
}

// Step 2: toggles of single parts, settings sought anew, until none is cheaper.
void descend(CheapestSettings& s, Found& now, Path& path, const store::Listener& listener) {
    for (bool cheaper = true; cheaper;) {
        cheaper = false;
        for (const Candidate& c : candidates(s, now)) {
            const double rate = now.model.settings.sample_rate;
            const std::vector<int> left_out = toggled(now.model, c.part).left_out;
            const auto found = s.of_variant({now.model.scheme, now.model.settings.options},
                                            left_out, rate / 2, rate * 2, worth * now.cost);
            if (!found || found->cost > worth * now.cost) continue;
            const bool gone = left_out.size() > now.model.left_out.size();
            if (gone && !s.judge().saves(found->model, now.model)) continue;
            const std::string said = s.judge().reductions()[c.part].said();
            now = *found;
            path.steps.push_back(
                {gone ? said : "put back: " + said, now.model, now.error, now.cost, true});
            listener.note(
                fmt::format("{}: {}", path.steps.back().change, now.model.settings_text()));
            cheaper = true;
            break;
        }
    }
}
}  // namespace

Path search(Judge& judge, const std::vector<const Descriptor*>& schemes,
            const std::vector<int>& starts, const store::Listener& listener) {
    Path path;
    CheapestSettings s(judge, starts, listener);
    for (const Descriptor* d : schemes)
        if (represents(*d, judge.scene())) path.tried.emplace_back(d->name);
    if (path.tried.empty())
        throw Refusal("no scheme represents scene " + judge.scene().name + ": it needs " +
                      names_of(needed_by(judge.scene())));
    bool within = false;
    if (const auto first = s.as_published(schemes, within))
        path.steps.push_back({"the whole scene, compliance its own", first->model, first->error,
                              first->cost, within});
    std::vector<int> unheard;  // taps that nobody judges: the motion is the same without them
    for (int k = 0; k < static_cast<int>(judge.reductions().size()); ++k)
        if (judge.reductions()[k].part == Part::tap && judge.may_go(k)) unheard.push_back(k);
    const auto whole = s.of_all(schemes, unheard, HUGE_VAL);
    path.passed_over = s.passed_over();
    if (!whole) return path;
    Found now = *whole;
    path.steps.push_back(
        {"taps that are not judged, scheme, rate and modes", now.model, now.error, now.cost, true});
    listener.note(
        fmt::format("the whole scene: {}, {:.3g} s per s", now.model.settings_text(), now.cost));
    for (;;) {
        descend(s, now, path, listener);
        const auto again = s.of_all(schemes, now.model.left_out, worth * now.cost);
        if (!again || again->cost > worth * now.cost) break;
        now = *again;
        path.steps.push_back(
            {"scheme, rate and modes once more", now.model, now.error, now.cost, true});
    }
    path.found = true;
    return path;
}

}  // namespace jvari::bench::trim
