// Exact reference: a string against one-sided contacts, event-driven, without a step size.
//
// Sources: van Walstijn et al. 2016, eqs 1-22 (string, thread, barrier, pluck); contact loss from
// Issanchou et al. 2016, eq 24. The string is linear, only the contact points are not. So the modes
// are touched twice a window (macro_window.hpp), and between its events a few short vectors move.
// From one event to the next the points follow
// - their free motion, if nothing touches;
// - touching_set.hpp, if linear contacts touch: a slow polynomial and one fast part per point, or a
//   polynomial if they are soft;
// - collocated_contact.hpp, step by step (contact_steps.hpp), if the law is no spring or there are
//   many contacts.
//
// crossing.hpp finds the next event and misses none. A profile acts like the points in
// profile_points.hpp. With compliance=matched the yield and radiation of the omitted modes stand in
// series with barriers and thread (in_series.hpp).
#include <algorithm>
#include <cmath>
#include <optional>

#include "reference/exact/collocated_contact.hpp"
#include "reference/exact/contact_steps.hpp"
#include "reference/exact/crossing.hpp"
#include "reference/exact/macro_window.hpp"
#include "reference/exact/pluck_series.hpp"
#include "reference/exact/touching_set.hpp"
#include "reference/exact/window_energies.hpp"
#include "reference/masses.hpp"
#include "reference/pluck_parts.hpp"
#include "reference/profile_points.hpp"
#include "reference/readout.hpp"
#include "reference/references.hpp"
#include "scenes/excitation.hpp"
#include "scenes/start.hpp"
#include "schemes/impacts.hpp"
#include "schemes/making.hpp"
#include "schemes/modal/modal_string.hpp"

