// Steps 1 and 3 of the search: with given parts left out, the cheapest scheme, options, rate and
// number of modes within the tolerance.
//
// The search covers up to four times the modes below 20 kHz, limited by half the rate.
//
// First, every variant (a scheme with own or matched compliance) gets a look at two rates, with the
// largest number of modes and fewer, down to a quarter. A variant is passed over under two
// conditions. Its error is beyond the tolerance at both rates. And its error would be beyond at the
// highest rate, even with twice the order seen between the two. The search then tries the others in
// the order of their costs in the first look, so that the cost limit ends expensive variants early.
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "bench/compare/compare_plan.hpp"
#include "bench/trim/trim.hpp"
#include "scenes/modes.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::trim {

inline constexpr std::array multiples{1, 2, 4, 8, 16, 32};  // multiples of the tap rate
inline constexpr double fewer = 0.7;             // ratio from one number of modes to the next
inline constexpr double first_looks[] = {1, 4};  // multiples of the tap rate
// Numbers of modes in a look, from the largest to a quarter: more modes at one rate can be worse.
inline constexpr std::size_t looked_at = 5;

struct Found {
    Model model;
    double error, cost;  // worst error over the starts; cost [s of processor per s]
    // Better: cheaper by a twentieth, a difference that timing can resolve; or at similar cost,
    // more accurate.
    bool better_than(const Found& o) const {
        return cost < worth * o.cost || (worth * cost <= o.cost && error < o.error);
    }
};

// Searches settings. `limit`: a cost [s per s] above which a model is useless.
class CheapestSettings {
public:
    CheapestSettings(Judge& judge, const std::vector<const Descriptor*>& schemes,
                     const std::vector<int>& starts, const store::Listener& listener)
        : judge_(judge), schemes_(schemes), starts_(starts), progress_(listener.begin("trim")) {}

    // Worst error over the starts; nothing if a start is not within.
    std::optional<double> error_within(const Model& m, double limit) {
        double worst = 0;
        for (const int s : starts_) {
            const Judged j = judged(m, s, limit);
            if (!judge_.within(j, s)) return std::nullopt;
            worst = std::max(worst, j.error);
        }
        return worst;
    }

