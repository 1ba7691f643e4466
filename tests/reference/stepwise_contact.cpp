// exact_contact by another algorithm, for linear contact: its windows end at every event, and the modes are read and moved in each.
//
// Sources: van Walstijn et al. 2016, eqs 1-22 (string, thread, barrier, pluck), as the piecewise linear system that exponent 1 makes of
// them. Between two events the modes are free oscillators under the forces of thread, touching barriers and pluck, and those forces follow
// a Volterra equation of a few unknowns (springs.hpp). One window:
//   1. Taylor series of the points' free motion from the modal state              (one pass over the modes)
//   2. series of displacements and forces by recurrence, with a rigorous remainder
//   3. the first sign change of any gap by Bernstein isolation: no contact deeper than 2 x the bound is missed
//   4. the modal state at the end from the forces' moments                        (one pass over the modes)
// Windows end at events, rows and the pluck's ends. After an event the gap is exactly zero, and the search divides that root out.
// A profile acts as the points of profile_points.hpp. Leaves out: exponents other than 1, contact loss, several strings.
#include <gsl/gsl_integration.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "reference/exact/oscillators.hpp"
#include "reference/exact/pluck_series.hpp"
#include "reference/exact/springs.hpp"
#include "reference/profile_points.hpp"
#include "reference/readout.hpp"
#include "schemes/making.hpp"
#include "tests/reference/bernstein.hpp"
#include "tests/reference/stepwise_contact.hpp"

namespace jvari {

namespace {
constexpr double reach_of_window = 4.5;    // window x growth rate at window = 1; 30 terms
constexpr double truncation = 1e-18;       // of every series, relative
constexpr double rounding = 16 * 2.3e-16;  // of a gap, relative to sum |g_i| (|y_i| + |v_i|/rate)
constexpr int nodes = 8;                   // Gauss-Legendre nodes per window, of the energy probe

const std::vector<double> inverse_factorial = [] {
    std::vector<double> f{1.0};
    for (int n = 1; n <= 2 * longest_series; ++n) f.push_back(f.back() / n);
    return f;
}();

struct Extremes {  // of the run so far
    double events = 0, windows = 0, smallest_force = HUGE_VAL, deepest = 0, tolerance = 0;
};

class StepwiseContact final : public Scheme {
public:
    StepwiseContact(const String&, const Scene&, Modes, double tap_rate, double window);
    void reset() noexcept override;
    Status advance(const Block& out) noexcept override;
    int dofs() const override { return 2 * modes_.count(); }
    std::vector<Fact> facts() const override;

private:
    bool interval(const Block& out) noexcept;                                           // to the next row
    bool stretch(double from, double to, bool plucked, const Block& out) noexcept;      // within one interval
    double window(double left, bool plucked, double since_pluck, bool probe) noexcept;  // how far it came
    double resolve(double longest, bool plucked, double since_pluck, int p_terms) noexcept;
    double bound(int point, double z, int p_terms, double growth) const noexcept;
    void measure(int point, double end, bool leaves) noexcept;
    void fly_to(double fraction, double z, int p_terms, bool plucked, double* y, double* u, double* impulse) noexcept;
    void dissipate(double fraction, double z, int p_terms, bool plucked) noexcept;
    double stored() const noexcept;
    double point(int a, const double* state) const noexcept;

    Modes modes_;
    Oscillators osc_;
    Springs springs_;
    Readout readout_;
    std::vector<Pluck> pluck_;  // none or one
    double tap_rate_, window_, interval_;
    std::vector<double> start_, stiffness_, loss_;  // y at t = 0; m omega0^2; 2 m sigma rate^2 / rate, per mode

    std::vector<double> y_, u_;  // the state
    std::vector<char> touching_, known_zero_;
    long row_ = 0;
    double bridge_impulse_ = 0, thread_impulse_ = 0, supplied_ = 0, dissipated_ = 0;  // of the interval that ends here
    int idle_ = 0;                                                                    // windows in a row that came nowhere
    Extremes extremes_;

