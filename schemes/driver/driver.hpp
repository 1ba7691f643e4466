// Combines a string (string_step.hpp) and an obstacle rule (contact/obstacle_rule.hpp) into a
// scheme. The driver has everything that belongs to neither: rows, mean contact forces, the energy
// ledger, the series compliance moved by the pluck, stopping and failing.
//
// Instants. Row n is written when the force in step n is known. A contact force is the mean over
// the interval that ends at the row. For two-point steps this is the mean of the steps' forces; for
// three-point steps, whose force F^n stands for n - 1/2 .. n + 1/2, the trapezoidal mean. Energy:
// stored(n) - stored(n-1) = supplied - dissipated, over the steps after the former row, if the rule
// conserves. Stored is the string's own energy (string_step.hpp) and the points' potential at the
// same instants, P(n) or [P(n) + P(n+1)]/2.
//
// Moments. A force is constant in a step, or a line, whose two moments stand one after the other
// (moments/moment_obstacle.hpp): arrays over the points have the means first, so that rows, masses
// and impacts are the same for both.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <memory>

#include "scenes/excitation.hpp"
#include "schemes/driver/free_masses.hpp"
#include "schemes/driver/string_step.hpp"
#include "schemes/impacts.hpp"
#include "schemes/making.hpp"
#include "schemes/moments/moment_obstacle.hpp"

namespace jvari {

// Mean forces at a string's points, from row to row.
class RowForces {
public:
    RowForces(int points, int levels, int steps)
        : sum_(points), mean_(points), levels_(levels), steps_(steps) {}
    void clear() noexcept { std::fill(sum_.begin(), sum_.end(), 0.0); }
    void count(const double* force) noexcept {
        for (std::size_t p = 0; p < sum_.size(); ++p) sum_[p] += force[p];
    }
    double* sum() noexcept { return sum_.data(); }  // for each point
    // last: the forces in the current step
    const double* take(const double* last, bool at_start) noexcept {
        for (std::size_t p = 0; p < sum_.size(); ++p) {
            const double half = levels_ == 2 ? 0.5 * last[p] : 0;
            mean_[p] = at_start ? 0 : (sum_[p] - half) / steps_;
            sum_[p] = half;
        }
        return mean_.data();
    }

private:
    std::vector<double> sum_, mean_;  // since the last row [N]
    int levels_, steps_;
};

template <StringStep String>
class Driver final : public Scheme {
public:
    static constexpr int levels = String::levels, moments = moments_of<String>;

    Driver(std::unique_ptr<String> string, int steps_per_row, const MakeRule& make_rule)
        : string_(std::move(string)),
          steps_(steps_per_row),
          means_(points().count(), levels, steps_per_row),
          masses_(points()),
          obstacle_(obstacle_of(make_rule)) {
        if constexpr (levels == 2) {
            std::vector<double> theta = points().start_theta;
            for (double x : points().theta)
                if (points().start_theta.empty()) theta.push_back(0.5 * x);
            start_ =
                obstacle_.halved(string_->thread_start(), masses_.yielding(theta, 1), series());
        }
        for (auto* v : {&older_, &free_, &now_, &force_, &moving_, &resting_})
            v->assign(static_cast<std::size_t>(moments) * points().count(), 0.0);
        for (std::size_t p = 0; p < points().start_velocity.size(); ++p)
            moving_[p] = points().dt * points().start_velocity[p];
        masses_.subtract_speed(moving_.data());
        std::copy(points().start_force.begin(), points().start_force.end(), resting_.begin());
        plucked_in_series_ = points().series && !points().series->pluck.empty();
        dt_ = points().dt;
        if constexpr (fuses)
            if (masses_.empty()) string_->fuse(obstacle_, steps_);
        Driver::reset();
    }

    void reset() noexcept override {
        done_ = 0;
        status_ = {};
        supplied_ = dissipated_ = 0;
        means_.clear();
        obstacle_.clear();
        string_->reset();
        masses_.clear();
        if constexpr (levels == 2) {
            start_->clear();
            const ReadingsBeforeStep at = at_contacts(string_->readings(), 0, 0, 1);
            start_->begin(at.older, moving_.data(), resting_.data());
            if constexpr (stretches) start_->set(string_->theta());
            if (!start_->start(at, force_.data())) status_ = {Outcome::not_converged, 0};
            string_->start(force_.data(), 0);
            masses_.start(force_.data());
            obstacle_.follow(*start_);
        } else {
            read(0);
            obstacle_.begin(now_.data(), moving_.data(), resting_.data());
        }
        if constexpr (requires { string_->expect(0.0); }) string_->expect(stored());
    }

    bool start_from(const Scheme& scheme) noexcept override {
        const auto* before = dynamic_cast<const Driver*>(&scheme);
        if (!before || obstacle_.dofs() > 0 || !masses_.empty() ||
            !obstacle_.is_like(before->obstacle_))
            return false;
        if constexpr (requires(String s) { s.start_from(s); })
            if (string_->start_from(*before->string_)) {
                reset();
                obstacle_.start_from(before->obstacle_);
                return true;
            }
        return false;
    }