    // Searches between two rates.
    std::optional<Found> of_variant(const Variant& v, const std::vector<int>& left_out, double from,
                                    double to, double limit) {
        std::optional<Found> best;
        int dearer = 0;
        for (const int k : multiples) {
            const double rate = k * judge_.tap_rate();
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

    std::optional<Found> of_all(const std::vector<int>& left_out, double limit) {
        const Scene scene = judge_.scene_of({left_out, nullptr, {}});
        std::vector<Variant> variants;
        for (const Descriptor* d : schemes_)
            if (represents(*d, scene))
                for (const Variant& v : variants_of(*d, scene, judge_.options()))
                    variants.push_back(v);
        return of_variants(variants, left_out, limit);
    }

    // Model of the whole scene without options, so with the scheme's own compliance: the cheapest
    // within the tolerance, else the nearest judged model; nothing if none was sound.
    std::optional<Found> as_published(bool& within) {
        std::vector<Variant> variants;
        for (const Descriptor* d : schemes_)
            if (represents(*d, judge_.scene())) variants.push_back({d, {}});
        const auto found = of_variants(variants, {}, HUGE_VAL);
        within = found.has_value();
        if (found || !nearest_) return found;
        return Found{*nearest_, judge_.worst_error(*nearest_, starts_), judge_.cost(*nearest_)};
    }

    // variants after a first look: "name (its errors)"
    std::vector<std::string> passed_over() const {
        std::vector<std::string> all;
        for (const auto& [name, text] : passed_over_) all.push_back(text);
        return all;
    }

private:
    double longest_run(double limit) const {  // [s] of processor
        return judged_over_timed * limit * judge_.scene().duration;
    }

    Judged judged(const Model& m, int start, double limit) {
        const Judged j = judge_.judged(m, start, std::min(longest, longest_run(limit) + 0.01));
        if (start == starts_.front() && m.left_out.empty() && m.settings.options.empty() &&
            j.trusted() && j.error < nearest_error_)
            nearest_ = m, nearest_error_ = j.error;
        progress_->show(std::min(0.99, 1 - 1 / (1 + judge_.runs() / 500.0)),
                        fmt::format("{} models judged, {} read back; {}", judge_.runs(),
                                    judge_.read_back(), best_text_));
        return j;
    }

    // Smallest number of modes within the tolerance, searched upward; gives up beyond `limit`.
    std::optional<Found> fewest(const Variant& v, const std::vector<int>& left_out, double rate,
                                double limit, bool& too_dear) {
        Model m{left_out, v.scheme, {rate, judge_.tap_rate(), 0, v.options}};
        int last = 0;
        const std::vector<int> rungs = ladder(m);
        for (const int modes : rungs) {
            m.settings.modes = modes;
            if (auto error = error_within(m, limit)) {
                Model x = m;
                // between the last failure and the first success
                while (last > 0 && m.settings.modes - last > 1) {
                    x.settings.modes = (last + m.settings.modes) / 2;
                    if (const auto e = error_within(x, limit)) m = x, error = e;
                    else last = x.settings.modes;
                }
                return Found{m, *error, judge_.cost(m)};
            }
            last = modes;
            const Judged failed = judged(m, starts_.front(), limit);
            if (std::isinf(failed.seconds) || failed.seconds > longest_run(limit)) {
                // more modes or a higher rate would cost even more
                too_dear = modes == rungs.front();
                return std::nullopt;
            }
        }
        return std::nullopt;
    }

    // Numbers of modes, ascending to the largest in the search; {0} if the scheme has its own.
    std::vector<int> ladder(const Model& m) const {
        const Scene scene = judge_.scene_of(m);
        const double rate = m.settings.sample_rate;
        const auto dofs = [&](int modes) {
            return compare::dofs_with(modes, *m.scheme, scene, m.settings);
        };
        const int all = compare::most_modes_sought(
            scene, std::max(1, modes_for(scene, {rate, judge_.tap_rate(), 0, {}})), rate);
        if (dofs(all) == dofs(std::max(1, all / 2)) && dofs(all) > 0) return {0};
        std::vector<int> modes;
        for (double n = all; n >= 2; n *= fewer) modes.push_back(static_cast<int>(std::lround(n)));
        std::ranges::reverse(modes);
        // a scheme with its own number, for example with nodes at its points of contact
        if (dofs(0) > 0 && dofs(0) != dofs(all)) modes.push_back(0);
        return modes;
    }

    std::optional<Found> of_variants(const std::vector<Variant>& variants,
                                     const std::vector<int>& left_out, double limit) {
        std::optional<Found> best;
        for (const auto& [cost, variant] : looked(variants, left_out, limit)) {
            const auto found = of_variant(*variant, left_out, 0, HUGE_VAL, limit);
            if (!found || (best && !found->better_than(*best))) continue;
            best = found;
            limit = std::min(limit, best->cost);
            best_text_ = fmt::format("{:.3g} s per s so far", best->cost);
        }
        return best;
    }

    // Costs of the judged runs [s per s], sorted, at the cheaper rate within the tolerance;
    // infinite if neither rate is within.
    std::vector<std::pair<double, const Variant*>> looked(const std::vector<Variant>& variants,
                                                          const std::vector<int>& left_out,
                                                          double limit) {
        std::vector<std::pair<double, const Variant*>> looks;
        for (const Variant& v : variants) {
            double cost = HUGE_VAL;
            std::vector<double> errors;  // errors at rates with an otherwise trusted run
            for (const double k : first_looks) {
                Model m{
                    left_out, v.scheme, {k * judge_.tap_rate(), judge_.tap_rate(), 0, v.options}};
                const std::vector<int> rungs = ladder(m);
                double least = HUGE_VAL;
                for (std::size_t n = rungs.size();
                     n-- > 0 && rungs.size() - n <= looked_at && cost == HUGE_VAL;) {
                    m.settings.modes = rungs[n];
                    const Judged seen = judged(m, starts_.front(), limit);
                    if (judge_.within(seen, starts_.front()))
                        cost = seen.seconds / judge_.scene().duration;
                    if (seen.trusted()) least = std::min(least, seen.error);
                }
                if (cost < HUGE_VAL) break;
                if (least < HUGE_VAL) errors.push_back(least);
            }
            limit = std::min(limit, cost);
            const bool both = cost == HUGE_VAL && errors.size() == std::size(first_looks);
            if (!both || !hopeless(errors[0], errors[1])) {
                looks.emplace_back(cost, &v);
                continue;
            }
            const auto at = [&](std::size_t k) {
                return fmt::format("{} at {:g} Hz", judge_.target().text(errors[k]),
                                   first_looks[k] * judge_.tap_rate());
            };
            passed_over_[v.name()] = fmt::format("{} ({}, {})", v.name(), at(0), at(1));
        }
        std::ranges::stable_sort(looks, {}, [](const auto& look) { return look.first; });
        return looks;
    }

    bool hopeless(double error_at_lower, double error_at_higher) const {
        const double order_seen = std::max(0.0, std::log2(error_at_lower / error_at_higher)) /
                                  std::log2(first_looks[1] / first_looks[0]);
        const double octaves = std::log2(multiples.back() / first_looks[1]);
        return error_at_higher * std::exp2(-2 * order_seen * octaves) > judge_.target().most;
    }

    Judge& judge_;
    const std::vector<const Descriptor*>& schemes_;
    std::vector<int> starts_;  // starts for judging
    std::unique_ptr<store::Progress> progress_;
    std::optional<Model> nearest_;  // nearest model for as_published
    double nearest_error_ = HUGE_VAL;
    std::string best_text_ = "none is within the tolerance yet";
    std::map<std::string, std::string> passed_over_;  // by variant
};

}  // namespace jvari::bench::trim