    // one window
    int terms_ = 0;
    double growth_ = 0;
    std::vector<double> p_, scaled_, displacement_, force_, gap_, reach_, scratch_, moments_, impulse_, y_node_, u_node_;
    std::vector<const double*> acting_;
    std::array<double, nodes> node_{}, weight_{};
};

StepwiseContact::StepwiseContact(const String& s, const Scene& scene, Modes modes, double tap_rate, double window)
    : modes_(std::move(modes)),
      osc_(modes_),
      springs_(modes_, osc_, s),
      readout_(scene, modes_),
      tap_rate_(tap_rate),
      window_(window),
      interval_(osc_.rate / tap_rate) {
    if (s.pluck) pluck_.push_back(*s.pluck);
    start_ = osc_.pad(initial_displacement(modes_, s));
    std::vector<double> stiffness, loss;
    for (int i = 0; i < modes_.count(); ++i) {
        stiffness.push_back(modes_.mass * modes_.omega0[i] * modes_.omega0[i]);
        loss.push_back(2 * modes_.mass * modes_.sigma[i] * osc_.rate);  // 2 m sigma v^2 dt = this x u^2 d(rate t)
    }
    stiffness_ = osc_.pad(stiffness);
    loss_ = osc_.pad(loss);
    y_ = u_ = y_node_ = u_node_ = start_;
    touching_.resize(springs_.contacts + 1);
    known_zero_.resize(springs_.contacts + 1);
    const int points = springs_.points, forces = springs_.forces;
    for (auto* v : {&p_, &scaled_, &displacement_, &gap_}) v->resize(static_cast<std::size_t>(points + 1) * longest_series);
    for (auto* v : {&force_, &moments_}) v->resize(static_cast<std::size_t>(forces + 1) * longest_series);
    reach_.resize(points + 1);
    impulse_.resize(forces + 1);
    acting_.resize(forces + 1);
    scratch_.resize(static_cast<std::size_t>(points) * (longest_series + 1) * lanes);
    gsl_integration_glfixed_table* table = gsl_integration_glfixed_table_alloc(nodes);
    for (int q = 0; q < nodes; ++q) gsl_integration_glfixed_point(0, 1, q, &node_[q], &weight_[q], table);
    gsl_integration_glfixed_table_free(table);
    reset();
}

void StepwiseContact::reset() noexcept {
    std::copy(start_.begin(), start_.end(), y_.begin());
    std::fill(u_.begin(), u_.end(), 0.0);
    std::fill(touching_.begin(), touching_.end(), 0);
    std::fill(known_zero_.begin(), known_zero_.end(), 0);
    row_ = idle_ = 0;
    bridge_impulse_ = thread_impulse_ = supplied_ = dissipated_ = 0;
    extremes_ = {};
}

Status StepwiseContact::advance(const Block& out) noexcept {
    for (int row = 0; row < out.rows; ++row) {
        readout_.write(out, row, y_.data(), u_.data(), osc_.rate, bridge_impulse_ * tap_rate_, thread_impulse_ * tap_rate_);
        if (out.energy) write_energy(out, row, stored(), supplied_, dissipated_);
        if (!interval(out)) return {idle_ > 0 ? Outcome::not_converged : Outcome::diverged, row_};
        ++row_;
    }
    return {};
}

bool StepwiseContact::interval(const Block& out) noexcept {
    bridge_impulse_ = thread_impulse_ = supplied_ = dissipated_ = 0;
    double from = interval_, to = interval_;  // of the pluck within this interval
    if (!pluck_.empty()) {
        const double start = pluck_[0].start - row_ / tap_rate_;
        from = std::clamp(start * osc_.rate, 0.0, interval_);
        to = std::clamp((start + pluck_[0].duration) * osc_.rate, 0.0, interval_);
    }
    return stretch(0, from, false, out) && stretch(from, to, true, out) && stretch(to, interval_, false, out);
}

bool StepwiseContact::stretch(double from, double to, bool plucked, const Block& out) noexcept {
    for (double at = from; at < to;) {
        const double left = to - at;
        const double since_pluck = plucked ? std::max(0.0, row_ / tap_rate_ - pluck_[0].start + at / osc_.rate) : 0;
        const double step = window(left, plucked, since_pluck, out.energy != nullptr);
        if (!(step >= 0) || out.stopped()) return false;
        idle_ = step > 1e-15 * interval_ ? 0 : idle_ + 1;
        if (idle_ > 1000) return false;
        at = step == left ? to : at + step;
    }
    return true;
}

double StepwiseContact::window(double left, bool plucked, double since_pluck, bool probe) noexcept {
    double longest = window_ * reach_of_window / springs_.growth(touching_.data());
    if (plucked) longest = std::min(longest, window_ * pluck_window(pluck_[0]) * osc_.rate);
    longest = left / std::ceil(left / longest);
    const int p_terms = terms_for(longest, truncation, longest_series);
    series(osc_, y_.data(), u_.data(), springs_.weights.data(), springs_.points, p_terms, p_.data(), longest_series, reach_.data(),
           scratch_.data());
    const double z = resolve(longest, plucked, since_pluck, p_terms);
    if (!(z > 0)) return -1;

    double end = 1;
    int first = -1;
    for (int a = 0; a < springs_.contacts; ++a) {
        const double tolerance = bound(a, z, p_terms, growth_);
        extremes_.tolerance = std::max(extremes_.tolerance, 2 * tolerance);
        const double exit = first_negative(gap_.data() + a * longest_series, terms_, tolerance);
        if (exit <= end) end = exit, first = a;
    }
    for (int a = 0; a < springs_.contacts; ++a)
        if (touching_[a]) measure(a, end, a == first);

    if (probe) dissipate(end, z, p_terms, plucked);
    fly_to(end, z, p_terms, plucked, y_.data(), u_.data(), impulse_.data());
    for (int a = 0; a < springs_.contacts; ++a) bridge_impulse_ += impulse_[a];
    if (springs_.points > springs_.contacts) thread_impulse_ += impulse_[springs_.contacts];
    ++extremes_.windows;
    std::fill(known_zero_.begin(), known_zero_.end(), 0);
    if (first >= 0) {
        touching_[first] = !touching_[first];
        known_zero_[first] = 1;
        ++extremes_.events;
    }
    return end == 1 && z == left ? left : end * z;
}

// The series of all points over a window no longer than `longest`, contacts that are on the wrong side at its start put right. Its length.
double StepwiseContact::resolve(double longest, bool plucked, double since_pluck, int p_terms) noexcept {
    const Springs& s = springs_;
    for (int tries = 0; tries <= 4 * s.contacts; ++tries) {
        growth_ = s.growth(touching_.data());
        const double z = std::min(longest, window_ * reach_of_window / growth_);
        terms_ = terms_for(growth_ * z, truncation, longest_series);
        double power = 1;
        for (int n = 0; n < p_terms; ++n, power *= z)
            for (int a = 0; a < s.points; ++a) scaled_[a * longest_series + n] = p_[a * longest_series + n] * power;
        for (int a = 0; a < s.contacts; ++a)
            if (known_zero_[a]) scaled_[a * longest_series] = s.height[a];
        if (!pluck_.empty()) {
            double* f = force_.data() + s.points * longest_series;
            if (plucked) {
                pluck_series(pluck_[0], since_pluck, z / osc_.rate, terms_, f);
                for (int n = 0; n < terms_; ++n) f[n] /= inverse_factorial[n];
            } else std::fill_n(f, longest_series, 0.0);
        }
        s.solve(touching_.data(), z, scaled_.data(), p_terms, terms_, displacement_.data(), force_.data());
        bool settled = true;
        for (int a = 0; a < s.contacts; ++a) {  // the side the string is on now: positive until the next event
            double* gap = gap_.data() + a * longest_series;
            const double* y = displacement_.data() + a * longest_series;
            for (int n = 0; n < terms_; ++n) gap[n] = (touching_[a] ? -1 : 1) * (y[n] - (n == 0 ? s.height[a] : 0)) * inverse_factorial[n];
            const double* leading = std::find_if(gap, gap + terms_, [](double c) { return c != 0; });
            if (leading == gap + terms_ || *leading > 0) continue;
            if (!(*leading < 0)) return -1;  // not a number
            touching_[a] = !touching_[a];
            ++extremes_.events;
            settled = false;
        }
        if (settled) return z;
    }
    idle_ = 1;
    return -1;
}

// How far a gap may be from its series: modes and kernel cut after p_terms, the points' own series after terms_, rounding.
double StepwiseContact::bound(int a, double z, int p_terms, double growth) const noexcept {
    const Springs& s = springs_;
    double largest = 0, reach = reach_[a] + std::abs(s.height[a]) + s.pluck_reach;
    for (int b = 0; b < s.points; ++b) {
        const double* y = displacement_.data() + b * longest_series;
        double scale = 1, force = 0;
        for (int n = 0; n < terms_; ++n, scale *= growth * z) {
            largest = std::max(largest, std::abs(y[n] - (n == 0 ? s.height[b] : 0)) / scale);  // C of springs.hpp
            force += std::abs(force_[b * longest_series + n]) * inverse_factorial[n];
        }
        reach = std::max(reach, reach_[b] + s.pluck_reach);
        if (b >= s.contacts || touching_[b]) reach += std::abs(s.h(a, b)[1]) * force * z;
    }
    const double beyond = series_tail(growth * z, terms_) / terms_;
    return largest * beyond + 10 * std::exp(growth * z) * series_tail(z, p_terms) * reach + rounding * reach;
}

void StepwiseContact::measure(int a, double end, bool leaves) noexcept {
    const double* depth = gap_.data() + a * longest_series;  // touching: the gap's sign is turned, so this is the penetration
    double deepest = std::max(depth[0], value(depth, terms_, end));
    extremes_.smallest_force =
        std::min(extremes_.smallest_force, springs_.k[a] * (leaves ? depth[0] : std::min(depth[0], value(depth, terms_, end))));
    if (depth[1] > 0 && slope(depth, terms_, end) < 0) {
        double low = 0, high = end;
        for (int i = 0; i < 30; ++i) {
            const double middle = 0.5 * (low + high);
            (slope(depth, terms_, middle) > 0 ? low : high) = middle;
        }
        deepest = std::max(deepest, value(depth, terms_, low));
    }
    extremes_.deepest = std::max(extremes_.deepest, deepest);
}

void StepwiseContact::fly_to(double fraction, double z, int p_terms, bool plucked, double* y, double* u, double* impulse) noexcept {
    const double t = fraction * z;
    const int terms = std::min(p_terms, terms_for(t, truncation, longest_series));
    int acting = 0;
    for (int b = 0; b < springs_.forces; ++b) {
        impulse[b] = 0;
        if (b < springs_.contacts ? !touching_[b] : b >= springs_.points && !plucked) continue;
        const double* F = force_.data() + b * longest_series;
        double* m = moments_.data() + acting * longest_series;
        std::fill_n(m, terms, 0.0);
        double power = 1;
        for (int j = 0; j < terms_ - 1; ++j, power *= fraction) {
            const double f = F[j] * power;
            const double* later = inverse_factorial.data() + j + 1;
            for (int n = 0; n < terms; ++n) m[n] += f * later[n];
        }
        power = t;
        for (int n = 0; n < terms; ++n, power *= t) m[n] *= power;  // int_0^t (t-s)^n/n! F(s) ds
        impulse[b] = m[0] / osc_.rate;
        acting_[acting++] = springs_.gains.data() + static_cast<long>(b) * osc_.padded;
    }
    fly(osc_, y_.data(), u_.data(), t, terms, acting_.data(), moments_.data(), acting, longest_series, y, u);
}

// Energy lost and supplied in the window, by quadrature of the state itself, not from the balance.
void StepwiseContact::dissipate(double fraction, double z, int p_terms, bool plucked) noexcept {
    const Springs& s = springs_;
    for (int q = 0; q < nodes; ++q) {
        fly_to(fraction * node_[q], z, p_terms, plucked, y_node_.data(), u_node_.data(), impulse_.data());
        double loss = 0;
        for (int i = 0; i < osc_.padded; ++i) loss += loss_[i] * u_node_[i] * u_node_[i];
        if (s.points > s.contacts) {
            const double u = point(s.contacts, u_node_.data());
            loss += s.r[s.contacts] * u * u;  // r_c v^2 dt = r_c rate u^2 d(rate t)
        }
        dissipated_ += weight_[q] * fraction * z * loss;
        if (!plucked) continue;
        const double* F = force_.data() + s.points * longest_series;
        const double* gain = s.gains.data() + static_cast<long>(s.points) * osc_.padded;
        double Fe = 0, u = 0;
        for (int n = terms_ - 2; n >= 0; --n) Fe = Fe * fraction * node_[q] + F[n] * inverse_factorial[n];
        for (int i = 0; i < osc_.padded; ++i) u += gain[i] * u_node_[i];
        supplied_ += weight_[q] * fraction * z * Fe * u * modes_.mass * osc_.rate * osc_.rate;
    }
}

double StepwiseContact::point(int a, const double* state) const noexcept {
    const double* g = springs_.weights.data() + static_cast<long>(a) * osc_.padded;
    double sum = 0;
    for (int i = 0; i < osc_.padded; ++i) sum += g[i] * state[i];
    return sum;
}

double StepwiseContact::stored() const noexcept {
    double kinetic = 0, potential = 0;
    for (int i = 0; i < osc_.padded; ++i) {
        kinetic += u_[i] * u_[i];
        potential += stiffness_[i] * y_[i] * y_[i];
    }
    potential += modes_.mass * osc_.rate * osc_.rate * kinetic;
    for (int a = 0; a < springs_.points; ++a) {
        const double eta = springs_.height[a] - point(a, y_.data());
        if (a >= springs_.contacts || eta > 0) potential += springs_.k[a] * eta * eta;
    }
    return 0.5 * potential;
}

std::vector<Fact> StepwiseContact::facts() const {
    return {{facts::events, extremes_.events},
            {facts::contact_points, double(springs_.contacts)},
            {facts::coupled_contact_points, double(springs_.contacts)},
            {facts::windows, extremes_.windows},
            {facts::smallest_contact_force, extremes_.smallest_force == HUGE_VAL ? 0 : extremes_.smallest_force + 0.0},
            {facts::deepest_penetration, extremes_.deepest},
            {facts::detection_tolerance, extremes_.tolerance}};
}

constexpr Option window_option{"window", "1", "factor above 0, 1 at most, on the time between two looks for an event"};
constexpr Option options[] = {window_option, nodes_option};

std::unique_ptr<Scheme> made(const Descriptor&, const Scene& scene, const Settings& settings) {
    const double window = number_option(settings, window_option);
    if (!(window > 0 && window <= 1)) throw Refusal("option window: expected a factor above 0 and no larger than 1");
    Settings unsampled = settings;
    unsampled.sample_rate = 0;
    Modes modes = modes_of(scene.strings.at(0), unsampled);
    const String s = with_points(scene.strings.at(0), modes.count(), profile_points(settings));
    return std::make_unique<StepwiseContact>(s, scene, std::move(modes), settings.tap_rate, window);
}
}  // namespace

const Descriptor stepwise_contact = {.name = "stepwise_contact",
                                     .source = "piecewise linear system of van Walstijn et al. 2016, eqs 1-22, exact between events",
                                     .represents = Feature::bending_stiffness | Feature::damping |
                                                   Features(Feature::frequency_dependent_damping) | Features(Feature::measured_modes) |
                                                   Features(Feature::lumped_barrier) | Features(Feature::profile_barrier) |
                                                   Features(Feature::several_barriers) | Features(Feature::thread) |
                                                   Features(Feature::initial_shape) | Features(Feature::pluck),
                                     .balance = Balance::to_tolerance,
                                     .clock = Clock::continuous,
                                     .make = made,
                                     .options = options,
                                     .approximates = points_for_a_profile,
                                     .confirmation = [](const Scene&) {
                                         return Confirmation{{{}, {{window_option.name, "0.5"}}}, {}};
                                     }};

}  // namespace jvari
