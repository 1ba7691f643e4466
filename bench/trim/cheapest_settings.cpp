#include "bench/trim/cheapest_settings.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "bench/compare/variants.hpp"
#include "bench/store/records.hpp"
#include "scenes/modes.hpp"
#include "schemes/contact/compliance.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::trim {

namespace {
constexpr double fewer = 0.7;             // from one number of modes to the next that is tried
constexpr double first_looks[] = {1, 4};  // multiples of the tap rate
// numbers of modes: from the most to a quarter of them, for more at one rate can be worse
constexpr std::size_t looked_at = 5;
}  // namespace

std::string Variant::name() const {
    return store::variant_name(scheme->name, store::options_text(options));
}

std::vector<Variant> variants_of(const Descriptor& d, const Scene& scene,
                                 const std::vector<compare::SchemeOption>& options) {
    std::vector<Variant> all;
    std::vector<bool> used(options.size());
    for (const OptionValues& asked : compare::asked_of(options, d, used)) {
        all.push_back({&d, asked});
        const bool named = compare::sets(asked, compliance_option);
        if (named || !declares(d, compliance_option.name) || !compare::touched(scene)) continue;
        Variant matched = all.back();
        matched.options.emplace_back(compliance_option.name, "matched");
        all.push_back(matched);
        const bool profile =
            declares(d, profile_points_option.name) && needed_by(scene).any(any_profile);
        if (!profile || compare::sets(asked, profile_points_option)) continue;
        for (const char* points : {"8", "4"})
            all.emplace_back(matched).options.emplace_back(profile_points_option.name, points);
    }
    return all;
}

CheapestSettings::CheapestSettings(Judge& judge, const std::vector<int>& starts,
                                   const store::Listener& listener)
    : judge_(judge),
      starts_(starts),
      progress_(listener.begin("trim")),
      tap_rate_(judge.tap_rate()) {}

std::optional<double> CheapestSettings::error_within(const Model& m, double limit) {
    double worst = 0;
    for (const int s : starts_) {
        const Verdict v = judged(m, s, limit);
        if (!judge_.within(v, s)) return std::nullopt;
        worst = std::max(worst, v.error);
    }
    return worst;
}

Verdict CheapestSettings::judged(const Model& m, int start, double limit) {
    const double seconds =
        std::min(longest, judged_over_timed * limit * judge_.scene().duration + 0.01);
    Verdict v = judge_.verdict(m, start, seconds);
    if (start == starts_.front() && m.left_out.empty() && m.settings.options.empty() &&
        v.status == "ok" && v.error < nearest_error_)
        nearest_ = m, nearest_error_ = v.error;
    progress_->show(std::min(0.99, 1 - 1 / (1 + judge_.judged() / 500.0)),
                    fmt::format("{} models judged, {} read back; {}", judge_.judged(),
                                judge_.read_back(), best_said_));
    return v;
}

// From few modes to many, the fewest that serve; beyond `limit` it gives up.
std::optional<Found> CheapestSettings::fewest(const Variant& v, const std::vector<int>& left_out,
                                              double rate, double limit, bool& too_dear) {
    Model m{left_out, v.scheme, {rate, tap_rate_, 0, v.options}};
    int last = 0;
    const std::vector<int> rungs = ladder(m);
    for (const int modes : rungs) {
        m.settings.modes = modes;
        if (auto error = error_within(m, limit)) {
            Model x = m;
            // between the last that failed and the first that serves
            while (last > 0 && m.settings.modes - last > 1) {
                x.settings.modes = (last + m.settings.modes) / 2;
                if (const auto e = error_within(x, limit)) m = x, error = e;
                else last = x.settings.modes;
            }
            return Found{m, *error, judge_.cost(m)};
        }
        last = modes;
        const Verdict failed = judged(m, starts_.front(), limit);
        if (failed.status == "slow" ||
            failed.seconds > judged_over_timed * limit * judge_.scene().duration) {
            // with more modes or at a higher rate it is dearer still
            too_dear = modes == rungs.front();
            return std::nullopt;
        }
    }
    return std::nullopt;
}

std::optional<Found> CheapestSettings::of_variant(const Variant& v,
                                                  const std::vector<int>& left_out, double from,
                                                  double to, double limit) {
    std::optional<Found> best;
    int dearer = 0;
    for (const int k : multiples) {
        const double rate = k * tap_rate_;
        if (rate < from || rate > to) continue;
        bool too_dear = false;
        const auto found = fewest(v, left_out, rate, limit, too_dear);
        if (too_dear) break;
        if (!found) continue;
        if (best && !found->better_than(*best)) {
            if (++dearer == 2) break;
            continue;
        }
        dearer = 0;
        best = found;
        limit = std::min(limit, best->cost);
    }
    return best;
}

