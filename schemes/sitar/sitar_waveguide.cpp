// Source: Deshmukh & Rayavarapu, "2-D digital waveguide and finite difference modeling of a sitar":
// two rails with fs/(2 f0) samples (eqs 3-5), inverting ends, a bridge that sets the returning wave
// (eqs 10-12), two planes of vibration coupled at the bridge by a rotation (eq 14). Added to the
// paper: a fractional length and a dispersion by allpass at the peg (Van Duyne & Smith 1994),
// energy columns, losses along the way.
//
// If y_r + y_l would pass the profile, y_r := profile - y_l. The rule has no potential: it gives
// and takes energy, and the ledger records the amount. By eq 9 a correction d of y_r at node m is
// an impulse Z d in this step and -Z d on node m - 1 one step later: no momentum in the end, and a
// bridge force that may pull.
//
// The file is long, because a class template over the number of planes keeps its step, bridge, taps
// and ledger together. Without obstacles on the way the rails move in runs (coast), and the time is
// theirs alone: half for one plane.
//
// Left out: any stiffness of the contact, losses that differ from partial to partial, the
// distribution of stiffness along the string.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/modes.hpp"
#include "schemes/making.hpp"
#include "schemes/sitar/sitar.hpp"
#include "schemes/sitar/sitar_peg.hpp"

