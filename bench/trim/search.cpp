#include "bench/trim/search.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "scenes/modes.hpp"
#include "schemes/contact/compliance.hpp"

namespace jvari::bench::trim {

namespace {
constexpr double worth = 0.95;                     // what is cheaper costs less than this of what it replaces
constexpr int multiples[] = {1, 2, 4, 8, 16, 32};  // of the tap rate
constexpr double fewer = 0.7;                      // from one number of modes to the next that is tried
constexpr double longest = 10;                     // of one judged run [s]
constexpr double judged_over_timed = 4;            // a judged run is probed: it takes at most so much longer

struct Found {
    Model model;
    double error, cost;
};

struct Variant {
    const Descriptor* scheme;
    OptionValues options;
};

std::vector<Variant> variants_of(const Descriptor& d, const Scene& scene) {
    std::vector<Variant> all{{&d, {}}};
    const bool touched =
        std::any_of(scene.strings.begin(), scene.strings.end(), [](const String& s) { return s.thread || !s.barriers.empty(); });
    if (!declares(d, compliance_option.name) || !touched) return all;
    const OptionValues matched{{compliance_option.name, "matched"}};
    all.push_back({&d, matched});
    const auto with = [&](const char* name, const char* value) {
        all.push_back({&d, matched});
        all.back().options.emplace_back(name, value);
    };
    if (declares(d, "effective_modes") && !needed_by(scene).has(Feature::profile_barrier)) with("effective_modes", "8");
    if (declares(d, profile_points_option.name) && needed_by(scene).has(Feature::profile_barrier))
        for (const char* points : {"8", "4"}) with(profile_points_option.name, points);
    return all;
}

class Search {
public:
    Search(Judge& judge, int judged_starts, const store::Listener& listener)
        : judge_(judge), starts_(judged_starts), progress_(listener.begin("trim")) {}

    // The worst over the starts; nothing where one is not within. `limit`: a cost [s per s] that makes it pointless.
    std::optional<double> error_within(const Model& m, double limit) {
        double worst = 0;
        for (int s = 0; s < starts_; ++s) {
            const Verdict v = judged(m, s, limit);
            if (!judge_.within(v, s)) return std::nullopt;
            worst = std::max(worst, v.error);
        }
        return worst;
    }
    Verdict judged(const Model& m, int start, double limit) {
        const double seconds = std::min(longest, judged_over_timed * limit * judge_.scene().duration + 0.01);
        Verdict v = judge_.verdict(m, start, seconds);
        progress_->show(std::min(0.99, 1 - 1 / (1 + judge_.judged() / 500.0)),
                        fmt::format("{} models judged, {} read back; {}", judge_.judged(), judge_.read_back(), best_said_));
        return v;
    }
    double worst_error(const Model& m) {
        double worst = 0;
        for (int s = 0; s < starts_; ++s) {
            const Verdict v = judged(m, s, HUGE_VAL);
            if (v.status != "ok") return std::nan("");
            worst = std::max(worst, v.error);
        }
        return worst;
    }

    // Of one variant at one rate: the fewest modes that serve, from few to many; beyond `limit` it gives up.
    std::optional<Found> fewest(const Variant& v, const std::vector<int>& left_out, double rate, double limit, bool& too_dear) {
        Model m{left_out, v.scheme, {rate, judge_tap_rate_, 0, v.options}};
        int last = 0;
        const std::vector<int> rungs = ladder(m);
        for (const int modes : rungs) {
            m.settings.modes = modes;
            if (auto error = error_within(m, limit)) {
                Model x = m;
                while (last > 0 && m.settings.modes - last > 1) {  // between the last that failed and the first that serves
                    x.settings.modes = (last + m.settings.modes) / 2;
                    if (const auto e = error_within(x, limit)) m = x, error = e;
                    else last = x.settings.modes;
                }
                return Found{m, *error, judge_.cost(m)};
            }
            last = modes;
            const Verdict failed = judged(m, 0, limit);
            if (failed.status == "slow" || failed.seconds > judged_over_timed * limit * judge_.scene().duration) {
                too_dear = modes == rungs.front();  // with more modes or at a higher rate it is dearer still
                return std::nullopt;
            }
        }
        return std::nullopt;
    }

