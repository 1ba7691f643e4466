// Linear contacts in touch, their stiff oscillation split off. With p the displacements of the
// contact points from their barriers,
//
//     p'' + H_0 K p' + H_1 K p + sum_{j >= 2} H_j K I^(j-1) p = r''
//     (I: integral from 0; r: the points' motion if they let go at 0)
//
// H_0 is zero where they push nothing but the string's modes: each touching point then has one fast
// pair. With something in series (in_series.hpp) it has two decays, or a damped pair. The solution
// is p = p_s + Re sum_k beta_k v_k e^(lambda_k u): lambda and v from (lambda^2 + sum_j H_j K
// lambda^(1-j)) v = 0, and a polynomial as slow as the string, p_s = G (r'' + Re sum_k beta_k q_k),
// with G the inverse of the operator on truncated vectors of derivatives and q_k,n = sum_{j >= n+2}
// H_j K v_k lambda_k^(n+1-j). beta follows from p(0) = r(0) and p'(0) = r'(0) - H_0 K r(0). The
// series in G is asymptotic: see longest_reach.
//
// Windows that follow a stiff thread may be short beside the slower of two decays. That decay then
// stays in p_s. Of order 1, G is the inverse of p' + H_0 K p + H_1 K I p + ..., with r' in place of
// r'', and beta follows from p(0). A solution spans as much as the slow part's growth allows.
//
// Where some direction is not stiff nothing is split off: p follows from r by the resolvent, over a
// window or a part of it. All of it is made once per set of touching points. Leaves out: sets with
// such a direction beside one so stiff that spans are short; solves() is false for them.
#pragma once

#include <complex>
#include <span>
#include <vector>

namespace jvari {

class MacroWindow;

class TouchingSet {
public:
    TouchingSet(const MacroWindow&, std::span<const int> points, std::span<const double> stiffness);

    bool solves() const { return pairs_ > 0 || !resolvent_.empty(); }
    int pairs() const { return pairs_; }
    // growth of the unsplit part: limit on the ratio between its successive derivatives
    double growth() const { return growth_; }
    double span() const { return span_; }  // how far a solution reaches [window]
    const std::vector<int>& points() const { return points_; }
    const std::complex<double>* rates() const { return rate_.data(); }
    // per beta
    std::complex<double> pair_force(int which, int pair) const {
        return -k_[which] * shape_[points_[which] * pairs_ + pair];
    }

    // Solves from r[contact][stride], derivatives. Returns the derivatives of every contact's slow
    // part, path[contact][stride], and the amplitudes of its pairs, amplitude[contact][pairs].
    void solve(const double* r, double* path, std::complex<double>* amplitude) noexcept;

    // from the last solve()
    std::complex<double> beta(int pair) const { return {beta_[2 * pair], -beta_[2 * pair + 1]}; }

    // at u [N]
    double force(int which, const double* path, const std::complex<double>* amplitude,
                 double u) const noexcept;

    // int_0^u (u - w)^i/i! F_b(w) dw, i < size, for the contact points()[which], right for i <
    // count.
    void moments(int which, const double* path, const std::complex<double>* amplitude, double u,
                 int count, double* m) const noexcept;

private:
    struct Operator;
    struct Split;
    bool split(const Operator&, int order);
    void put_pairs(const Split&);
    void soften() noexcept;
    const MacroWindow* window_;
    std::vector<int> points_;
    std::vector<double> k_;
    int pairs_ = 0, order_ = 2;  // derivatives of r that give the slow part
    double growth_ = 0, span_ = 1;
    std::vector<std::complex<double>> rate_, shape_;  // [pair], [contact][pair]
    // for a soft set: r -> path over its span [contact][point][column: derivative][row]
    std::vector<double> resolvent_;
    // G [column: derivative][column: point][row: point][row: derivative]
    std::vector<double> inverse_;
    // p(0), p'(0) -> Re beta and -Im beta [pair][2][2 x points]
    std::vector<double> start_;
    // contribution of a pair's Re beta and -Im beta to the slow part [contact][pair][2][size]
    std::vector<double> slow_;
    // p' = r' - this x p at a start [touching contact]
    std::vector<double> pushed_at_once_;
    std::vector<double> beta_;  // [pair][Re, -Im]
};

}  // namespace jvari