namespace jvari {

namespace {

using std::numbers::pi;

struct Waves {
    SitarString string;
    PegTuning peg;                // no sections: an inversion
    double cosine = 1, sine = 0;  // rotation per reflection  (14)
    double share[2] = {1, 0};     // share of the initial shape in either plane
    int tap_plane = 0;
};

template <int planes>
class SitarWaveguide final : public Scheme {
public:
    explicit SitarWaveguide(Waves w)
        : w_(std::move(w)), s_(w_.string), size_(s_.cells + 1), rail_(2 * planes * size_) {
        for (int m = 0; m < size_; ++m) {
            loss_.push_back(std::exp(-s_.sigma * s_.dt * m));
            gain_.push_back(std::exp(s_.sigma * s_.dt * m));
        }
        pending_.resize(s_.profile.empty() ? 0 : 1);
        if (!w_.peg.a.empty())
            peg_.assign(planes, PegFilter(w_.peg, std::pow(s_.step_loss, w_.peg.delay)));
        reset();
    }
    void reset() noexcept override {
        head_ = 0;
        steps_ = 0;
        coasted_ = 0;
        ledger_ = {};
        slopes_dissipated_ = 0;
        std::fill(pending_.begin(), pending_.end(), 0.0);
        const int M = s_.cells;
        for (int p = 0; p < planes; ++p)
            for (int m = 0; m <= M; ++m) {
                // y_r = y_l = y/2
                const double half = 0.5 * w_.share[p] * initial_shape(s_.shape, m * s_.dx);
                right(p)[m] = gain_[m] * half;
                left(p)[M - m] = gain_[M - m] * half;
            }
        // the filters hold the waves from before t = 0
        for (int p = 0; p < static_cast<int>(peg_.size()); ++p) {
            peg_[p].clear();
            for (int k = 8 * M; k >= 0; --k) {
                const double past = 0.5 * w_.share[p] * std::exp(s_.sigma * s_.dt * k) *
                                    initial_shape(s_.shape, (M + k) * s_.dx);
                peg_[p].pass(past);
            }
            left(p)[0] = -peg_[p].gain * peg_[p].out.now;
            left(p)[1] = -peg_[p].gain * peg_[p].out.before;
        }
        slopes_ = rail_slopes();
    }
    Status advance(const Block& out) noexcept override {
        for (int row = 0; row < out.rows; ++row) {
            double finite = 0;
            for (int k = 0; k < out.taps; ++k)
                finite += out.tap[k * out.stride + row] = read(s_.taps[k]);
            if (!std::isfinite(finite)) return {Outcome::diverged, steps_};
            if (out.energy)
                write_energy(out, row, s_.wave_energy(rail_slopes() + peg_slopes()), 0,
                             s_.wave_energy(slopes_dissipated_) + ledger_.dissipated);
            slopes_dissipated_ = 0;
            ledger_.next_row();
            if (pending_.empty() && peg_.empty()) coast(s_.steps_per_row, out);
            else
                for (int k = 0; k < s_.steps_per_row; ++k) {
                    step();
                    if (!pending_.empty()) meet_bridge();
                    if (out.stopped(k, steps_between_questions)) return {};
                }
            settle();
            steps_ += s_.steps_per_row;
        }
        return {};
    }
    int dofs() const override {
        return static_cast<int>(rail_.size() + pending_.size() + peg_.size() * w_.peg.a.size());
    }
    std::vector<Fact> facts() const override {
        std::vector<Fact> facts = s_.facts;
        if (!s_.profile.empty()) ledger_.report(facts);
        return facts;
    }
    std::vector<FreeMode> free_modes() const override {
        return planes == 1 && w_.peg.a.empty() ? s_.free_modes() : std::vector<FreeMode>{};
    }

private:
    // Circular rails: the wave at `distance` cells from the end that it left lies that many places
    // behind the head, before the loss on the way.
    double* right(int p) { return rail_.data() + 2 * p * size_; }
    double* left(int p) { return right(p) + size_; }
    int behind(int distance) const {
        return head_ + distance < size_ ? head_ + distance : head_ + distance - size_;
    }
    double y_right(int p, int m) { return loss_[m] * right(p)[behind(m)]; }
    double y_left(int p, int m) { return loss_[s_.cells - m] * left(p)[behind(s_.cells - m)]; }
    double displacement(int p, int m) { return y_right(p, m) + y_left(p, m); }
    double velocity(int p, int m) {
        if (m == s_.cells) return 0;
        double r[2], l[2];  // at m - 1 and m + 1
        r[0] = m == 0 ? before_bridge_end(p) : y_right(p, m - 1);
        l[0] = m == 0 ? after_bridge_end(p) : y_left(p, m - 1);
        r[1] = y_right(p, m + 1);
        l[1] = y_left(p, m + 1);
        // y_t = c (y_l' - y_r')
        return 0.5 / s_.dt * ((l[1] - l[0]) - (r[1] - r[0])) - s_.sigma * displacement(p, m);
    }
    // Waves one cell beyond the bridge end: the right-going one before its reflection, the
    // left-going one after it.
    double before_bridge_end(int p = 0) {
        if constexpr (planes == 1) return -y_left(0, 1);
        else return -(w_.cosine * y_left(p, 1) + (p == 0 ? -w_.sine : w_.sine) * y_left(1 - p, 1));
    }
    double after_bridge_end(int p) {
        if constexpr (planes == 1) return -y_right(0, 1);
        else
            return -(w_.cosine * y_right(p, 1) + (p == 0 ? w_.sine : -w_.sine) * y_right(1 - p, 1));
    }
    double read(const SitarTap& t) {
        const int p = w_.tap_plane;
        switch (t.quantity) {
            case Quantity::displacement:
                return between_nodes(t, [&](int m) { return displacement(p, m); });
            case Quantity::velocity: return between_nodes(t, [&](int m) { return velocity(p, m); });
            case Quantity::nut_force:  // -T y' at the peg
                if (peg_.empty()) return s_.tension / s_.dx * displacement(p, s_.cells - 1);
                // y' = 2 y_r' there
                return 2 * s_.tension / s_.dx *
                       (peg_[p].peg.now - s_.step_loss * peg_[p].peg.before);
            default: return p == 0 ? ledger_.mean(t.quantity, s_) : 0;
        }
    }
    double rail_slopes() {
        double sum = 0;
        const int M = s_.cells;
        for (int p = 0; p < planes; ++p) {
            const double first = y_right(p, 1) - before_bridge_end(p);
            // beyond the peg
            const double next_in =
                peg_.empty() ? -y_left(p, M - 1) : s_.step_loss * peg_[p].in.before;
            const double last = next_in - y_right(p, M - 1);
            sum += first * first + last * last;
            for (int m = 1; m < M; ++m) {
                const double r = y_right(p, m + 1) - y_right(p, m - 1),
                             l = y_left(p, m + 1) - y_left(p, m - 1);
                sum += r * r + l * l;
            }
        }
        return sum;
    }
    double peg_slopes() const {
        double sum = 0;
        for (const PegFilter& peg : peg_) sum += peg.slopes(s_.step_loss);
        return sum;
    }
    // Reflects at both ends. The steps end at place `to` on the rails, the last step there. They
    // take the waves from the other end at `from` and the places after it.
    [[gnu::always_inline]] void reflect(int to, int from, int steps) noexcept {
        const double way = loss_[s_.cells], c = w_.cosine, s = w_.sine;
        double* __restrict R = right(0), * __restrict L = left(0);
        if constexpr (planes == 1) {
            for (int i = steps - 1; i >= 0; --i) {
                const double at_peg = way * R[from + i], at_bridge = way * L[from + i];
                L[to + i] = -at_peg;
                R[to + i] = -at_bridge;
            }
        } else {
            double* __restrict R1 = right(1), * __restrict L1 = left(1);
            for (int i = steps - 1; i >= 0; --i) {
                const double peg0 = way * R[from + i], peg1 = way * R1[from + i],
                             at0 = way * L[from + i], at1 = way * L1[from + i];
                L[to + i] = -peg0;
                L1[to + i] = -peg1;
                R[to + i] = -(c * at0 - s * at1);  // (14)
                R1[to + i] = -(s * at0 + c * at1);
            }
        }
    }
    // Moves the rails by steps without obstacles: no step depends on another within the length of a
    // rail.
    void coast(int steps, const Block& out) noexcept {
        while (steps > 0) {
            const int top = head_ == 0 ? size_ : head_,
                      run = std::min({steps, std::max(1, top - 1), s_.cells - coasted_});
            head_ = top - run;
            reflect(head_, top > 1 ? head_ - 1 : size_ - 1, run);
            steps -= run;
            coasted_ += run;
            if (coasted_ < s_.cells) continue;
            settle();
            if (out.stopped()) return;
        }
    }
    void step() noexcept {
        head_ = head_ == 0 ? size_ - 1 : head_ - 1;
        reflect(head_, behind(s_.cells), 1);
        if (++coasted_ == s_.cells || !peg_.empty()) settle();
        const double loss = s_.step_loss;
        for (int p = 0; p < static_cast<int>(peg_.size()); ++p) {
            PegFilter& peg = peg_[p];
            left(p)[head_] = -peg.pass(-left(p)[head_]);
            const double in = peg.in.slope(loss), out = peg.out.slope(loss);
            slopes_dissipated_ += (1 - peg.gain * peg.gain) * out * out;
            slopes_ += peg.gain * peg.gain * out * out - in * in;
        }
    }
    void settle() noexcept {  // the loss in the steps since the last time
        const double loss2 = loss_[coasted_] * loss_[coasted_];
        slopes_dissipated_ += (1 - loss2) * slopes_;
        slopes_ *= loss2;
        coasted_ = 0;
    }
    // Applies the rule at nodes 1, 2, ... in the vertical plane; its energy is in the differences
    // beside the moved nodes.
    void meet_bridge() noexcept {
        const int nodes = static_cast<int>(s_.profile.size());
        double* const R = right(0);
        const double* const L = left(0);
        bool below = false;
        for (int m = 1; m <= nodes; ++m) below |= displacement(0, m) < s_.profile[m - 1];
        if (!below) {
            strike(pending_[0]);
            pending_[0] = 0;
            return;
        }
        // at m - 2, m - 1, m - 0
        double before[3] = {0, before_bridge_end(), R[head_]}, after[3] = {0, before[1], before[2]};
        double slopes = 0, moved = 0, moved_first = 0;
        for (int m = 1; m <= nodes + 2; ++m) {
            const int here = behind(m);
            before[0] = before[1], before[1] = before[2], before[2] = loss_[m] * R[here];
            after[0] = after[1], after[1] = after[2], after[2] = before[2];
            const double back =
                m <= nodes ? s_.profile[m - 1] - loss_[s_.cells - m] * L[behind(s_.cells - m)]
                           : before[2];
            if (before[2] < back) {
                after[2] = back;
                R[here] = gain_[m] * back;
                moved += back - before[2];
                if (m == 1) moved_first = back - before[2];
            }
            const double old_slope = before[2] - before[0], new_slope = after[2] - after[0];
            slopes += (new_slope - old_slope) * (new_slope + old_slope);
        }
        settle();
        slopes_ += slopes;
        ledger_.exchange(s_.wave_energy(slopes));
        strike(moved + pending_[0]);
        pending_[0] = -s_.step_loss * (moved - moved_first);
    }
    void strike(double corrections) noexcept {  // their impulse on the string
        const double impulse = s_.impedance() * corrections;
        ledger_.impulse += impulse;
        ledger_.force.note(impulse / s_.dt);
    }