    // The cheapest of one variant between two multiples of the tap rate.
    std::optional<Found> cheapest(const Variant& v, const std::vector<int>& left_out, double from, double to, double limit) {
        std::optional<Found> best;
        int dearer = 0;
        for (const int k : multiples) {
            const double rate = k * judge_tap_rate_;
            if (rate < from || rate > to) continue;
            bool too_dear = false;
            const auto found = fewest(v, left_out, rate, limit, too_dear);
            if (too_dear) break;
            if (!found) continue;
            if (best && found->cost >= best->cost) {
                if (++dearer == 2) break;
                continue;
            }
            dearer = 0;
            best = found;
            limit = std::min(limit, best->cost);
        }
        return best;
    }

    std::optional<Found> cheapest_of_all(const std::vector<const Descriptor*>& schemes, const std::vector<int>& left_out, double limit) {
        std::optional<Found> best;
        const Scene scene = judge_.scene_of({left_out, nullptr, {}});
        for (const Descriptor* d : schemes) {
            if (!(needed_by(scene) - d->represents).empty()) continue;
            for (const Variant& v : variants_of(*d, scene)) {
                const auto found = cheapest(v, left_out, 0, HUGE_VAL, limit);
                if (!found || (best && found->cost >= best->cost)) continue;
                best = found;
                limit = std::min(limit, best->cost);
                best_said_ = fmt::format("{:.3g} s per s so far", best->cost);
            }
        }
        return best;
    }

    Judge& judge() { return judge_; }

private:
    // From few modes to all below 20 kHz and half the rate; {0} where the scheme takes its own.
    std::vector<int> ladder(const Model& m) const {
        const auto dofs = [&](int modes) {
            Settings s = m.settings;
            s.modes = modes;
            try {
                return make_scheme(*m.scheme, judge_.scene_of(m), s)->dofs();
            } catch (const std::exception&) {
                return -1;
            }
        };
        const int all = std::max(1, modes_for(judge_.scene_of(m), {m.settings.sample_rate, judge_tap_rate_, 0, {}}));
        if (dofs(all) == dofs(std::max(1, all / 2)) && dofs(all) > 0) return {0};
        std::vector<int> modes;
        for (double n = all; n >= 2; n *= fewer) modes.push_back(static_cast<int>(std::lround(n)));
        std::ranges::reverse(modes);
        if (dofs(0) > 0 && dofs(0) != dofs(all))
            modes.push_back(0);  // it has a number of its own, as one whose nodes are points of contact
        return modes;
    }

