// Source: Deshmukh & Rayavarapu, "2-D digital waveguide and finite difference modeling of a sitar",
// eqs 6-12: the wave equation with dx = c dt, y(n+1, m) = y(n, m+1) + y(n, m-1) - y(n-1, m)  (9),
// rigid ends, a bridge below which no node may pass.
//
// Loss: every wave decays by step_loss per step, so (9) becomes y+ = loss (y_{m+1} + y_{m-1}) -
// loss^2 y-: the same string that sitar_waveguide has, sample by sample, without a bridge. Under
// the bridge they differ. Here a node that would pass is moved up by some d >= 0, an impulse Z d
// that leaves to both sides and never pulls; there only the returning wave is set. With `old` for
// loss^2 y-,
//
//   sitar_fdm (12)              y+ = profile, the node is put back on it
//                               loses energy
//   characteristic_lattice (reference/)  y+ + old = max(2 profile, loss (y_{m+1} + y_{m-1}))
//                                        tends to the motion on a flat wall
//
// The latter comes from Schatzman & Bercovier, "Numerical approximation of a wave equation with
// unilateral constraints", Math. Comp. 53, 1989.
//
// Left out: any stiffness of the contact, a fractional length, the second polarisation (the paper's
// FDM has one).
#include <algorithm>
#include <cmath>

#include "schemes/making.hpp"
#include "schemes/sitar/sitar.hpp"

namespace jvari {

namespace {

enum class BridgeRule { clamping, characteristic };  // for a node that would pass the profile

template <BridgeRule rule>
class SitarFdm final : public Scheme {
public:
    explicit SitarFdm(SitarString s) : s_(std::move(s)), now_(s_.cells + 1), before_(s_.cells + 1) {
        reset();
    }
    void reset() noexcept override {
        steps_ = 0;
        ledger_ = {};
        slopes_dissipated_ = 0;
        for (int m = 0; m <= s_.cells; ++m)
            now_[m] = m == 0 || m == s_.cells ? 0 : initial_shape(s_.shape, m * s_.dx);
        before_.front() = before_.back() = 0;
        // y_r = y_l = y/2
        for (int m = 1; m < s_.cells; ++m)
            before_[m] = 0.5 / s_.step_loss * (now_[m - 1] + now_[m + 1]);
        slopes_ = slopes();
    }
    Status advance(const Block& out) noexcept override {
        const bool bridge = !s_.profile.empty();
        for (int row = 0; row < out.rows; ++row) {
            double finite = 0;
            for (int k = 0; k < out.taps; ++k)
                finite += out.tap[k * out.stride + row] = read(s_.taps[k]);
            if (!std::isfinite(finite)) return {Outcome::diverged, steps_};
            if (out.energy)
                write_energy(out, row, s_.wave_energy(slopes()), 0,
                             s_.wave_energy(slopes_dissipated_) + ledger_.dissipated);
            slopes_dissipated_ = 0;
            ledger_.next_row();
            for (int k = 0; k < s_.steps_per_row; ++k) {
                step();
                if (bridge) meet_bridge();
                if (out.stopped(k, steps_between_questions)) return {};
            }
        }
        return {};
    }
    int dofs() const override { return static_cast<int>(now_.size() + before_.size()); }
    std::vector<Fact> facts() const override {
        std::vector<Fact> facts = s_.facts;
        if (!s_.profile.empty()) ledger_.report(facts);
        return facts;
    }
    std::vector<FreeMode> free_modes() const override { return s_.free_modes(); }

private:
    void step() noexcept {
        const double loss = s_.step_loss, loss2 = loss * loss;
        double* __restrict next = before_.data();
        const double* __restrict y = now_.data();
        // (9)
        for (int m = 1; m < s_.cells; ++m) next[m] = loss * (y[m + 1] + y[m - 1]) - loss2 * next[m];
        now_.swap(before_);
        slopes_dissipated_ += (1 - loss2) * slopes_;
        slopes_ *= loss2;
        ++steps_;
    }
    // Applies an impulse Z d at the node. Nodes do not see one another.
    void meet_bridge() noexcept {
        const double loss = s_.step_loss;
        double moved = 0, change = 0;
        for (int m = 1; m <= static_cast<int>(s_.profile.size()); ++m) {
            const double left = loss * before_[m - 1], right = loss * before_[m + 1], y = now_[m],
                         old = left + right - y;
            const double profile = s_.profile[m - 1],
                         d = rule == BridgeRule::clamping ? profile - y : 2 * profile - (y + old);
            if (!(d > 0)) continue;
            change += 2 * d * (y - right + y - left + d);
            now_[m] = rule == BridgeRule::clamping ? profile : y + d;
            moved += d;
        }
        slopes_ += change;
        ledger_.exchange(s_.wave_energy(change));
        ledger_.impulse += s_.impedance() * moved;
        ledger_.force.note(s_.impedance() * moved / s_.dt);
    }
    // Squared differences over two cells in the two travelling waves: y(n+1, m) - loss y(n, m+1) is
    // a difference in y_r; with m and m + 1 exchanged it is one in y_l. With loss = 1 the sum is
    // the energy that the leapfrog conserves, kinetic plus the product of the present and previous
    // slopes.
    double slopes() const {
        double sum = 0;
        for (int m = 0; m < s_.cells; ++m) {
            const double r = now_[m] - s_.step_loss * before_[m + 1],
                         l = now_[m + 1] - s_.step_loss * before_[m];
            sum += r * r + l * l;
        }
        return sum;
    }
    double velocity(int m) const {
        if (m == 0 || m == s_.cells) return 0;
        return 0.5 / s_.dt * (now_[m + 1] + now_[m - 1] - 2 * s_.step_loss * before_[m]) -
               s_.sigma * now_[m];
    }
    double read(const SitarTap& t) const {
        switch (t.quantity) {
            case Quantity::displacement: return between_nodes(t, [this](int m) { return now_[m]; });
            case Quantity::velocity: return between_nodes(t, [this](int m) { return velocity(m); });
            // -T y' at the peg
            case Quantity::nut_force: return s_.tension / s_.dx * now_[s_.cells - 1];
            default: return ledger_.mean(t.quantity, s_);
        }
    }

