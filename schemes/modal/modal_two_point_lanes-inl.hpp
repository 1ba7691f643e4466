// The contact equations of up to four strings solved at once, a string per lane: linear contact, the modes' own compliance (van Walstijn et
// al. 2016, eqs 44-48). One string waits for its root and its divisions between two passes; four share the wait, and no branch depends on
// whether a string touches. The operations of a lane are those of step_own and solve_linear_contact, in their order: the same bits.
#if defined(JVARI_MODAL_TWO_POINT_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef JVARI_MODAL_TWO_POINT_LANES
#undef JVARI_MODAL_TWO_POINT_LANES
#else
#define JVARI_MODAL_TWO_POINT_LANES
#endif

#include <span>

#include "schemes/modal/modal_two_point_pass-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace jvari {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using L = hn::CappedTag<double, two_point_together>;  // four strings, or two at a time
using W = hn::Vec<L>;

struct alignas(64) PerString {
    double of[two_point_together] = {};  // zero where there is no string: no barrier, no force
    W at(int k) const { return hn::Load(L(), of + k); }
    void set(int k, W w) { hn::Store(w, L(), of + k); }
};

// Force of solve_linear_contact, every case worked out and one chosen.
HWY_INLINE W linear_force(W k, W eta, W b, W theta) {
    const L d;
    const W zero = hn::Zero(d), one = hn::Set(d, 1), half = hn::Set(d, 0.5), two = hn::Set(d, 2), four = hn::Set(d, 4);
    const W phi = half * theta * k, stiff = one + phi, free = eta + b;
    const auto in = hn::Gt(eta, zero);
    const auto touches = hn::Or(in, hn::Gt(free, zero));
    const auto stays = hn::And(in, hn::Gt(eta * (one - phi) + b, zero));
    const W staying = k * (eta + half * b) / stiff;
    const W gap = hn::Neg(eta), p = hn::IfThenElse(in, b, gap - free);  // leaves by r, else enters to x: both by a quadratic
    const W root = hn::Sqrt(p * p + hn::IfThenElse(in, four * phi * eta * eta, four * stiff * free * gap));
    const auto above = hn::Gt(p, zero);
    const W product = hn::IfThenElse(in, two * phi * eta * eta, two * free * gap);
    const W x = hn::IfThenElse(above, product, half * (root - p)) / hn::IfThenElse(above, p + root, hn::IfThenElse(in, one, stiff));
    const W load = half * k * hn::IfThenElse(in, eta, x);
    const W moving = hn::IfThenElse(in, load * eta, load) / hn::IfThenElse(in, x, gap + x);
    return hn::IfThenElseZero(touches, hn::IfThenElse(stays, staying, hn::IfThenElse(in, moving, moving * x)));
}

template <bool thread>
class TwoPointLanes {
public:
    explicit TwoPointLanes(std::span<TwoPoint* const> strings) : strings_(strings) {
        for (std::size_t i = 0; i < strings.size(); ++i) {
            const TwoPoint& m = *strings[i];
            k_.of[i] = m.barrier.k;
            for (const auto& [constant, lanes] : constants_) (this->*lanes).of[i] = m.*constant;
            for (const auto& [state, lanes] : states_) (this->*lanes).of[i] = m.*state;
        }
    }
    void leave() const {  // the strings as they are now
        for (std::size_t i = 0; i < strings_.size(); ++i)
            for (const auto& [state, lanes] : states_) strings_[i]->*state = (this->*lanes).of[i];
    }

    void take_impulses() {  // what a row has so far
        for (std::size_t i = 0; i < strings_.size(); ++i) {
            impulse_b_.of[i] = strings_[i]->impulse_b;
            impulse_c_.of[i] = strings_[i]->impulse_c;
        }
    }
    void give_impulses() const {
        for (std::size_t i = 0; i < strings_.size(); ++i) {
            strings_[i]->impulse_b = impulse_b_.of[i];
            strings_[i]->impulse_c = impulse_c_.of[i];
        }
    }

