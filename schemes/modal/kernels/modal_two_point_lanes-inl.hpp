// Two to four strings advanced together, in two pairs: linear contact, the modes' own compliance (van Walstijn et al. 2016, eqs 44-48).
//
// The contact equations of a pair are a chain of some 140 cycles (a root and two divisions in a row), as long as one pass over 133 modes.
// A processor looks ahead, but not past a chain that fills its scheduler. So the chain of one pair is cut into five stages, which stand
// between the thirds of the other pair's two passes. A lane holds a string, no branch depends on whether it touches, and the operations of
// a lane are those of step_own and solve_linear_contact in their order: the same bits.
#if defined(JVARI_MODAL_TWO_POINT_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef JVARI_MODAL_TWO_POINT_LANES
#undef JVARI_MODAL_TWO_POINT_LANES
#else
#define JVARI_MODAL_TWO_POINT_LANES
#endif

#include <span>

#include "schemes/modal/kernels/modal_two_point_pass-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace jvari {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <bool thread, bool read>
class TwoPointPair {
public:
    TwoPointPair(TwoPoint* first, TwoPoint* second) : strings_{first, second} {  // second: or nullptr
        for (int i = 0; i < 2 && strings_[i]; ++i) {
            const TwoPoint& m = *strings_[i];
            k_.of[i] = m.barrier.k;
            for (const auto& [constant, lanes] : constants_) (this->*lanes).of[i] = m.*constant;
            at_b_.put(i, m.y_b, m.u_b);
            at_c_.put(i, m.y_c, m.u_c);
        }
        next_pluck();
    }
    void leave() const {  // the strings as they are now
        for (int i = 0; i < 2 && strings_[i]; ++i) {
            TwoPoint& m = *strings_[i];
            m.y_b = at_b_.of[i];
            m.u_b = at_b_.of[2 + i];
            m.y_c = at_c_.of[i];
            m.u_c = at_c_.of[2 + i];
        }
    }
    void solve() {
        stage<1>();
        stage<2>();
        stage<3>();
        stage<4>();
        stage<5>();
    }

    // One step by the forces solved, while `other` solves for its own.
    HWY_INLINE void step(TwoPointPair& other) {
        Dots next[2];
        next[1] = {hn::Zero(D()), hn::Zero(D()), hn::Zero(D()), hn::Zero(D()), hn::Zero(D())};
        next[0] = pass_of<0>(other);
        if (strings_[1]) next[1] = pass_of<1>(other);
        else other.template rest<3>();
        sums(next[0].y_b, next[1].y_b, next[0].u_b, next[1].u_b, at_b_.of);
        if constexpr (thread) sums(next[0].y_c, next[1].y_c, next[0].u_c, next[1].u_c, at_c_.of);
        if constexpr (read) {
            alignas(64) double heard[4];
            sums(next[0].read, next[1].read, hn::Zero(D()), hn::Zero(D()), heard);  // the bits of SumOfLanes
            for (int i = 0; i < 2 && strings_[i]; ++i) {
                strings_[i]->heard = heard[i];
                strings_[i]->read_at = strings_[i]->step;
            }
        }
        next_pluck();
    }

private:
    using L = hn::CappedTag<double, 2>;
    using W = hn::Vec<L>;
    struct alignas(16) Lanes {
        double of[2] = {};  // zero where there is no string: no barrier, no force
        HWY_INLINE W all() const { return hn::Load(L(), of); }
        HWY_INLINE void set(W w) { hn::Store(w, L(), of); }
    };

    struct alignas(64) Dotted {  // by a point
        double of[4] = {};       // y and u of both strings
        void put(int i, double y, double u) {
            of[i] = y;
            of[2 + i] = u;
        }
        HWY_INLINE W y() const { return hn::Load(L(), of); }
        HWY_INLINE W u() const { return hn::Load(L(), of + 2); }
    };

    template <int first>
    struct Stages {  // of the other pair, between the thirds of a pass
        TwoPointPair& other;
        template <int part>
        HWY_INLINE void at() const {
            other.template stage<first + part>();
        }
    };
    template <int i>
    HWY_INLINE Dots pass_of(TwoPointPair& other) {
        TwoPoint& m = *strings_[i];
        const double F_b = F_b_.of[i], F_c = F_c_.of[i];
        note<ContactKind::linear>(m, {.force = F_b}, m.h_b - at_b_.of[i]);
        if constexpr (thread) m.impulse_c += F_c;
        ++m.step;
        const Stages<parts_of_pass * i> stages{other};
        if (plucked_[i]) return pass<true, thread, true, read>(m, F_b, F_c, F_e_.of[i], stages);
        return pass<true, thread, false, read>(m, F_b, F_c, 0, stages);
    }
    HWY_INLINE void next_pluck() {
        for (int i = 0; i < 2 && strings_[i]; ++i) {
            const TwoPoint& m = *strings_[i];
            const long into = m.step - m.pluck_first;
            plucked_[i] = into >= 0 && into < m.pluck_steps;
            if (plucked_[i]) F_e_.of[i] = m.pluck[into];
            else if (F_e_.of[i] != 0) F_e_.of[i] = 0;  // to store one lane makes the load of both wait
        }
    }