    Status advance(const Block& out) noexcept override {
        impacts_ = out.impacts;
        for (int row = 0; row < out.rows && status_.outcome == Outcome::ok; ++row) {
            if constexpr (fuses)
                if (const FusedRows fused = out.energy || impacts_
                                                ? FusedRows{}
                                                : string_->fused_rows(out, row, means_.sum());
                    fused.steps > 0) {
                    if (fused.stopped) return {};
                    done_ += fused.steps;
                    if (!fused.converged) status_ = {Outcome::not_converged, done_ - 1};
                    else if (string_->failed()) status_ = {Outcome::diverged, done_ - 1};
                    row += fused.rows - 1;
                    continue;
                }
            write(out, row);
            for (int i = 0; i < steps_ && status_.outcome == Outcome::ok; ++i) {
                step(out.energy != nullptr, i + 1 == steps_);
                if (out.stopped(i, String::steps_between_looks)) return {};
            }
        }
        return status_;
    }

    int dofs() const override { return string_->dofs() + masses_.dofs() + obstacle_.dofs(); }
    std::vector<FreeMode> free_modes() const override { return string_->free_modes(); }
    ModalState state() const override {
        if constexpr (requires(const String s) { s.state(); })
            if (obstacle_.dofs() == 0 && masses_.empty() && !points().series)
                return string_->state();
        return {};
    }
    std::vector<Fact> facts() const override {
        std::vector<Fact> f = string_->facts();
        if (obstacle_.contacts() == 0) return f;
        for (Fact& fact : obstacle_.facts()) f.push_back(std::move(fact));
        if (!points().series) return f;
        f.push_back({facts::series_compliance, points().series->C[0]});
        f.push_back({facts::compliance_excess, points().series->excess});
        return f;
    }

private:
    // With tension modulation Theta changes in every step.
    static constexpr bool stretches = requires(const String s) { s.theta(); };
    // True if the string has a kernel for rows without an energy probe.
    static constexpr bool fuses = requires(String s, const Block& out, double* sum) {
        s.fused_rows(out, 0, sum);
    };
    const StringPoints& points() const { return string_->points(); }
    const MissingMatrix* series() const { return points().series ? &*points().series : nullptr; }
    using Points = std::conditional_t<moments == 2, MomentObstacle, Obstacle>;
    Points obstacle_of(const MakeRule& make_rule) const {
        const StringPoints& p = points();
        std::vector<double> theta = masses_.yielding(p.theta, levels);
        if constexpr (moments == 2) return {p.contacts, p.threads, theta, p.dt, series()};
        else return {p.contacts, p.threads, theta, levels * p.dt, levels, make_rule, series()};
    }

    void step(bool probed, bool last_of_row) noexcept {
        string_->approach(last_of_row);
        masses_.approach();
        // the central or starting level of the step; its oldest level
        const long n = done_ + levels - 1, before = n + 1 - levels;
        const ReadingsBeforeStep at = at_contacts(string_->readings(), before, n, n + 1);
        if constexpr (stretches) obstacle_.set(string_->theta());
        if (!force_.empty() && !obstacle_.solve(at, force_.data(), impacts_ != nullptr))
            status_ = {Outcome::not_converged, done_};
        if (impacts_) tell_impacts();
        means_.count(force_.data());
        const Spent spent = string_->pass(force_.data(), 0, probed);
        const double damped = masses_.pass(force_.data());
        if (probed) {
            supplied_ += spent.supplied - by_way_of_series(before, n + 1);
            dissipated_ += spent.dissipated + damped + dt_ * obstacle_.loss();
        }
        if (string_->failed() && status_.outcome == Outcome::ok)
            status_ = {Outcome::diverged, done_};
        ++done_;
    }

    void tell_impacts() noexcept {
        const double to = (static_cast<double>(done_) + 0.5 * (levels + 1)) * dt_;
        for (int a = 0; a < obstacle_.contacts(); ++a) {
            const BarrierOf& of = points().contacts.of[a];
            impacts_[of.string].reported = true;
            impacts_[of.string].step(of, a,
                                     {to, dt_, levels * dt_, force_[a], obstacle_.moved()[a],
                                      obstacle_.lost_by(a, force_[a])});
        }
    }