    const SitarString s_;
    std::vector<double> now_, before_;  // y at the nodes [m]
    double slopes_ = 0;                 // expected value of slopes()
    double slopes_dissipated_ = 0;      // since the last row [m^2]
    long steps_ = 0;
    BridgeLedger ledger_;
};

constexpr Option stiffness_option{
    "stiffness", "refuse", "what becomes of bending stiffness", {"refuse", "ignore"}};
constexpr Option options[] = {stiffness_option};
constexpr Approximation approximates[] = {sitar_damping, sitar_ignored_stiffness, sitar_profile,
                                          sitar_power_law};

template <BridgeRule rule>
std::unique_ptr<Scheme> make(const Descriptor& descriptor, const Scene& scene,
                             const Settings& settings) {
    SitarString s =
        sitar_string(descriptor, scene, settings, choice_option(settings, stiffness_option));
    set_integer_length(s);
    lay_bridge(s, 1);
    set_taps(s, scene);
    return std::make_unique<SitarFdm<rule>>(std::move(s));
}

}  // namespace

std::unique_ptr<Scheme> characteristic_lattice_of(const Descriptor& descriptor, const Scene& scene,
                                                  const Settings& settings) {
    return make<BridgeRule::characteristic>(descriptor, scene, settings);
}

extern const Descriptor sitar_fdm = {
    .name = "sitar_fdm",
    .source = "Deshmukh & Rayavarapu, eqs 6-12",
    .represents = Feature::damping | Feature::bending_stiffness | Feature::profile_barrier |
                  Feature::power_law_contact | Feature::initial_shape | Feature::rigid_profile,
    .balance = Balance::to_tolerance,
    .make = make<BridgeRule::clamping>,
    .options = options,
    .approximates = approximates,
    .note =
        "The barrier is rigid and begins at x = 0; bending stiffness is ignored, and only where "
        "stiffness=ignore says so."};

}  // namespace jvari
