// A string in its modes by three-point steps: Issanchou et al. 2016, eqs 14 and 20-21, in increments d^n = q^n - q^{n-1}:
//
//     d^{n+1} = C~ d^n - num q^n + sum_p e_p F_p,   q^{n+1} = q^n + d^{n+1},   e_p = gain g_p;   r_p = y_p^{n+1} - y_p^{n-1}
//
// which is q^{n+1} = C q^n - C~ q^{n-1} + ... without its cancellation at high rates. Theta_pq = g_p.e_q. gain = dt^2/m unless a scheme
// says else; W, the inertia that its energy shows, is the modal mass then. The energy is eq 21 with the constants C1 = (1 + C~)/2, C2 =
// num/dt^2, C3 = loss/dt in a form that shows its sign,
//
//     sum W (den d^2 + num s^2)/(8 dt^2), s = q^{n+1} + q^n;   lost in a step: sum W loss (d^{n+1} + d^n)^2/(4 dt^2)
//
// Start: the free motion that passes y0 at rest, and every force on the first half step with half its weight.
#pragma once

#include "schemes/driver/string_step.hpp"
#include "schemes/modal/kernels/modal_pass.hpp"
#include "schemes/modal/modal_string.hpp"

namespace jvari {

class ThreePointModes {
public:
    static constexpr int levels = 2;
    static constexpr long steps_between_looks = 64;

    // gain(string): of each mode [m/N]; inertia(string, gain): its W.
    using Gain = ModalArray (*)(const ModalString&);
    using Inertia = ModalArray (*)(const ModalString&, const ModalArray& gain);
    ThreePointModes(const Descriptor&, const Scene&, const Settings&, Gain, Inertia);
    static ModalArray plain_gain(const ModalString&);                     // dt^2/m
    static ModalArray modal_mass(const ModalString&, const ModalArray&);  // m

    const StringPoints& points() const { return p_; }
    ThreadStart thread_start() const { return ThreadStart::taut; }
    void reset() noexcept;
    void start(const double* force, double) noexcept;
    void approach(bool) noexcept;
    ReadingsBeforeStep readings() const { return {older_.data(), now_.data(), free_.data()}; }
    Spent pass(const double* force, double, bool probed) noexcept;
    void reading(int level, double* out) const noexcept;
    double stored() noexcept;
    bool failed() const { return !(std::abs(sum_) < modal_overflow); }
    void write(const Block&, int row, double bridge, double thread) noexcept;
    int dofs() const { return 2 * m_.count; }
    std::vector<Fact> facts() const;
    std::vector<FreeMode> free_modes() const { return three_point_modes(m_); }

private:
    void free_motion() noexcept;
    void fill_next(double F_e) noexcept;
    void apply(const double* force, double share) noexcept;
    void see_next() noexcept;

    ModalString m_;
    StringPoints p_;
    std::vector<ModalArray> g_, e_;                    // of the points
    ModalArray W_, e_e_, q_, d_, d0_, next_;           // next_: d^{n+1}
    std::vector<double> now_, older_, coming_, free_;  // of the points [m]
    double compliance_ = 0;  // of one contact under a steady force, relative to the true one of the same modes; else 0
    long step_ = 0;
    double F_e_ = 0, sum_ = 0;
    ModalPass fused_;  // of one contact and a thread at most; with the forces of the step, which it makes at the next approach
    ModalPassFunction unplucked_ = nullptr, plucked_ = nullptr;
    std::vector<double> theta_e_;  // of the pluck [m/N]
};

}  // namespace jvari