namespace jvari {

namespace {
// number of contacts for which every touching set is split in advance
constexpr int most_sets_of = most_pairs / 2;
constexpr double negligible = 1e-18;
// Share of the tolerance that one window, and one step of a collocated contact, may cut off, so
// that every tap keeps the tolerance. A test on 1317 taps from 400 random lossless strings with 20
// to 60 modes over 20 ms confirms this. The only exceptions are taps that change by more if the
// start moves by 1e-11.
constexpr double window_share = 5e-4, step_share = 0.02;
constexpr double share_of(double tolerance, double share) {
    constexpr double least = 1e-14;
    return std::max(share * tolerance, std::min(tolerance, least));
}
// (Block::stopped): 1 ms for one contact in collocation; half a second for twenty
constexpr long phases_between_questions = 64;

// Largest value in [from, end]. A lossy contact pushes hardest on the way in and may pull on the
// way out. The extremes of its force are extremes of a polynomial in time. They are sought by
// samples, and by golden sections around each sample that is the largest among three.
template <class Force>
double most_in(double from, double end, const Force& force) {
    constexpr int samples = 16;
    constexpr double golden = 0.6180339887498949;
    double at[samples + 1], most = -HUGE_VAL;
    const auto sample = [&](int k) { return from + (end - from) * k / samples; };
    for (int k = 0; k <= samples; ++k) most = std::max(most, at[k] = force(sample(k)));
    for (int k = 1; k < samples; ++k) {
        if (at[k] < std::max(at[k - 1], at[k + 1])) continue;
        double low = sample(k - 1), high = sample(k + 1);
        for (int n = 0; n < 40; ++n) {
            const double a = high - golden * (high - low), b = low + golden * (high - low);
            const bool before = force(a) > force(b);
            (before ? high : low) = before ? b : a;
        }
        most = std::max(most, force(0.5 * (low + high)));
    }
    return most;
}

// [windows] A shorter phase makes no progress: in such a brief contact the penetration is below
// rounding. A run ends after a thousand of them in a row.
constexpr double least_progress = 1e-9;

struct Extremes {  // over the run so far
    double events = 0, windows = 0, steps = 0, smallest_force = HUGE_VAL, largest_force = 0,
           deepest = 0, tolerance = 0;
};

std::vector<BarrierLaw> laws_of(const Modes& modes, const String& s) {
    std::vector<BarrierLaw> laws;
    for (const auto& [b, g] : touched_by(modes, s))
        laws.push_back(
            {{b.stiffness.k, b.exponent}, b.contact_loss, b.loss_law == LossLaw::clipped});
    return laws;
}

double exponent_of(const std::vector<BarrierLaw>& laws) {  // the one farthest from a spring's
    double exponent = 1;
    for (const BarrierLaw& l : laws)
        if (std::abs(l.law.alpha - 1) > std::abs(exponent - 1)) exponent = l.law.alpha;
    return exponent;
}

// A rigid barrier is represented by a spring with 1e-8 of the compliance that the string lacks at
// the barrier; the motion errs by about this ratio. If only the kept modes meet the barrier,
// nothing but the barrier would give way.
String with_springs(String s, const Descriptor& descriptor, const std::optional<InSeries>& series) {
    constexpr double share = 1e-8;
    for (std::size_t a = 0; a < s.barriers.size(); ++a) {
        double& k = std::get<LumpedBarrier>(s.barriers[a]).stiffness.k;
        if (k != rigid) continue;
        if (!series)
            throw Refusal(std::string(descriptor.name) +
                          ": a rigid barrier needs compliance=matched, for where the modes alone "
                          "meet it nothing gives way");
        k = 1 / (share * series->C.C[a * series->points + a]);
    }
    return s;
}

class ExactContact final : public Scheme {
public:
    ExactContact(const String& s, const Scene& scene, const Modes& modes, double tap_rate,
                 double tolerance, const std::optional<InSeries>& series,
                 std::vector<int> barrier_of_each)
        : modes_(with_masses(modes, s)),
          window_(modes_, s, 1 / tap_rate, share_of(tolerance, window_share), series),
          law_(laws_of(modes_, s)),
          collocation_(window_, law_),
          spending_(window_, modes_, share_of(tolerance, window_share)),
          readout_(scene, modes_),
          parts_(s.pluck),
          tap_rate_(tap_rate),
          tolerance_(share_of(tolerance, window_share)),
          interval_(window_.per_row),
          steps_(0.1 * share_of(tolerance, step_share), exponent_of(law_)),
          barrier_(std::move(barrier_of_each)),
          falling_(falling(modes_, s)) {
        for (const auto& [b, g] : touched_by(modes_, s)) sign_.push_back(b.sign());
        mass_impulse_.resize(s.masses.size());
        if (s.pluck) pluck_.push_back(*s.pluck);
        ModalStart start = with_masses(
            start_of(modes, s, series ? Yield{{}, series->C.C, series->C.pluck} : Yield{}), modes,
            s);
        for (double& v : start.velocity) v *= window_.seconds();
        start_ = window_.osc.pad(start.displacement);
        start_u_ = window_.osc.pad(start.velocity);
        if (series) start_z_ = series->resting(start.force);
        std::vector<double> stiffness;
        for (int i = 0; i < modes_.count(); ++i)
            stiffness.push_back(modes_.mass * modes_.omega0[i] * modes_.omega0[i]);
        stiffness_ = window_.osc.pad(stiffness);
        y_ = u_ = start_;
        z_ = start_z_;
        const int contacts = window_.contacts;
        touching_.resize(contacts + 1);
        known_zero_.resize(contacts + 1);
        touched_.reserve(contacts);
        for (auto* v : {&r_, &path_, &moments_, &moment_})
            v->assign(static_cast<long>(contacts + 1) * window_.stride, 0.0);
        amplitude_.assign(2 * contacts * contacts + 1, 0.0);
        if (needed_by(scene).has(Feature::rigid_barrier))
            for (const BarrierLaw& l : law_) rigid_stiffness_ = std::max(rigid_stiffness_, l.law.k);
        const bool springs =
            std::all_of(law_.begin(), law_.end(), [](const BarrierLaw& l) { return l.spring(); });
        if (springs && contacts <= most_sets_of) {
            sets_.resize(1u << contacts);
            for (unsigned bits = 1; bits < sets_.size(); ++bits) {
                std::vector<int> points;
                std::vector<double> k;
                for (int a = 0; a < contacts; ++a)
                    if (bits >> a & 1u) points.push_back(a), k.push_back(law_[a].law.k);
                TouchingSet set(window_, points, k);
                if (set.solves()) sets_[bits] = {set, spending_.pairs_of(set)};
            }
        }
        reset();
    }
    void reset() noexcept override {
        std::copy(start_.begin(), start_.end(), y_.begin());
        std::copy(start_u_.begin(), start_u_.end(), u_.begin());
        std::copy(start_z_.begin(), start_z_.end(), z_.begin());
        readout_.begin(u_.data(), 1 / window_.seconds(), tap_rate_);
        std::fill(touching_.begin(), touching_.end(), 0);
        std::fill(known_zero_.begin(), known_zero_.end(), 0);
        row_ = idle_ = 0;
        steps_.reset();
        leaves_ = HUGE_VAL;
        onward_ = false;
        bridge_impulse_ = thread_impulse_ = 0;
        std::fill(mass_impulse_.begin(), mass_impulse_.end(), 0.0);
        energies_ = {};
        extremes_ = {};
    }
    Status advance(const Block& out) noexcept override {
        impacts_ = out.impacts;
        if (impacts_) impacts_->reported = true;
        for (int row = 0; row < out.rows; ++row) {
            write(out, row);
            if (!interval(out))
                return {idle_ > 0 ? Outcome::not_converged : Outcome::diverged, row_};
            ++row_;
        }
        return {};
    }
    int dofs() const override { return 2 * modes_.count(); }
    ModalState state() const override {
        return window_.series() || readout_.masses() > 0
                   ? ModalState{}
                   : state_of(y_, u_, modes_.count(), 1 / window_.seconds());
    }
    std::vector<Fact> facts() const override {
        // a smaller force may be none
        const double least_certain = tolerance_ / window_share * extremes_.largest_force;
        const double smallest = extremes_.smallest_force == HUGE_VAL ||
                                        std::abs(extremes_.smallest_force) < least_certain
                                    ? 0
                                    : extremes_.smallest_force;
        std::vector<Fact> f = {{facts::events, extremes_.events},
                               {facts::contact_points, double(window_.contacts)},
                               {facts::coupled_contact_points, double(window_.contacts)},
                               {facts::windows, extremes_.windows},
                               {facts::window_terms, double(window_.terms)},
                               {facts::contact_steps, extremes_.steps},
                               {facts::smallest_contact_force, smallest},
                               {facts::largest_contact_force, extremes_.largest_force},
                               {facts::deepest_penetration, extremes_.deepest},
                               {facts::detection_tolerance, extremes_.tolerance}};
        if (rigid_stiffness_ > 0) f.push_back({facts::rigid_stiffness, rigid_stiffness_});
        return f;
    }

private:
    // to the next row
    bool interval(const Block& out) noexcept {
        bridge_impulse_ = thread_impulse_ = 0;
        std::fill(mass_impulse_.begin(), mass_impulse_.end(), 0.0);
        energies_ = {};
        return parts_.each(
            row_ / tap_rate_, interval_, window_.seconds(),
            [&](double from, double to, bool plucked) { return stretch(from, to, plucked, out); });
    }
    // within one interval
    bool stretch(double from, double to, bool plucked, const Block& out) noexcept {
        if (!(to > from)) return true;
        const double longest =
            plucked ? std::min(1.0, pluck_window(pluck_[0]) / window_.seconds()) : 1;
        const long count = static_cast<long>(std::ceil((to - from) / longest - 1e-12));
        for (long i = 0; i < count; ++i) {
            const double at = from + (to - from) * i / count;
            clock_ = row_ / tap_rate_ + at * window_.seconds();
            const double since_pluck =
                plucked ? std::max(0.0, row_ / tap_rate_ - pluck_[0].start + at * window_.seconds())
                        : 0;
            if (!window((to - from) / count, plucked, since_pluck, out) || out.stopped())
                return false;
        }
        return true;
    }
    bool window(double end, bool plucked, double since_pluck, const Block& out) noexcept {
        MacroWindow& w = window_;
        w.open(y_.data(), u_.data(), plucked, since_pluck, z_.data());
        ++extremes_.windows;
        for (int a = 0; a < w.contacts; ++a) {
            std::copy_n(w.free_motion(a), w.size, at(r_, a));
            if (known_zero_[a]) at(r_, a)[0] = 0;
        }
        extremes_.tolerance = std::max(extremes_.tolerance, 2 * (w.truncation() + w.rounding()));
        // nothing is ever written behind them
        for (int a = 0; a < w.contacts; ++a) std::fill_n(at(moments_, a), w.size, 0.0);
        long phases = 0;
        for (double now = 0; now < end;) {
            const double left = end - now, step = phase(now, left, out.energy != nullptr);
            if (!(step >= 0) || out.stopped(phases++, phases_between_questions)) return false;
            idle_ = step > least_progress ? 0 : idle_ + 1;
            if (idle_ > 1000) return false;
            now = step == left ? end : now + step;
        }
        w.state_at(end, moments_.data(), y_.data(), u_.data(), y_.data(), u_.data());
        for (int a = 0; a < w.contacts; ++a) {
            const double impulse = at(moments_, a)[0] * w.seconds();
            bridge_impulse_ += sign_[a] * impulse;
            const int mass = a - w.contacts + static_cast<int>(mass_impulse_.size());
            if (mass >= 0) mass_impulse_[mass] += impulse;
        }
        thread_impulse_ += w.thread_impulse();
        if (w.series()) std::copy_n(w.series_state(), z_.size(), z_.begin());
        return std::isfinite(y_[0]);
    }
    // to the next event, or to the end of the validity of the present method
    double phase(double now, double left, bool probe) noexcept {
        MacroWindow& w = window_;
        settle();
        collocated_ = !touched_.empty() && !touch_;
        std::fill(known_zero_.begin(), known_zero_.end(), 0);
        double end = left;
        int crossed = -1;
        if (touched_.empty()) {
            std::copy(r_.begin(), r_.end(), path_.begin());
            crossed = next_crossing(end, w.size);
        } else if (touch_) {
            touch_->set.solve(r_.data(), path_.data(), amplitude_.data());
            end = std::min(left, touch_->set.span());
            crossed = next_crossing(end, w.size);
        } else {
            end = collocated(left, crossed);
            if (!(end >= 0)) return -1;
        }
        if (!collocated_ && crossed >= 0 && !touching_[crossed])
            steps_.set_in(), leaves_ = HUGE_VAL;
        onward_ = collocated_;
        for (int a : touched_) measure(a, end, a == crossed);
        for (int i = 0; collocated_ && i < static_cast<int>(touched_.size()); ++i)
            if (law_[touched_[i]].beta != 0) measure_force(i, end);

        if (end != counted_until_) {
            count_ = 2, counted_until_ = end;
            for (double x = w.reach * end; count_ < w.terms && x > negligible;
                 x *= w.reach * end / count_)
                ++count_;
        }
        const auto moments_until = [&](double until, int count) {
            for (int i = 0; i < static_cast<int>(touched_.size()); ++i)
                if (touch_)
                    touch_->set.moments(i, path_.data(), amplitude_.data(), until, count,
                                        at(moment_, i));
                else collocation_.moments(i, until, count, at(moment_, i));
        };
        if (probe && end > 0) {
            // from earlier phases, seen from an earlier instant, and from this phase
            const auto all_moments = [&](double when, double* M, double* F) {
                double earlier[3 * most_terms];
                std::fill_n(earlier, w.size, 0.0);
                powers(when - now - left, w.size, earlier + w.size);
                std::fill_n(M, static_cast<long>(w.contacts) * w.stride, 0.0);
                for (int a = 0; a < w.contacts; ++a)
                    w.sweep().combine(M + a * w.stride, w.size, at(moments_, a), w.terms,
                                      earlier + w.size, -1);
                moments_until(when - now, w.terms);
                std::fill_n(F, w.contacts, 0.0);
                for (int i = 0; i < static_cast<int>(touched_.size()); ++i) {
                    F[touched_[i]] =
                        touch_ ? touch_->set.force(i, path_.data(), amplitude_.data(), when - now)
                               : collocation_.force(i, when - now);
                    for (int n = 0; n < w.terms; ++n)
                        M[touched_[i] * w.stride + n] += at(moment_, i)[n];
                }
            };
            spending_.spend({now, now + end, y_.data(), u_.data(), touch_}, all_moments, energies_);
            for (int i = 0; collocated_ && i < static_cast<int>(touched_.size()); ++i)
                energies_.dissipated += collocation_.dissipated(i);
        }
        moments_until(end, count_);
        if (impacts_) tell_impacts(now, end);
        move_on(end, left);
        if (crossed >= 0) {
            touching_[crossed] = !touching_[crossed];
            at(r_, crossed)[0] = 0;
            known_zero_[crossed] = 1;
            ++extremes_.events;
        }
        return end;
    }
    // Makes one collocation step, no longer than `left` and than the first crossing.
    double collocated(double left, int& crossed) noexcept {
        const MacroWindow& w = window_;
        using From = CollocatedContact::From;
        double d = steps_.next(left, leaves_), error;
        for (int tries = 0;; ++tries) {
            if (tries > 60) return -1;
            error = collocation_.step(r_.data(), touched_, d,
                                      tries > 0 ? From::same_start
                                      : onward_ ? From::last_end
                                                : From::elsewhere);
            ++extremes_.steps;
            if (steps_.fits(error)) break;
            leaves_ = HUGE_VAL;
            if (error < 1e-2) {  // otherwise the path means nothing
                collocation_.path(r_.data(), path_.data());
                double end = d;
                const int first = next_crossing(end, w.size);
                leaves_ = first < 0 ? d + leaving(d, -1) : touching_[first] ? end : HUGE_VAL;
            }
            steps_.rejected(error, leaves_);
            d = steps_.next(left, leaves_);
        }
        for (int i = 0; i < 6; ++i) {
            collocation_.path(r_.data(), path_.data());
            double end = d;
            const int first = next_crossing(end, w.size);
            if (first < 0) break;
            crossed = first;
            if (std::abs(end - d) <= std::max(4e-16, 1e-3 * tolerance_ * d)) break;
            d = end;
            if (!(d > negligible)) {
                d = 0;
                break;
            }
            if (collocation_.step(r_.data(), touched_, d, From::same_start) == HUGE_VAL) return -1;
            ++extremes_.steps;
        }
        steps_.accepted(error, d);
        if (crossed >= 0 && !touching_[crossed]) steps_.set_in();
        leaves_ = leaving(d, crossed);
        return d;
    }
    // Time at which the first touching point lets go, from the end of a step d on, by its
    // acceleration there.
    double leaving(double d, int but) const noexcept {
        double first = HUGE_VAL;
        for (int a : touched_) {
            if (a == but) continue;
            double now[3];
            window_.sweep().evaluate(path_.data() + static_cast<long>(a) * window_.stride,
                                     window_.size, d, now);
            // depth - now1 t - now2 t^2/2 = 0
            const double depth = -now[0], root = now[1] * now[1] + 2 * now[2] * depth;
            if (depth > 0 && root >= 0 && now[1] + std::sqrt(root) > 0)
                first = std::min(first, 2 * depth / (now[1] + std::sqrt(root)));
        }
        return first;
    }
    // the side the point is on now: positive until the next event
    Gap gap(int a, int terms) const noexcept {
        const int pairs = touch_ ? touch_->set.pairs() : 0;
        return {touching_[a] ? -1.0 : 1.0,
                path_.data() + static_cast<long>(a) * window_.stride,
                terms,
                collocated_ ? HUGE_VAL  // no bound: a collocated path is as fast as the contact
                : touch_    ? touch_->set.growth()
                            : window_.reach,
                amplitude_.data() + a * pairs,
                touch_ ? touch_->set.rates() : nullptr,
                pairs};
    }
    int next_crossing(double& end, int terms) noexcept {
        int first = -1;
        for (int a = 0; a < window_.contacts; ++a) {
            const double crossing = first_crossing(gap(a, terms), end, window_.rounding());
            if (crossing <= end) end = crossing, first = a;
        }
        return first;
    }
    // Decides which points touch, by position and velocity
    void settle() noexcept {
        const MacroWindow& w = window_;
        for (int a = 0; a < w.contacts; ++a) {
            const double* r = at(r_, a);
            const double* leading = std::find_if(r, r + 2, [](double c) { return c != 0; });
            double sign = leading == r + 2 ? 0 : *leading;
            if (sign == 0) {  // on the surface, at rest: decided by the pull there
                sign = r[2];
                for (int b = 0; b < w.contacts; ++b)
                    if (at(r_, b)[0] < 0)
                        sign += w.kernel(a, b)[1] *
                                law_[b].force(-at(r_, b)[0], at(r_, b)[1] / w.seconds());
            }
            if (sign == 0) continue;
            if (touching_[a] == (sign < 0)) continue;
            touching_[a] = sign < 0;
            ++extremes_.events;
        }
        touched_.clear();
        unsigned bits = 0;
        for (int a = 0; a < w.contacts; ++a)
            if (touching_[a]) touched_.push_back(a), bits |= a < most_sets_of ? 1u << a : 0;
        touch_ = !touched_.empty() && !sets_.empty() && sets_[bits] ? &*sets_[bits] : nullptr;
    }
    // The points' free motion and the moments, from the instant of this phase's start to `by`
    // later, `left` before the window's end.
    void move_on(double by, double left) noexcept {
        const MacroWindow& w = window_;
        const auto combine = w.sweep().combine;
        double e[3 * most_terms], later[3 * most_terms], shifted[most_terms];
        const bool last = by == left;  // last in the window: nobody needs the free motion beyond it
        if (!last) powers(by, w.size, e);
        for (int a = 0; !last && a < w.contacts; ++a) {
            double* r = at(r_, a);
            w.sweep().combined(shifted, w.size, e, count_, r, 1);
            std::copy_n(shifted, w.size, r);
        }
        if (touched_.empty()) return;
        std::fill_n(later, w.size, 0.0);  // a convolution reads the zeros before
        powers(left - by, w.size, later + w.size);
        for (std::size_t i = 0; i < touched_.size(); ++i) {
            const double* m = at(moment_, static_cast<int>(i));
            extremes_.tolerance =
                std::max(extremes_.tolerance, w.kernel_truncation() * std::abs(m[0]));
            for (int a = 0; !last && a < w.contacts; ++a)
                combine(at(r_, a), w.size, m, count_, w.kernel(a, touched_[i]), 1);
            combine(at(moments_, touched_[i]), w.size, m, count_, later + w.size, -1);
        }
    }
    void measure(int a, double end, bool leaves) noexcept {
        // touching: the gap's sign is turned, so this is the penetration
        const Gap g = gap(a, window_.size);
        const double bound = g.depth_bound(end);
        const bool elastic = law_[a].beta == 0;
        const bool nothing_new =
            bound <= extremes_.deepest && (window_.contacts == 1 || !elastic ||
                                           law_[a].elastic(bound) <= extremes_.largest_force);
        if (leaves && nothing_new) return;  // contact forces are not negative in between
        const auto start = g.at_start(), last = g.at(end, g.terms_until(end));
        double deepest = std::max(start.g, last.g);
        if (elastic)
            extremes_.smallest_force = std::min(
                extremes_.smallest_force,
                law_[a].elastic(std::max(0.0, leaves ? start.g : std::min(start.g, last.g))));
        if (!nothing_new)
            deepest = std::max(deepest, g.greatest(end, std::max(deepest, extremes_.deepest)));
        extremes_.deepest = std::max(extremes_.deepest, deepest);
        if (elastic)
            extremes_.largest_force = std::max(extremes_.largest_force, law_[a].elastic(deepest));
    }
    void measure_force(int which, double end) noexcept {
        const auto force = [&](double at) { return collocation_.force(which, at); };
        extremes_.largest_force = std::max(extremes_.largest_force, most_in(0, end, force));
        double least = -most_in(0, end, [&](double at) { return -force(at); });
        // at release a polynomial dips by the error of the step
        if (law_[touched_[which]].clipped) least = std::max(0.0, least);
        extremes_.smallest_force = std::min(extremes_.smallest_force, least);
    }
    // for the current phase
    void tell_impacts(double now, double end) noexcept {
        const double second = window_.seconds();
        const int touched = static_cast<int>(touched_.size());
        for (int first = 0, behind = 0; first < touched; first = behind) {
            Impact part{barrier_[touched_[first]], clock_ + now * second,
                        clock_ + (now + end) * second};
            part.speed_in = part.speed_out = -HUGE_VAL;
            for (; behind < touched && barrier_[touched_[behind]] == part.barrier; ++behind) {
                const Gap g = gap(touched_[behind], window_.size);
                part.speed_in = std::max(part.speed_in, g.at_start().slope / second);
                part.speed_out = std::max(part.speed_out, -g.at(end).slope / second);
                part.impulse += at(moment_, behind)[0] * second;
                if (collocated_) part.energy_lost += collocation_.dissipated(behind);
            }
            if (part.start == 0) part.speed_in = std::nan("");  // the contact was on
            const auto force = [&](double at) {
                double sum = 0;
                for (int i = first; i < behind; ++i)
                    sum += touch_ ? touch_->set.force(i, path_.data(), amplitude_.data(), at)
                                  : collocation_.force(i, at);
                return sum;
            };
            part.largest_force = -HUGE_VAL;
            for (double from = 0, to; from < end; from = to) {
                to = end;
                for (int i = first; i < behind; ++i)
                    to = std::min(to, from + gap(touched_[i], window_.size)
                                                 .one_turn(from, 1e-9 * extremes_.deepest));
                part.largest_force = std::max(part.largest_force, most_in(from, to, force));
            }
            impacts_->add(part);
        }
    }
    double stored(double F_e) const noexcept {
        const Springs& s = window_.springs;
        double kinetic = 0, potential = 0;
        for (int i = 0; i < window_.osc.padded; ++i) {
            kinetic += u_[i] * u_[i];
            potential += stiffness_[i] * y_[i] * y_[i];
        }
        for (int i = 0; i < modes_.count(); ++i) potential -= 2 * falling_[i] * y_[i];
        double energy =
            0.5 * (potential + modes_.mass * kinetic / (window_.seconds() * window_.seconds()));
        const auto& series = window_.series();
        if (series) energy += series->stored(z_.data());
        for (int a = 0; a < s.points; ++a) {
            const double* g = s.weights.data() + static_cast<long>(a) * window_.osc.padded;
            double eta = s.height[a] - (series ? z_[a] + series->plucked(a) * F_e : 0);
            for (int i = 0; i < window_.osc.padded; ++i) eta -= g[i] * y_[i];
            energy += a < s.contacts ? law_[a].law.potential(eta) : 0.5 * s.k[a] * eta * eta;
        }
        return energy;
    }
    void write(const Block& out, int row) const noexcept {
        readout_.write(out, row, y_.data(), u_.data(), 1 / window_.seconds(),
                       bridge_impulse_ * tap_rate_, thread_impulse_ * tap_rate_, mass_impulse_);
        const double F_e = pluck_.empty() ? 0 : force(pluck_[0], row_ / tap_rate_);
        if (window_.series()) add_series(out, row, *window_.series(), z_.data(), F_e);
        if (out.energy)
            write_energy(out, row, stored(F_e), energies_.supplied, energies_.dissipated);
    }
    double* at(std::vector<double>& rows, int a) const noexcept {
        return rows.data() + static_cast<long>(a) * window_.stride;
    }

