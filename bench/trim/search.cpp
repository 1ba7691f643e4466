#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "bench/compare/compare_plan.hpp"
#include "bench/store/records.hpp"
#include "bench/trim/cheapest_settings.hpp"
#include "schemes/contact/compliance.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::trim {

namespace {
struct Candidate {
    int part;
    // saved: in twentieths of the cost. Timing cannot resolve smaller savings; then the error
    // decides.
    double saved_per_error, error;
};

// Parts to leave out or put back, in the order of trying: the largest saving per added error first.
// Parts to put back, and parts not within the tolerance at these settings, come last.
std::vector<Candidate> candidates(Judge& judge, CheapestSettings& s, const Found& now) {
    std::vector<Candidate> order;
    for (int k = 0; k < static_cast<int>(judge.reductions().size()); ++k) {
        if (!judge.may_go(k)) continue;
        const Model m = toggled(now.model, k);
        Candidate c{k, -1, HUGE_VAL};
        try {
            if (const auto e = s.error_within(m, now.cost);
                e && m.left_out.size() > now.model.left_out.size()) {
                const double saved =
                    std::max(0.0, std::floor((1 - judge.cost(m) / now.cost) / (1 - worth)));
                c = {k, saved / std::max(1e-3 * judge.target().most, *e - now.error), *e};
            }
        } catch (const std::exception&) {
            continue;  // remaining scene is impossible
        }
        order.push_back(c);
    }
    std::ranges::stable_sort(order, [](const Candidate& a, const Candidate& b) {
        return a.saved_per_error > b.saved_per_error ||
               (a.saved_per_error == b.saved_per_error && a.error < b.error);
    });
    return order;
}
}  // namespace

std::string Variant::name() const {
    return store::variant_name(scheme->name, store::options_text(options));
}

std::vector<Variant> variants_of(const Descriptor& d, const Scene& scene,
                                 const std::vector<compare::SchemeOption>& options) {
    std::vector<Variant> all;
    std::vector<bool> used(options.size());
    for (const OptionValues& values : compare::combinations_of(options, d, used)) {
        all.push_back({&d, values});
        const bool named = compare::sets(values, compliance_option);
        if (named || !declares(d, compliance_option.name) || !compare::touched(scene)) continue;
        Variant matched = all.back();
        matched.options.emplace_back(compliance_option.name, "matched");
        all.push_back(matched);
        const bool profile =
            declares(d, profile_points_option.name) && needed_by(scene).any(any_profile);
        if (!profile || compare::sets(values, profile_points_option)) continue;
        for (const char* points : {"8", "4"})
            all.emplace_back(matched).options.emplace_back(profile_points_option.name, points);
    }
    return all;
}

namespace {
std::vector<std::string> names_of_able(const std::vector<const Descriptor*>& schemes,
                                       const Scene& scene) {
    std::vector<std::string> names;
    for (const Descriptor* d : schemes)
        if (represents(*d, scene)) names.emplace_back(d->name);
    if (names.empty())
        throw Refusal("no scheme represents scene " + scene.name + ": it needs " +
                      names_of(needed_by(scene)));
    return names;
}

std::vector<int> unjudged_taps(const Judge& judge) {  // the motion is the same without them
    std::vector<int> taps;
    for (int k = 0; k < static_cast<int>(judge.reductions().size()); ++k)
        if (judge.reductions()[k].part == Part::tap && judge.may_go(k)) taps.push_back(k);
    return taps;
}
}  // namespace

Path search(Judge& judge, const std::vector<const Descriptor*>& schemes,
            const std::vector<int>& starts, const store::Listener& listener,
            const compare::Advice* advised) {
    Path path;
    CheapestSettings s(judge, schemes, starts, listener);
    path.tried = names_of_able(schemes, judge.scene());
    const auto step = [&path](const std::string& change, const Found& f, bool within = true) {
        path.steps.push_back({change, f.model, f.error, f.cost, within});
    };
    bool within = false;
    if (const auto first = s.as_published(within))
        step("the whole scene, compliance its own", *first, within);
    const std::vector<int> unheard = unjudged_taps(judge);
    std::optional<Found> now;
    if (advised) {
        const Model m{unheard, advised->scheme, advised->settings};
        if (const auto error = s.error_within(m, HUGE_VAL)) now = Found{m, *error, judge.cost(m)};
    }
    if (const auto found = s.of_all(unheard, now ? now->cost : HUGE_VAL);
        found && (!now || found->better_than(*now)))
        now = found;
    path.passed_over = s.passed_over();
    if (!now) return path;
    step("taps that are not judged, scheme, rate and modes", *now);
    listener.note(
        fmt::format("the whole scene: {}, {:.3g} s per s", now->model.settings_text(), now->cost));
    const auto cheaper = [&now](const std::optional<Found>& found) {
        return found && found->cost <= worth * now->cost;
    };
    // Step 2: toggles one part and searches the settings anew.
    const auto descend = [&] {
        for (const Candidate& c : candidates(judge, s, *now)) {
            const Settings& settings = now->model.settings;
            const std::vector<int> left_out = toggled(now->model, c.part).left_out;
            const auto found =
                s.of_variant({now->model.scheme, settings.options}, left_out,
                             settings.sample_rate / 2, settings.sample_rate * 2, worth * now->cost);
            if (!cheaper(found)) continue;
            const bool gone = left_out.size() > now->model.left_out.size();
            if (gone && !judge.saves(found->model, now->model)) continue;
            now = found;
            step((gone ? "" : "put back: ") + judge.reductions()[c.part].description(), *now);
            listener.note(
                fmt::format("{}: {}", path.steps.back().change, now->model.settings_text()));
            return true;
        }
        return false;
    };
    for (;;) {
        while (descend()) {}
        const auto again = s.of_all(now->model.left_out, worth * now->cost);
        if (!cheaper(again)) break;
        now = again;
        step("scheme, rate and modes once more", *now);
    }
    path.within_tolerance = true;
    return path;
}

}  // namespace jvari::bench::trim
