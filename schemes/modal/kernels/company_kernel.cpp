// The step of company_kernel.hpp (van Walstijn et al. 2016, eqs 41-52), compiled once per instruction set by Highway.
//
// Strings that are alike share their weights and fill two of the widest vectors; others go by four. Nothing branches on what one lane does:
// every case of solve_linear_contact is worked out and one chosen.
#include "schemes/modal/kernels/company_kernel.hpp"

#include <algorithm>
#include <limits>
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "schemes/modal/kernels/company_kernel.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "schemes/modal/kernels/vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace jvari {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128 && !HWY_HAVE_SCALABLE
namespace hn = hwy::HWY_NAMESPACE;

constexpr long steps_between_sums = 64;  // of y_b and y_c over the modes

enum class Besides { nothing, read, ledger };  // what a pass does beside stepping

template <bool alike, bool thread>
class Stepper {
public:
    using Tag = std::conditional_t<alike, D, hn::CappedTag<double, 4>>;
    using W = hn::Vec<Tag>;
    static constexpr int width = hn::MaxLanes(Tag());
    static constexpr int vectors = alike ? 2 : 4 / width;
    static constexpr int lanes = vectors * width;

    static void begin(Company& m) {
        m.F_b = m.F_c = m.F_e = m.impulse_b = m.impulse_c = m.supplied = m.dissipated = m.least_force = m.most_force = m.depth = {};
        m.step = m.steady_until = 0;
        m.read_at = -1;
        sum_at_points<of_y>(m, m.y_b, m.y_c);
        sum_at_points<of_r>(m, m.r_b, m.r_c);
    }

    static void advance(Company& m, std::span<const CompanyColumn> columns, const Block& asks) {
        const bool read_in_pass = m.steps_per_row == 1 && !m.reads.empty() && m.reads.front().on_u.size() == 0;
        for (int n = 0; n < asks.rows; ++n) {
            const int waiting = n % company_rows + 1;
            write(m, &m.rows[(waiting - 1) * quantities(m)], asks.energy);
            if (waiting == company_rows || n + 1 == asks.rows) hand_out(m, columns, n + 1 - waiting, waiting);
            for (long left = m.steps_per_row; left > 0; left -= steps_between_questions) {
                for (long i = std::min(left, steps_between_questions); i > 0; --i) step(m, read_in_pass, asks.energy);
                if (left > steps_between_questions && asks.stopped()) return;
            }
        }
    }

private:
    static std::size_t quantities(const Company& m) { return first_read + m.reads.size(); }
    static void hand_out(const Company& m, std::span<const CompanyColumn> columns, int from, int rows) {
        const std::size_t stride = quantities(m);
        for (const CompanyColumn& c : columns)
            for (int n = 0; n < rows; ++n) c.to[from + n] = m.rows[n * stride + c.quantity].of[c.lane];
    }

    static HWY_INLINE W zero() { return hn::Zero(Tag()); }
    static HWY_INLINE W number(double x) { return hn::Set(Tag(), x); }
    static HWY_INLINE W get(const PerString& x, int v) { return hn::Load(Tag(), x.of + v * width); }
    static HWY_INLINE void set(PerString& x, int v, W value) { hn::Store(value, Tag(), x.of + v * width); }
    static HWY_INLINE void add(PerString& x, int v, W more) { set(x, v, hn::Add(get(x, v), more)); }
    static HWY_INLINE W weight(const double* w, std::ptrdiff_t i, int v) {
        if constexpr (alike) return hn::Set(Tag(), w[i]);
        else return hn::Load(Tag(), w + i * lanes + v * width);
    }
    static constexpr int of_y = 0, of_r = 1;  // of what a mode carries
    static HWY_INLINE double* state(Company& m, std::ptrdiff_t mode, int which, int v) {
        return m.state.data() + (2 * mode + which) * lanes + v * width;
    }
    // In a register from here on: GCC otherwise reads a weight from memory at each use.
    static HWY_INLINE W held(W w) {
#if HWY_ARCH_X86 && HWY_COMPILER_GCC
        asm("" : "+v"(w.raw));
#endif
        return w;
    }

    // A sum over the modes in each lane. One vector alone is summed over even and odd modes, so that adding does not wait for itself.
    static constexpr int turns = vectors == 1 ? 2 : 1, places = turns * vectors;
    struct Sum {
        W part[places];
        HWY_INLINE Sum() {
            for (W& p : part) p = zero();
        }
        HWY_INLINE void add(int place, W a, W b) { part[place] = hn::MulAdd(a, b, part[place]); }
        HWY_INLINE W of(int v) const { return turns == 2 ? hn::Add(part[0], part[1]) : part[v]; }
    };

    template <class At>
    static HWY_INLINE void over_modes(int modes, At at) {  // at(mode, turn)
        int i = 0;
        for (; i + turns <= modes; i += turns)
            for (int turn = 0; turn < turns; ++turn) at(i + turn, turn);
        if (i < modes) at(i, 0);
    }
    template <class At>
    static HWY_INLINE void over_vectors(int modes, At at) {  // at(mode, vector, place in a Sum)
        over_modes(modes, [&](int i, int turn) HWY_ATTR {
            for (int v = 0; v < vectors; ++v) at(i, v, turn * vectors + v);
        });
    }
    // Of one mode; often: used more than once by a vector.
    template <bool often>
    struct Weight {
        W w[alike ? 1 : vectors];
        HWY_INLINE Weight(const double* from, std::ptrdiff_t i) {
            for (int v = 0; v < (alike ? 1 : vectors); ++v) w[v] = alike || often ? held(weight(from, i, v)) : weight(from, i, v);
        }
        HWY_INLINE W of(int v) const { return w[alike ? 0 : v]; }
    };

    template <int which>
    static void sum_at_points(Company& m, PerString& at_b, PerString& at_c) {
        Sum b, c;
        over_vectors(m.modes, [&](int i, int v, int place) HWY_ATTR {
            const W x = hn::Load(Tag(), state(m, i, which, v));
            b.add(place, weight(m.weights.data(), i * company_weights + on_bridge, v), x);
            if constexpr (thread) c.add(place, weight(m.weights.data(), i * company_weights + on_thread, v), x);
        });
        for (int v = 0; v < vectors; ++v) {
            set(at_b, v, b.of(v));
            set(at_c, v, c.of(v));
        }
    }

    static HWY_INLINE void step(Company& m, bool read, bool ledger) {
        if (m.step >= m.steady_until) look_for_plucks(m);
        if (m.step % steps_between_sums == 0) sum_at_points<of_y>(m, m.y_b, m.y_c);
        if (ledger) pass<Besides::ledger, true>(m);
        else if (m.plucked) read ? pass<Besides::read, true>(m) : pass<Besides::nothing, true>(m);
        else read ? pass<Besides::read, false>(m) : pass<Besides::nothing, false>(m);
        ++m.step;
    }

    static void look_for_plucks(Company& m) {
        m.plucked = false;
        m.steady_until = std::numeric_limits<long>::max();
        for (const CompanyPluck& p : m.plucks) {
            if (p.steps == 0) continue;
            const long end = p.first + p.steps + 1;  // its last force is that of the step before
            if (m.step >= end) continue;
            const bool now = m.step >= p.first;
            m.plucked = m.plucked || now;
            m.steady_until = std::min(m.steady_until, now ? end : p.first);
        }
    }
    static void plucks_now(const Company& m, PerString& force) {
        for (int k = 0; k < lanes; ++k) {
            const long into = m.step - m.plucks[k].first;
            force.of[k] = into >= 0 && into < m.plucks[k].steps ? m.plucks[k].force[into] : 0;
        }
    }

    // solve_linear_contact (contact/contact.hpp)
    static HWY_INLINE W contact_force(W k, W eta, W b, W theta) {
        const W one = number(1), half = number(0.5), two = number(2), four = number(4);
        const W phi = half * theta * k, free = eta + b, stiff = one + phi;
        const auto in = hn::Gt(eta, zero()), touches = hn::Or(in, hn::Gt(free, zero()));
        const auto stays = hn::And(in, hn::Gt(eta * (one - phi) + b, zero()));
        const W gap = hn::Neg(eta), p = hn::IfThenElse(in, b, gap - free);  // leaves by r, else enters to x: both by a quadratic
        const W root = hn::Sqrt(p * p + hn::IfThenElse(in, four * phi * eta * eta, four * stiff * free * gap));
        const W product = hn::IfThenElse(in, two * phi * eta * eta, two * free * gap);
        const auto above = hn::Gt(p, zero());
        const W x = hn::IfThenElse(above, product, half * (root - p)) / hn::IfThenElse(above, p + root, hn::IfThenElse(in, one, stiff));
        const W load = half * k * hn::IfThenElse(in, eta * eta, x * x);
        const W over = hn::IfThenElse(in, x, gap + x);
        return hn::IfThenElseZero(touches, hn::IfThenElse(stays, k * (eta + half * b), load) / hn::IfThenElse(stays, stiff, over));
    }

    struct Forces {  // of the step and the one before together
        W b[vectors], c[vectors], e[vectors];
    };

    // The points' scalar step: forces by (45)-(48), then what the points move.
    template <bool pluck, bool ledger>
    static HWY_INLINE void solve(Company& m, Forces& both, PerString& F_e) {
        for (int v = 0; v < vectors; ++v) {
            const W before_b = get(m.F_b, v), before_c = get(m.F_c, v);
            const W theta_bb = get(m.theta_bb, v), theta_bc = get(m.theta_bc, v), theta_cc = get(m.theta_cc, v);
            W u_b = hn::MulAdd(theta_bb, before_b, get(m.r_b, v)), u_c = zero(), F_c = zero(), free = zero();
            if constexpr (pluck) {
                both.e[v] = get(m.F_e, v) + get(F_e, v);
                u_b = hn::MulAdd(get(m.theta_be, v), both.e[v], u_b);
            }
            if constexpr (thread) {
                u_b = hn::MulAdd(theta_bc, before_c, u_b);
                u_c = hn::MulAdd(theta_cc, before_c, hn::MulAdd(theta_bc, before_b, get(m.r_c, v)));
                if constexpr (pluck) u_c = hn::MulAdd(get(m.theta_ce, v), both.e[v], u_c);
                free = (get(m.k_c, v) * (get(m.h_c, v) - get(m.y_c, v)) - get(m.phi_c, v) * u_c) * get(m.inverse_c, v);  // (47)
            }
            const W eta = get(m.h_b, v) - get(m.y_b, v), b = thread ? hn::Neg(u_b) - theta_bc * free : hn::Neg(u_b);  // (48)
            const W F_b = contact_force(get(m.k, v), eta, b, get(m.theta, v));
            if constexpr (thread) F_c = free - get(m.beta_c, v) * F_b;  // (46)

            W s_b = hn::MulAdd(theta_bb, F_b, u_b);
            if constexpr (thread) {
                s_b = hn::MulAdd(theta_bc, F_c, s_b);
                const W s_c = hn::MulAdd(theta_cc, F_c, hn::MulAdd(theta_bc, F_b, u_c));  // (44)
                add(m.y_c, v, s_c);
                add(m.impulse_c, v, F_c);
                if constexpr (ledger) add(m.dissipated, v, get(m.lost_c, v) * s_c * s_c);
                both.c[v] = before_c + F_c;
                set(m.F_c, v, F_c);
            }
            add(m.y_b, v, s_b);
            add(m.impulse_b, v, F_b);
            both.b[v] = before_b + F_b;
            set(m.F_b, v, F_b);
            set(m.least_force, v, hn::Min(get(m.least_force, v), F_b));
            set(m.most_force, v, hn::Max(get(m.most_force, v), F_b));
            set(m.depth, v, hn::Max(get(m.depth, v), eta));
        }
    }

    template <Besides besides, bool pluck>
    static HWY_INLINE void pass(Company& m) {
        constexpr bool ledger = besides == Besides::ledger;
        PerString F_e;
        if constexpr (pluck) plucks_now(m, F_e);
        Forces both;
        solve<pluck, ledger>(m, both, F_e);
        const double *weights = m.weights.data(), *g_e = m.g_e.data(), *on_y = besides == Besides::read ? m.reads.front().on_y.data() : g_e;
        double* const all = m.state.data();
        Sum b, c, heard, lost, given;
        const auto mode = [&](std::ptrdiff_t i, int turn) HWY_ATTR __attribute__((always_inline)) {
            double *y = all + 2 * i * lanes, *r = y + lanes;
            const Weight<true> g_b(weights, i * company_weights + on_bridge), g_c(weights, i * company_weights + on_thread);
            const Weight<false> of_c(weights, i * company_weights + on_c), loss(weights, i * company_weights + on_loss), listen(on_y, i),
                push(g_e, i);
            for (int v = 0; v < vectors; ++v) {
                const int place = turn * vectors + v;
                W s = hn::Load(Tag(), r + v * width);
                if constexpr (pluck) s = hn::MulAdd(push.of(v), both.e[v], s);
                if constexpr (thread) s = hn::MulAdd(g_c.of(v), both.c[v], s);
                s = hn::MulAdd(g_b.of(v), both.b[v], s);                  // (41)
                const W y1 = hn::Add(hn::Load(Tag(), y + v * width), s);  // (40)
                const W r1 = hn::NegMulAdd(of_c.of(v), y1, hn::NegMulAdd(loss.of(v), s, s));
                hn::Store(y1, Tag(), y + v * width);
                hn::Store(r1, Tag(), r + v * width);
                b.add(place, g_b.of(v), r1);
                if constexpr (thread) c.add(place, g_c.of(v), r1);
                if constexpr (besides == Besides::read) heard.add(place, listen.of(v), y1);
                if constexpr (ledger) {
                    lost.add(place, loss.of(v) * s, s);
                    given.add(place, push.of(v), s);
                }
            }
        };
        over_modes(m.modes, mode);
        for (int v = 0; v < vectors; ++v) {
            set(m.r_b, v, b.of(v));
            if constexpr (thread) set(m.r_c, v, c.of(v));
            if constexpr (besides == Besides::read) set(m.reads.front().value, v, heard.of(v));
            if constexpr (ledger) {
                add(m.dissipated, v, number(0.5) * lost.of(v));  // (52), B/J = loss/2
                add(m.supplied, v, get(F_e, v) * given.of(v));   // (51)
            }
        }
        if constexpr (besides == Besides::read) m.read_at = m.step + 1;
        if constexpr (pluck) m.F_e = F_e;
    }

    static HWY_INLINE W u_of(Company& m, int i, int v) {  // r + sum_z g_z F_z'
        const auto w = [&](int column) HWY_ATTR { return weight(m.weights.data(), i * company_weights + column, v); };
        W u = hn::MulAdd(w(on_bridge), get(m.F_b, v), hn::Load(Tag(), state(m, i, of_r, v)));
        if constexpr (thread) u = hn::MulAdd(w(on_thread), get(m.F_c, v), u);
        return hn::MulAdd(weight(m.g_e.data(), i, v), get(m.F_e, v), u);
    }

    static void read(Company& m, CompanyRead& tap) {
        Sum heard;
        over_vectors(m.modes, [&](int i, int v, int place) HWY_ATTR {
            heard.add(place, weight(tap.on_y.data(), i, v), hn::Load(Tag(), state(m, i, of_y, v)));
            if (tap.on_u.size() > 0) heard.add(place, weight(tap.on_u.data(), i, v), u_of(m, i, v));
        });
        for (int v = 0; v < vectors; ++v) set(tap.value, v, heard.of(v));
    }

    // Stored energy (49) as in modal_two_point_kernel.cpp; J = 1/(1 - c/4 - loss/2).
    static void store(Company& m, PerString* row) {
        Sum H;
        const W half = number(0.5), quarter = number(0.25);
        over_vectors(m.modes, [&](int i, int v, int place) HWY_ATTR {
            const W c = quarter * weight(m.weights.data(), i * company_weights + on_c, v);
            const W loss = half * weight(m.weights.data(), i * company_weights + on_loss, v);
            const W y = hn::Load(Tag(), state(m, i, of_y, v)), stiff = c * y;
            const W q = hn::MulAdd(half, u_of(m, i, v), stiff);
            H.add(place, q / (number(1) - c - loss), q);
            H.add(place, stiff, y);
        });
        for (int v = 0; v < vectors; ++v) {
            const W eta = hn::Max(get(m.h_b, v) - get(m.y_b, v), zero()), pull = get(m.h_c, v) - get(m.y_c, v);
            W all = hn::MulAdd(half * get(m.k, v) * eta, eta, H.of(v));
            if constexpr (thread) all = hn::MulAdd(half * get(m.k_c, v) * pull, pull, all);
            set(row[stored_energy], v, all);
        }
        row[supplied_energy] = m.supplied;
        row[dissipated_energy] = m.dissipated;
        m.supplied = m.dissipated = {};
    }

    static HWY_INLINE void write(Company& m, PerString* row, bool energy) {
        for (std::size_t k = m.read_at == m.step ? 1 : 0; k < m.reads.size(); ++k) read(m, m.reads[k]);
        const W mean = number(1.0 / m.steps_per_row);
        for (int v = 0; v < vectors; ++v) {
            const W b = get(m.impulse_b, v), c = get(m.impulse_c, v);
            set(row[bridge_mean], v, b * mean);
            set(row[thread_mean], v, c * mean);
            set(row[driving_mean], v, hn::Neg(b + c) * mean);
            set(m.impulse_b, v, zero());
            set(m.impulse_c, v, zero());
            for (std::size_t k = 0; k < m.reads.size(); ++k) set(row[first_read + k], v, get(m.reads[k].value, v));
        }
        if (energy) store(m, row);
    }
};

template <bool alike, bool thread>
CompanyKernel kernel() {
    using S = Stepper<alike, thread>;
    return {S::lanes, S::begin, S::advance};
}
CompanyKernel choose(bool alike, bool thread) {
    if (alike) return thread ? kernel<true, true>() : kernel<true, false>();
    return thread ? kernel<false, true>() : kernel<false, false>();
}

#else
CompanyKernel choose(bool, bool) {  // vectors of no fixed length, or none
    return {};
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace jvari
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace jvari {
HWY_EXPORT(choose);
CompanyKernel company_kernel(bool alike, bool thread) {
    return HWY_DYNAMIC_DISPATCH(choose)(alike, thread);
}
}  // namespace jvari
#endif