    // Force of the pluck, which also moves the points through the series compliance.
    double pluck_at(long n) noexcept {
        if (!points().pluck) return 0;
        PluckAt& known = pluck_at_[n & 3];
        if (known.step != n)
            known = {n, jvari::force(*points().pluck, static_cast<double>(n) * dt_)};
        return known.force;
    }
    ReadingsBeforeStep at_contacts(const ReadingsBeforeStep& at, long older, long now,
                                   long newer) noexcept {
        if (!plucked_in_series_ && masses_.empty()) return at;
        const int P = points().count();
        const double a = pluck_at(older), b = pluck_at(now), c = pluck_at(newer);
        if constexpr (moments == 2) {
            const double turned = turned_pluck(older);
            for (int p = 0; p < P; ++p) {
                const double yield = plucked_in_series_ ? points().series->pluck[p] : 0;
                free_[p] = at.free[p] + yield * (c - a);
                free_[P + p] = at.free[P + p] + yield * turned;
            }
            masses_.subtract_way(free_.data(), 1);
            return {nullptr, nullptr, free_.data()};
        }
        for (int p = 0; p < P; ++p) {
            const double yield = plucked_in_series_ ? points().series->pluck[p] : 0;
            older_[p] = at.older[p] + yield * a;
            now_[p] = at.now[p] + yield * b;
            free_[p] = at.free[p] + yield * (c - a);
        }
        masses_.subtract(older_.data(), static_cast<double>(older - now));
        masses_.subtract(now_.data(), 0);
        masses_.subtract_way(free_.data(), static_cast<double>(newer - older));
        return {older_.data(), now_.data(), free_.data()};
    }
    // int F' P_1 dt for the pluck over a step, by parts [N]
    double turned_pluck(long n) noexcept {
        if constexpr (moments == 2)
            if (plucked_in_series_)
                return pluck_at(n) + pluck_at(n + 1) - 2 * string_->mean_pluck();
        return 0;
    }
    // work done there by the forces [J]
    double by_way_of_series(long older, long newer) noexcept {
        double work = 0;
        if (!plucked_in_series_) return work;
        const double change = pluck_at(newer) - pluck_at(older), turned = turned_pluck(older);
        for (int p = 0; p < points().count(); ++p) {
            work += force_[p] * points().series->pluck[p] * change;
            if constexpr (moments == 2)
                work += force_[points().count() + p] * points().series->pluck[p] * turned;
        }
        return work / levels;
    }

    // reads the contacts into now_
    void read(int level) noexcept {
        string_->reading(level, now_.data());
        if (const double F_e = plucked_in_series_ ? pluck_at(done_ + level) : 0; F_e != 0)
            for (int p = 0; p < points().count(); ++p) now_[p] += points().series->pluck[p] * F_e;
        masses_.subtract(now_.data(), level);
    }
    double stored() noexcept {
        double sum = string_->stored() + masses_.stored();
        for (int level = 0; level < levels; ++level) {
            read(level);
            sum += obstacle_.potential(now_.data(), level) / levels;
        }
        return sum;
    }

    void write(const Block& out, int row) noexcept {
        const double* means = means_.take(force_.data(), done_ == 0);
        const double* heard = masses_.empty() ? means : masses_.unheard(means);
        for (int k = 0; k < out.taps; ++k) out.tap[k * out.stride + row] = string_->tap(k, heard);
        if (points().series) {
            const double F_e = plucked_in_series_ ? pluck_at(done_) : 0;
            for (int k = 0; k < out.taps; ++k)
                out.tap[k * out.stride + row] +=
                    points().series->on_tap(k, obstacle_.forces(0), F_e);
        }
        masses_.write(out, row, means);
        if (out.energy) write_energy(out, row, stored(), supplied_, dissipated_);
        supplied_ = dissipated_ = 0;
    }

    std::unique_ptr<String> string_;
    int steps_;
    bool plucked_in_series_ = false;
    double dt_ = 0;
    struct PluckAt {
        long step = -1;
        double force = 0;  // [N]
    };
    std::array<PluckAt, 4> pluck_at_;  // at the latest steps
    RowForces means_;
    FreeMasses<levels, moments> masses_;
    Points obstacle_;
    std::optional<Obstacle> start_;  // for three-point schemes
    std::vector<double> older_, free_, now_, force_;
    std::vector<double> moving_, resting_;  // at t = 0: way in dt by their speeds [m], forces [N]
    long done_ = 0;                         // steps
    Impacts* impacts_ = nullptr;            // in the current block
    double supplied_ = 0, dissipated_ = 0;  // since the last row [J]
    Status status_;
};

// Makes the scheme from a string and a rule. Rigid barriers use the rule's limit.
template <StringStep String>
std::unique_ptr<Scheme> driven(std::unique_ptr<String> string, const Descriptor& scheme,
                               const Settings& settings, const RuleChoice& rule) {
    const bool stiff =
        (rule.rigid || moments_of<String> == 2) && string->points().contacts.any_rigid();
    if (stiff && string->points().start_force.empty()) {
        std::vector<double> start(string->points().count());
        string->reset();
        string->reading(0, start.data());
        refuse_rigid(scheme, string->points(), start.data());
    }
    if (!rule.rests_in_powers) refuse_rest_in_powers(scheme, string->points());
    return std::make_unique<Driver<String>>(std::move(string), steps_per_row(settings),
                                            stiff ? rule.rigid : rule.make);
}

}  // namespace jvari