    template <int first>
    HWY_INLINE void rest() {
        if constexpr (first <= 5) {
            stage<first>();
            rest<first + 1>();
        }
    }

    // step_own to its forces: every case of solve_linear_contact is worked out and one chosen.
    template <int n>
    HWY_INLINE void stage() {
        const L d;
        const W zero = hn::Zero(d), one = hn::Set(d, 1), half = hn::Set(d, 0.5), two = hn::Set(d, 2), four = hn::Set(d, 4), k = k_.all();
        if constexpr (n == 1) {
            W u_b = at_b_.u() + theta_be_.all() * F_e_.all();
            if constexpr (thread) {
                const W u_c = at_c_.u() + theta_ce_.all() * F_e_.all();
                v_ = (k_c_.all() * (h_c_.all() - at_c_.y()) - phi_c_.all() * u_c) * inverse_c_.all();  // (47)
            }
            eta_ = h_b_.all() - at_b_.y();
            b_ = hn::Neg(u_b);
            if constexpr (thread) b_ = b_ - theta_bc_.all() * v_;  // (48)
        }
        if constexpr (n == 2) {
            const W phi = half * theta_.all() * k, free = eta_ + b_;
            stiff_ = one + phi;
            in_ = hn::Gt(eta_, zero);
            touches_ = hn::Or(in_, hn::Gt(free, zero));
            stays_ = hn::And(in_, hn::Gt(eta_ * (one - phi) + b_, zero));
            gap_ = hn::Neg(eta_);
            p_ = hn::IfThenElse(in_, b_, gap_ - free);  // leaves by r, else enters to x: both by a quadratic
            square_ = p_ * p_ + hn::IfThenElse(in_, four * phi * eta_ * eta_, four * stiff_ * free * gap_);
            product_ = hn::IfThenElse(in_, two * phi * eta_ * eta_, two * free * gap_);
            root_ = hn::Sqrt(square_);
            staying_ = k * (eta_ + half * b_) / stiff_;
        }
        if constexpr (n == 3) {
            const auto above = hn::Gt(p_, zero);
            x_ = hn::IfThenElse(above, product_, half * (root_ - p_)) / hn::IfThenElse(above, p_ + root_, hn::IfThenElse(in_, one, stiff_));
        }
        if constexpr (n == 4) {
            const W load = half * k * hn::IfThenElse(in_, eta_, x_);
            moving_ = hn::IfThenElse(in_, load * eta_, load) / hn::IfThenElse(in_, x_, gap_ + x_);
        }
        if constexpr (n == 5) {
            const W F_b = hn::IfThenElseZero(touches_, hn::IfThenElse(stays_, staying_, hn::IfThenElse(in_, moving_, moving_ * x_)));
            F_b_.set(F_b);
            if constexpr (thread) F_c_.set(v_ - beta_c_.all() * F_b);  // (46)
        }
    }
    W v_, eta_, b_, stiff_, gap_, p_, square_, product_, root_, staying_, x_, moving_;
    hn::Mask<L> in_, touches_, stays_;

    TwoPoint* strings_[2];
    bool plucked_[2] = {};
    Lanes k_, theta_, theta_bc_, theta_be_, theta_ce_, h_b_, k_c_, h_c_, phi_c_, inverse_c_, beta_c_;
    Lanes F_e_, F_b_, F_c_;
    Dotted at_b_, at_c_;

    struct Member {
        double TwoPoint::*of_string;
        Lanes TwoPointPair::*lanes;
    };
    using M = TwoPoint;
    using S = TwoPointPair;
    static constexpr Member constants_[] = {{&M::theta, &S::theta_},       {&M::theta_bc, &S::theta_bc_}, {&M::theta_be, &S::theta_be_},
                                            {&M::theta_ce, &S::theta_ce_}, {&M::h_b, &S::h_b_},           {&M::k_c, &S::k_c_},
                                            {&M::h_c, &S::h_c_},           {&M::phi_c, &S::phi_c_},       {&M::inverse_c, &S::inverse_c_},
                                            {&M::beta_c, &S::beta_c_}};
};

}  // namespace HWY_NAMESPACE
}  // namespace jvari
HWY_AFTER_NAMESPACE();
#endif