    Modes modes_;
    MacroWindow window_;
    std::vector<BarrierLaw> law_;
    CollocatedContact collocation_;
    WindowEnergies spending_;
    std::vector<std::optional<WindowEnergies::Touch>>
        // indexed by the bits of their points; empty if there are too many contacts or a law is no
        // spring
        sets_;
    Readout readout_;
    std::vector<Pluck> pluck_;  // none or one
    PluckParts parts_;
    double tap_rate_, tolerance_, interval_;  // interval length in windows
    // y and u at t = 0; m omega0^2, per mode; z at t = 0
    std::vector<double> start_, start_u_, stiffness_, start_z_;

    std::vector<double> y_, u_;  // the state
    std::vector<double> z_;      // for the series compliance
    std::vector<char> touching_, known_zero_;
    long row_ = 0;
    double bridge_impulse_ = 0, thread_impulse_ = 0;
    WindowEnergies::Sums energies_;  // for the interval that ends here
    int idle_ = 0;
    ContactSteps steps_;
    double rigid_stiffness_ = 0;  // stiffest spring that represents a rigid barrier [N/m]
    double leaves_ = HUGE_VAL;    // estimated time at which the first collocated point lets go
    Extremes extremes_;
    std::vector<int> barrier_;          // for each contact
    std::vector<double> sign_;          // of its coordinate
    std::vector<double> mass_impulse_;  // from each mass in the interval that ends here [N s]
    std::vector<double> falling_;
    Impacts* impacts_ = nullptr;  // from the current block
    double clock_ = 0;            // when the window begins [s]