    Waves w_;
    const SitarString& s_;
    int size_;  // samples in a rail
    int head_ = 0;
    std::vector<double> rail_;         // per plane: right-going, left-going [m]
    std::vector<double> loss_, gain_;  // over m cells, and its inverse
    std::vector<PegFilter> peg_;       // one per plane, none for an integer length
    // part of the rule's impulse that falls due at the next step, over Z [m]; one if there is a
    // bridge
    std::vector<double> pending_;
    int coasted_ = 0;               // steps since settle()
    double slopes_ = 0;             // expected value of rail_slopes()
    double slopes_dissipated_ = 0;  // since the last row [m^2]
    long steps_ = 0;
    BridgeLedger ledger_;
};

// Sets a length of fs/f0 samples per period; the fractional part is a filter at the peg.
void set_filtered_length(Waves& w, const String& string, bool stiff) {
    SitarString& s = w.string;
    const double loop = 1 / (s.f0 * s.dt);
    Settings unasked;
    unasked.sample_rate = 1 / s.dt;
    refuse_too_many_cells(0.5 * loop);
    if (loop < 9)
        throw Refusal("the string has fewer than 9 samples per period: raise the sample rate");
    String heard = string;  // the string whose partials the loop aims at
    heard.damping = NoDamping{};
    if (!stiff) heard.bending_stiffness = 0;
    const std::vector<double> omega = modes_of(heard, unasked).omega0;
    w.peg = stiff ? tune_stiff(loop, omega, s.dt) : tune(loop, omega[0] * s.dt, {});
    s.cells = w.peg.cells;
    s.dx = 2 * s.length / loop;
    s.facts.push_back({facts::period_error_cents, worst_cents(w.peg, {omega[0]}, s.dt)});
    s.facts.push_back({facts::worst_partial_error_cents, worst_cents(w.peg, omega, s.dt)});
    s.facts.push_back({facts::length_in_filter, s.length - s.cells * s.dx});
}

constexpr Option length_option{
    "length",
    "integer",
    "samples per period: a whole number, or the rest in an allpass at the peg",
    {"integer", "fractional"}};
constexpr Option stiffness_option{"stiffness",
                                  "refuse",
                                  "what becomes of bending stiffness; its dispersion in an allpass "
                                  "at the peg needs length=fractional",
                                  {"refuse", "dispersion", "ignore"}};
constexpr Option taps_option{
    "taps", "vertical", "the plane of vibration that taps read", {"vertical", "horizontal"}};
constexpr Option options[] = {length_option, stiffness_option, taps_option};
constexpr Approximation approximates[] = {
    sitar_damping,
    sitar_ignored_stiffness,
    {Feature::bending_stiffness, facts::worst_partial_error_cents},
    sitar_profile,
    sitar_power_law};

std::unique_ptr<Scheme> make(const Descriptor& descriptor, const Scene& scene,
                             const Settings& settings) {
    const std::string length = choice_option(settings, length_option);
    const std::string stiffness = choice_option(settings, stiffness_option);
    const std::string plane = choice_option(settings, taps_option);
    Waves w;
    w.string = sitar_string(descriptor, scene, settings, stiffness);
    const String& string = scene.strings.front();
    const bool stiff = string.bending_stiffness != 0 && stiffness == "dispersion";
    if (stiff && length != "fractional")
        throw Refusal(
            "stiffness=dispersion delays by no whole number of samples: it needs "
            "length=fractional");
    if (length == "integer") set_integer_length(w.string);
    else set_filtered_length(w, string, stiff);
    if (string.polarisation) {
        w.cosine = std::cos(string.polarisation->rotation);
        w.sine = std::sin(string.polarisation->rotation);
        w.share[0] = std::cos(string.polarisation->pluck_angle);
        w.share[1] = std::sin(string.polarisation->pluck_angle);
    }
    if (plane == "horizontal") {
        if (!string.polarisation)
            throw Refusal("taps=horizontal: the string moves in the vertical plane only");
        w.tap_plane = 1;
    }
    lay_bridge(w.string, w.share[0]);
    if (static_cast<int>(w.string.profile.size()) > w.string.cells - 2)
        throw Refusal("the bridge leaves no free string before the peg");
    set_taps(w.string, scene);
    if (string.polarisation) return std::make_unique<SitarWaveguide<2>>(std::move(w));
    return std::make_unique<SitarWaveguide<1>>(std::move(w));
}
}  // namespace

extern const Descriptor sitar_waveguide = {
    .name = "sitar_waveguide",
    .source = "Deshmukh & Rayavarapu, eqs 3-5 and 10-14",
    .represents = Feature::damping | Feature::bending_stiffness | Feature::profile_barrier |
                  Feature::power_law_contact | Feature::initial_shape | Feature::polarisation |
                  Feature::rigid_profile,
    .balance = Balance::to_tolerance,
    .make = make,
    .options = options,
    .approximates = approximates,
    .note =
        "The barrier is rigid and begins at x = 0; with bending stiffness it runs where the option "
        "stiffness says what becomes of it.",
};

}  // namespace jvari