std::vector<CheapestSettings::Look> CheapestSettings::looked(const std::vector<Variant>& variants,
                                                             const std::vector<int>& left_out,
                                                             double limit) {
    std::vector<Look> looks;
    for (const Variant& v : variants) {
        Look look{v, HUGE_VAL};
        std::vector<double> errors;  // at the rates where nothing but the error speaks against it
        for (const double k : first_looks) {
            Model m{left_out, v.scheme, {k * tap_rate_, tap_rate_, 0, v.options}};
            const std::vector<int> rungs = ladder(m);
            double least = HUGE_VAL;
            for (std::size_t n = rungs.size();
                 n-- > 0 && rungs.size() - n <= looked_at && look.cost == HUGE_VAL;) {
                m.settings.modes = rungs[n];
                const Verdict seen = judged(m, starts_.front(), limit);
                if (judge_.within(seen, starts_.front()))
                    look.cost = seen.seconds / judge_.scene().duration;
                if (seen.status == "ok") least = std::min(least, seen.error);
            }
            if (look.cost < HUGE_VAL) break;
            if (least < HUGE_VAL) errors.push_back(least);
        }
        limit = std::min(limit, look.cost);
        if (look.cost == HUGE_VAL && errors.size() == std::size(first_looks) &&
            hopeless(errors[0], errors[1])) {
            passed_over_[v.name()] = fmt::format(
                "{} ({} at {:g} Hz, {} at {:g} Hz)", v.name(),
                text_of(*judge_.target().measure, errors[0]), first_looks[0] * tap_rate_,
                text_of(*judge_.target().measure, errors[1]), first_looks[1] * tap_rate_);
            continue;
        }
        looks.push_back(look);
    }
    std::ranges::stable_sort(looks, {}, &Look::cost);
    return looks;
}

bool CheapestSettings::hopeless(double low, double high) const {
    // the order seen
    const double fall =
        std::max(0.0, std::log2(low / high)) / std::log2(first_looks[1] / first_looks[0]);
    const double octaves = std::log2(multiples.back() / first_looks[1]);
    return high * std::exp2(-2 * fall * octaves) > judge_.target().most;
}

std::optional<Found> CheapestSettings::of_all(const std::vector<const Descriptor*>& schemes,
                                              const std::vector<int>& left_out, double limit) {
    const Scene scene = judge_.scene_of({left_out, nullptr, {}});
    std::vector<Variant> variants;
    for (const Descriptor* d : schemes)
        if (represents(*d, scene))
            for (const Variant& v : variants_of(*d, scene, judge_.options())) variants.push_back(v);
    return of_variants(variants, left_out, limit);
}

std::optional<Found> CheapestSettings::as_published(const std::vector<const Descriptor*>& schemes,
                                                    bool& within) {
    std::vector<Variant> variants;
    for (const Descriptor* d : schemes)
        if (represents(*d, judge_.scene())) variants.push_back({d, {}});
    const auto found = of_variants(variants, {}, HUGE_VAL);
    within = found.has_value();
    if (found || !nearest_) return found;
    return Found{*nearest_, judge_.worst_error(*nearest_, starts_), judge_.cost(*nearest_)};
}

std::optional<Found> CheapestSettings::of_variants(const std::vector<Variant>& variants,
                                                   const std::vector<int>& left_out, double limit) {
    std::optional<Found> best;
    for (const Look& look : looked(variants, left_out, limit)) {
        const auto found = of_variant(look.variant, left_out, 0, HUGE_VAL, limit);
        if (!found || (best && !found->better_than(*best))) continue;
        best = found;
        limit = std::min(limit, best->cost);
        best_said_ = fmt::format("{:.3g} s per s so far", best->cost);
    }
    return best;
}

// From few modes to the most that are sought; {0} where the scheme takes its own.
std::vector<int> CheapestSettings::ladder(const Model& m) const {
    const Scene scene = judge_.scene_of(m);
    const double rate = m.settings.sample_rate;
    const auto dofs = [&](int modes) {
        return compare::dofs_with(modes, *m.scheme, scene, m.settings);
    };
    const int all = compare::most_modes_sought(
        scene, std::max(1, modes_for(scene, {rate, tap_rate_, 0, {}})), rate);
    if (dofs(all) == dofs(std::max(1, all / 2)) && dofs(all) > 0) return {0};
    std::vector<int> modes;
    for (double n = all; n >= 2; n *= fewer) modes.push_back(static_cast<int>(std::lround(n)));
    std::ranges::reverse(modes);
    // it has a number of its own, as one whose nodes are points of contact
    if (dofs(0) > 0 && dofs(0) != dofs(all)) modes.push_back(0);
    return modes;
}

std::vector<std::string> CheapestSettings::passed_over() const {
    std::vector<std::string> all;
    for (const auto& [name, said] : passed_over_) all.push_back(said);
    return all;
}

}  // namespace jvari::bench::trim