    // one window; rows with window_.stride
    std::vector<double> r_, path_, moments_, moment_;
    std::vector<std::complex<double>> amplitude_;
    std::vector<int> touched_;
    // for the touching springs; nullptr: none touch, or contact is collocated
    WindowEnergies::Touch* touch_ = nullptr;
    bool collocated_ = false, onward_ = false;  // this phase, and the one before
    // number of moments in this phase that are not negligible: (reach x step)^i/i!
    int count_ = 0;
    double counted_until_ = -1;  // for a step with that length
};

constexpr Option tolerance_option{"tolerance", "1e-10",
                                  "relative error of the taps that cutting off series and steps "
                                  "may cause, forces included, between 0 and 1"};
constexpr Option options[] = {tolerance_option, nodes_option, compliance_option};

std::unique_ptr<Scheme> make(const Descriptor& descriptor, const Scene& scene,
                             const Settings& settings) {
    const double tolerance = number_option(settings, tolerance_option);
    if (!(tolerance > 0 && tolerance < 1))
        throw Refusal("option tolerance: expected a number between 0 and 1");
    Settings unsampled = settings;
    unsampled.sample_rate = 0;
    // over a rigid barrier matched by default, since no other choice works
    Settings chosen = settings;
    const auto says = [](const auto& o) { return o.first == compliance_option.name; };
    if (needed_by(scene).has(Feature::rigid_barrier) &&
        std::none_of(chosen.options.begin(), chosen.options.end(), says))
        chosen.options.emplace_back(compliance_option.name, "matched");
    const Modes modes = modes_of(scene.strings.at(0), unsampled);
    const auto series = in_series(descriptor, scene, modes, chosen);
    String s = scene.strings.at(0);
    std::vector<int> barrier_of_each;
    for (String one = s; const Barrier& barrier : s.barriers) {
        one.barriers = {barrier};
        const int of = static_cast<int>(&barrier - s.barriers.data());
        const auto points = with_points(one, modes.count(), profile_points(settings)).barriers;
        barrier_of_each.insert(barrier_of_each.end(), points.size(), of);
    }
    for (std::size_t k = 0; k < s.masses.size(); ++k)
        barrier_of_each.push_back(static_cast<int>(s.barriers.size() + k));
    s = with_springs(with_points(s, modes.count(), profile_points(settings)), descriptor, series);
    return std::make_unique<ExactContact>(s, scene, modes, settings.tap_rate, tolerance, series,
                                          std::move(barrier_of_each));
}
constexpr Approximation approximates[] = {points_for_a_profile[0],
                                          {Feature::rigid_barrier, facts::rigid_stiffness}};
}  // namespace

const Descriptor exact_contact = {
    .name = "exact_contact",
    .source =
        "van Walstijn et al. 2016, eqs 1-22, and Issanchou et al. 2016, eq 24, exact between "
        "events",
    .represents = modal_features_of_points | Feature::rigid_barrier | Feature::clipped_loss |
                  any_mass | Feature::barrier_above,
    .balance = Balance::to_tolerance,
    .clock = Clock::continuous,
    .make = make,
    .options = options,
    .approximates = approximates,
    .confirmation = [](const Scene&) {
        return Confirmation{{{}, {{tolerance_option.name, "1e-12"}}}, {}};
    }};

}  // namespace jvari
