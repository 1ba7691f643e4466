#include "schemes/modal/kernels/modal_energies.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "schemes/modal/kernels/modal_energies.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

#include "schemes/modal/kernels/vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace jvari {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE V load(const double* x, int j) {
    return hn::Load(D(), x + j);
}
HWY_INLINE double total(V x) {
    return hn::GetLane(hn::SumOfLanes(D(), x));
}
// start + e F: a force that is absent has no e
HWY_INLINE V forced(const ModalPass& m, int j, V start) {
    const D d;
    if (m.e_b) start = hn::MulAdd(load(m.e_b, j), hn::Set(d, m.F_b), start);
    if (m.e_c) start = hn::MulAdd(load(m.e_c, j), hn::Set(d, m.F_c), start);
    if (m.e_e) start = hn::MulAdd(load(m.e_e, j), hn::Set(d, m.F_e), start);
    return start;
}

ModalSpending spending_of_two(const ModalPass& m, const double* loss, const double* g_e) {
    const D d;
    V lost = hn::Zero(d), given = hn::Zero(d);
    for (int j = 0; j < m.size; j += static_cast<int>(hn::Lanes(d))) {
        const V s = forced(m, j, load(m.v, j));
        lost = hn::MulAdd(load(loss, j), hn::Mul(s, s), lost);
        if (g_e) given = hn::MulAdd(load(g_e, j), s, given);
    }
    return {total(lost), total(given)};
}

double stored_of_two(const ModalPass& m, const double* J, const double* A) {
    const D d;
    const V half = hn::Set(d, 0.5);
    V by_q = hn::Zero(d), by_x = hn::Zero(d);
    for (int j = 0; j < m.size; j += static_cast<int>(hn::Lanes(d))) {
        const V x = load(m.x, j), stiff = hn::Mul(load(A, j), x), q = hn::MulAdd(hn::Mul(half, load(J, j)), load(m.v, j), stiff);
        by_q = hn::MulAdd(q, q, by_q);
        by_x = hn::MulAdd(stiff, x, by_x);
    }
    return total(hn::Add(by_q, by_x));
}

ThreePointEnergies energies_of_three(const ModalPass& m, const double* W, const double* den, const double* g_e) {
    const D d;
    V lost = hn::Zero(d), given = hn::Zero(d), after = hn::Zero(d), before = hn::Zero(d);
    for (int j = 0; j < m.size; j += static_cast<int>(hn::Lanes(d))) {
        const V x = load(m.x, j), v = load(m.v, j), p = load(m.p, j), r = load(m.r, j), w = load(W, j), kinetic = load(den, j);
        const V next = forced(m, j, hn::NegMulAdd(r, x, hn::NegMulAdd(p, v, v)));
        const V s = hn::Add(next, v), twice = hn::Add(x, x);
        const auto energy = [&](V increment, V sum) HWY_ATTR __attribute__((always_inline)) {
            return hn::MulAdd(hn::Mul(kinetic, increment), increment, hn::Mul(hn::Mul(r, sum), sum));
        };
        lost = hn::MulAdd(hn::Mul(w, p), hn::Mul(s, s), lost);
        if (g_e) given = hn::MulAdd(load(g_e, j), s, given);
        after = hn::MulAdd(w, energy(next, hn::Add(twice, next)), after);
        before = hn::MulAdd(w, energy(v, hn::Sub(twice, v)), before);
    }
    return {{total(lost), total(given)}, total(after), total(before)};
}

}  // namespace HWY_NAMESPACE
}  // namespace jvari
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace jvari {
HWY_EXPORT(spending_of_two);
HWY_EXPORT(stored_of_two);
HWY_EXPORT(energies_of_three);

ModalSpending two_point_spending(const ModalPass& m, const double* D, const double* g_e) {
    return HWY_DYNAMIC_DISPATCH(spending_of_two)(m, D, g_e);
}
double two_point_stored(const ModalPass& m, const double* J, const double* A) {
    return HWY_DYNAMIC_DISPATCH(stored_of_two)(m, J, A);
}
ThreePointEnergies three_point_energies(const ModalPass& m, const double* W, const double* den, const double* g_e) {
    return HWY_DYNAMIC_DISPATCH(energies_of_three)(m, W, den, g_e);
}
}  // namespace jvari
#endif