    Judge& judge_;
    int starts_;
    std::unique_ptr<store::Progress> progress_;
    std::string best_said_ = "none is within the tolerance yet";
    double judge_tap_rate_ = judge_.tap_rate();
};

std::vector<int> toggled(std::vector<int> set, int k) {
    const auto at = std::lower_bound(set.begin(), set.end(), k);
    if (at != set.end() && *at == k) set.erase(at);
    else set.insert(at, k);
    return set;
}

// The whole scene unasked: own compliance, all modes below 20 kHz; the cheapest rate that serves, else the nearest to the truth.
std::optional<Step> unasked(Search& s, const std::vector<const Descriptor*>& schemes) {
    std::optional<Step> best;
    const double tap_rate = s.judge().tap_rate();
    for (const Descriptor* d : schemes) {
        if (!(needed_by(s.judge().scene()) - d->represents).empty()) continue;
        for (const int k : multiples) {
            Step step{"the whole scene, unasked", {{}, d, {k * tap_rate, tap_rate, 0, {}}}};
            const Verdict v = s.judged(step.model, 0, best && best->within ? best->cost : HUGE_VAL);
            if (v.status == "slow") break;
            if (v.status != "ok") continue;
            step.error = s.worst_error(step.model);
            step.within = s.error_within(step.model, HUGE_VAL).has_value();
            if (step.within || !best || (!best->within && step.error < best->error)) {
                step.cost = s.judge().cost(step.model);
                if (!best || (step.within ? !best->within || step.cost < best->cost : !best->within)) best = step;
            }
            if (step.within) break;
        }
    }
    return best;
}

// Step 2: toggles of single parts, settings sought anew, until none is cheaper.
void descend(Search& s, Found& now, Path& path, const store::Listener& listener) {
    const int parts = static_cast<int>(s.judge().reductions().size());
    for (bool cheaper = true; cheaper;) {
        cheaper = false;
        struct Candidate {
            int part;
            double saved_per_error;
        };
        std::vector<Candidate> order;
        for (int k = 0; k < parts; ++k) {
            if (!s.judge().may_go(k)) continue;
            Model m = now.model;
            m.left_out = toggled(m.left_out, k);
            double value = -1;  // of a part that is put back, or whose leaving is not within at these settings: last
            try {
                if (const auto e = s.error_within(m, now.cost); e && m.left_out.size() > now.model.left_out.size())
                    value = (now.cost - s.judge().cost(m)) / std::max(1e-3 * s.judge().target().most, *e - now.error);
            } catch (const std::exception&) {
                continue;  // what is left makes no scene
            }
            order.push_back({k, value});
        }
        std::ranges::stable_sort(order, [](const Candidate& a, const Candidate& b) { return a.saved_per_error > b.saved_per_error; });
        for (const Candidate& c : order) {
            const double rate = now.model.settings.sample_rate;
            const std::vector<int> left_out = toggled(now.model.left_out, c.part);
            const auto found = s.cheapest({now.model.scheme, now.model.settings.options}, left_out, rate / 2, rate * 2, worth * now.cost);
            if (!found || found->cost > worth * now.cost) continue;
            const bool gone = left_out.size() > now.model.left_out.size();
            const std::string said = s.judge().reductions()[c.part].said();
            now = *found;
            path.steps.push_back({gone ? said : "put back: " + said, now.model, now.error, now.cost, true});
            listener.note(fmt::format("{}: {}", path.steps.back().change, now.model.settings_text()));
            cheaper = true;
            break;
        }
    }
}

// Step 4.
void leave_out_what_costs_nothing(Search& s, Found& now, Path& path) {
    for (bool more = true; more;) {
        more = false;
        std::optional<Found> best;
        int part = 0;
        for (int k = 0; k < static_cast<int>(s.judge().reductions().size()); ++k) {
            const Part p = s.judge().reductions()[k].part;
            if (!s.judge().may_go(k) || p == Part::contact_stiffness) continue;  // another value is no plainer
            if (std::ranges::binary_search(now.model.left_out, k)) continue;
            Model m = now.model;
            m.left_out = toggled(m.left_out, k);
            try {
                if (s.judge().scene_of(m) == s.judge().scene_of(now.model)) continue;  // it went with another
                const auto e = s.error_within(m, HUGE_VAL);
                if (!e || (best && *e >= best->error)) continue;
                const double cost = s.judge().cost(m);
                if (cost > now.cost / worth) continue;
                best = Found{m, *e, cost}, part = k;
            } catch (const std::exception&) {
                continue;
            }
        }
        if (!best) break;
        now = *best;
        path.steps.push_back({s.judge().reductions()[part].said(), now.model, now.error, now.cost, true});
        more = true;
    }
}
}  // namespace

Path search(Judge& judge, const std::vector<const Descriptor*>& schemes, int judged_starts, const store::Listener& listener) {
    Path path;
    Search s(judge, judged_starts, listener);
    for (const Descriptor* d : schemes)
        if ((needed_by(judge.scene()) - d->represents).empty()) path.tried.emplace_back(d->name);
    if (path.tried.empty())
        throw Refusal("no scheme represents scene " + judge.scene().name + ": it needs " + names_of(needed_by(judge.scene())));
    if (const auto first = unasked(s, schemes)) path.steps.push_back(*first);
    std::vector<int> unheard;  // taps that nobody judges: the motion is the same without them
    for (int k = 0; k < static_cast<int>(judge.reductions().size()); ++k)
        if (judge.reductions()[k].part == Part::tap && judge.may_go(k)) unheard.push_back(k);
    auto whole = s.cheapest_of_all(schemes, unheard, HUGE_VAL);
    if (!whole) return path;
    Found now = *whole;
    path.steps.push_back({"taps that are not judged, scheme, rate and modes", now.model, now.error, now.cost, true});
    listener.note(fmt::format("the whole scene: {}, {:.3g} s per s", now.model.settings_text(), now.cost));
    for (;;) {
        descend(s, now, path, listener);
        const auto again = s.cheapest_of_all(schemes, now.model.left_out, worth * now.cost);
        if (!again || again->cost > worth * now.cost) break;
        now = *again;
        path.steps.push_back({"scheme, rate and modes once more", now.model, now.error, now.cost, true});
    }
    leave_out_what_costs_nothing(s, now, path);
    path.found = true;
    return path;
}

}  // namespace jvari::bench::trim