    // One step of each string; plucked[i]: its force acts, in F_e.
    template <bool plucks>
    HWY_INLINE void step(const bool* plucked) {
        for (int i = 0; i < two_point_together; i += static_cast<int>(hn::Lanes(L()))) forces<plucks>(i);
        Dots next[two_point_together];
        for (Dots& of : next) of = {hn::Zero(D()), hn::Zero(D()), hn::Zero(D()), hn::Zero(D())};
        for (std::size_t i = 0; i < strings_.size(); ++i) {
            TwoPoint& m = *strings_[i];
            if (plucks && plucked[i]) next[i] = pass<true, thread, true>(m, F_b_.of[i], F_c_.of[i], F_e.of[i]);
            else next[i] = pass<true, thread, false>(m, F_b_.of[i], F_c_.of[i], 0);
            ++m.step;
        }
        const auto sum = [&next](V Dots::*dot, PerString& to)
                             HWY_ATTR { sums(next[0].*dot, next[1].*dot, next[2].*dot, next[3].*dot, to.of); };
        sum(&Dots::y_b, y_b_);
        sum(&Dots::u_b, u_b_);
        if constexpr (thread) {
            sum(&Dots::y_c, y_c_);
            sum(&Dots::u_c, u_c_);
        }
    }
    PerString F_e;  // [N]

private:
    template <bool plucks>
    HWY_INLINE void forces(int i) {
        const L d;
        W u_b = u_b_.at(i), u_c = u_c_.at(i), v = hn::Zero(d);
        if constexpr (plucks) {
            const W F = F_e.at(i);
            const auto acts = hn::Ne(F, hn::Zero(d));
            u_b = hn::IfThenElse(acts, u_b + theta_be_.at(i) * F, u_b);
            if constexpr (thread) u_c = hn::IfThenElse(acts, u_c + theta_ce_.at(i) * F, u_c);
        }
        if constexpr (thread) v = (k_c_.at(i) * (h_c_.at(i) - y_c_.at(i)) - phi_c_.at(i) * u_c) * inverse_c_.at(i);  // (47)
        const W eta = h_b_.at(i) - y_b_.at(i);
        W b = hn::Neg(u_b);
        if constexpr (thread) b = b - theta_bc_.at(i) * v;  // (48)
        const W F_b = linear_force(k_.at(i), eta, b, theta_.at(i));
        least_.set(i, hn::Min(F_b, least_.at(i)));
        depth_.set(i, hn::Max(eta, depth_.at(i)));
        impulse_b_.set(i, impulse_b_.at(i) + F_b);
        F_b_.set(i, F_b);
        if constexpr (thread) {
            const W F_c = v - beta_c_.at(i) * F_b;  // (46)
            impulse_c_.set(i, impulse_c_.at(i) + F_c);
            F_c_.set(i, F_c);
        }
    }

    std::span<TwoPoint* const> strings_;
    PerString k_, theta_, theta_bc_, theta_be_, theta_ce_, h_b_, k_c_, h_c_, phi_c_, inverse_c_, beta_c_;
    PerString y_b_, y_c_, u_b_, u_c_, impulse_b_, impulse_c_, least_, depth_, F_b_, F_c_;

    struct Member {
        double TwoPoint::*of_string;
        PerString TwoPointLanes::*lanes;
    };
    using M = TwoPoint;
    using S = TwoPointLanes;
    static constexpr Member constants_[] = {{&M::theta, &S::theta_},       {&M::theta_bc, &S::theta_bc_}, {&M::theta_be, &S::theta_be_},
                                            {&M::theta_ce, &S::theta_ce_}, {&M::h_b, &S::h_b_},           {&M::k_c, &S::k_c_},
                                            {&M::h_c, &S::h_c_},           {&M::phi_c, &S::phi_c_},       {&M::inverse_c, &S::inverse_c_},
                                            {&M::beta_c, &S::beta_c_}};
    static constexpr Member states_[] = {{&M::y_b, &S::y_b_}, {&M::y_c, &S::y_c_},           {&M::u_b, &S::u_b_},
                                         {&M::u_c, &S::u_c_}, {&M::least_force, &S::least_}, {&M::depth, &S::depth_}};
};

}  // namespace HWY_NAMESPACE
}  // namespace jvari
HWY_AFTER_NAMESPACE();
#endif
