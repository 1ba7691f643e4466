// Chooses the step length for a collocated contact. A force like eta^alpha is no polynomial at its
// start and end, unless alpha is 1. The error of a step there does not fall like the error of a
// smooth step:
// - over a step that begins or ends there the force keeps its shape whatever the length d, and the
//   error is its push, d^(1 + alpha);
// - over a step at a distance D the measured error is d^(1 + alpha) (d/D)^4, so lengths grow away
//   from there.
//
// The allowed length is learnt from the errors and kept from one contact to the next: it hardly
// depends on the speed. Leaves out: the effect of a point's onset on other points' forces, of order
// alpha + 2, which only the errors show.
#pragma once

#include <algorithm>
#include <cmath>

namespace jvari {

class ContactSteps {
public:
    ContactSteps(double allowed, double exponent)
        : allowed_(allowed),
          push_(1 + exponent),
          by_edge_(push_ / (push_ + near_order)),
          by_distance_(near_order / (push_ + near_order)),
          singular_(exponent != 1) {}
    void reset() noexcept { *this = ContactSteps(allowed_, push_ - 1); }

    void set_in() noexcept { since_ = 0; }  // a point touches from here on
    // no longer than `left`; `leaves` from here a force ends, or nowhere
    double next(double left, double leaves) noexcept {
        double d = smooth_;
        limit_ = Limit::smooth;
        const auto limit = [&](double most, Limit by) {
            if (most < d) d = most, limit_ = by;
        };
        if (singular_) {
            if (since_ == 0) limit(edge_, Limit::edge);
            else if (since_ < far_) limit(beside(since_), Limit::grade);
            if (leaves <= 0.9 * edge_) {
                limit(1.02 * leaves, Limit::edge);  // and a little on, to see the crossing
            } else if (leaves < far_ + smooth_) {
                limit(towards(leaves), Limit::grade);
                limit(leaves - 0.7 * edge_, Limit::other);
            }
        }
        if (again_) limit(0.9 * last_, limit_);
        limit(left, Limit::other);
        last_ = d;
        ended_ = leaves - d;
        return d;
    }
    bool fits(double error) const noexcept { return error <= allowed_; }
    // the requested step, and the place in it at which a force ends
    void rejected(double error, double leaves) noexcept {
        const double over = allowed_ / error;
        const bool ends = leaves <= last_;
        again_ = true;
        if (singular_ && (since_ == 0 || (ends && limit_ == Limit::edge)))
            return learn(last_ * std::clamp(0.8 * std::pow(over, 1 / push_), 0.02, 0.9), grade_,
                         smooth_);
        if (singular_ && ends) return;
        const double distance = std::min(since_, leaves - last_);
        if (singular_ && last_ > near * distance) {
            // share of the length from which grade_ is learnt
            const double learnt = last_ / (scale_ * std::pow(distance, by_distance_));
            return learn(edge_,
                         grade_ * std::min(1.0, learnt) *
                             std::clamp(0.9 * std::pow(over, 1 / (push_ + near_order)), 0.3, 0.9),
                         smooth_);
        }
        // a smooth force errs by d^12
        learn(edge_, grade_, last_ * std::clamp(0.8 * std::pow(over, 0.1), 0.1, 0.7));
    }
    // the requested step, or a shorter one up to a crossing
    void accepted(double error, double d) noexcept {
        const double over = allowed_ / std::max(error, 1e-30);
        again_ = false;
        since_ += d;
        if (d < last_ || limit_ == Limit::other ||
            (limit_ == Limit::smooth && smooth_ == 1 && over > 20))
            return;
        if (limit_ == Limit::edge)
            learn(std::min(1.0, d * std::clamp(0.8 * std::pow(over, 1 / push_), 0.5, 2.0)), grade_,
                  smooth_);
        if (limit_ == Limit::grade && d > std::min(since_ - d, ended_))
            learn(edge_,
                  std::min(10.0, grade_ * std::clamp(0.9 * std::pow(over, 1 / (push_ + near_order)),
                                                     0.7, 1.5)),
                  smooth_);
        if (limit_ == Limit::smooth)
            learn(edge_, grade_,
                  std::min(1.0, d * std::clamp(0.8 * std::pow(over, 0.1), 0.5, 4.0)));
    }

private:
    // a step no longer than near D does not feel a singularity at distance D
    static constexpr double near_order = 4, near = 0.5;
    enum class Limit { other, edge, grade, smooth };
    // the longest step, at a distance from an onset
    double beside(double distance) const noexcept {
        return std::max(near * distance, scale_ * std::pow(distance, by_distance_));
    }
    // and up to such a distance from an end
    double towards(double leaves) const noexcept {
        double step = 0.5 * leaves;
        // step = beside(leaves - step), by Newton's iteration kept inside
        for (int i = 0; i < 3; ++i) {
            const double most = beside(leaves - step),
                         slope = by_distance_ * most / (leaves - step);
            step =
                std::clamp(step + (most - step) / (1 + slope), 0.1 * step, 0.5 * (step + leaves));
        }
        return step;
    }
    void learn(double edge, double grade, double smooth) noexcept {
        edge_ = edge, grade_ = grade, smooth_ = smooth;
        scale_ = grade_ * std::pow(edge_, by_edge_);
        far_ = std::min(smooth_ / near, std::pow(smooth_ / scale_, 1 / by_distance_));
    }

    double allowed_, push_, by_edge_, by_distance_;  // push_: 1 + alpha
    bool singular_;
    // longest steps: at an onset, by the law beside the onset, for a smooth force
    double edge_ = 1, grade_ = 4, smooth_ = 1;
    // derived: the law's scale, and the distance at which it allows smooth_
    double scale_ = 4, far_ = 0;
    // distance from the last onset; the last length, and the distance from its end to a force's end
    double since_ = HUGE_VAL, last_ = 1, ended_ = HUGE_VAL;
    bool again_ = false;
    Limit limit_ = Limit::smooth;
};

}  // namespace jvari
