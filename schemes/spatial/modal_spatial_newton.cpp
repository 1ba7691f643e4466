// Full-modal spatial Newton: exact three-point recursion per mode, conservative contact forces on the nodes x_i = iL/N of a grid with as
// many interior nodes as modes. Source: Issanchou et al. 2016, eqs 13-16, 20-21, 24-28.
//
// Beyond the paper: barriers with a footprint, a thread and a pluck act through modal weights; the thread's force is the average of the
// outer levels, F_c = k_c (h_c - (u+ + u-)/2) - r_c (u+ - u-)/(2 dt), and is eliminated from the contact equation as in van Walstijn et al.
// 2016, eqs 45-48. Leaves out: contacts coupled to each other (spatial_ports.cpp refuses them), two polarisations.
// On a body that moves (schemes/body) the points of all strings are solved for together, coupled as they may be, and its acceleration is
// one more force; a lossy contact then loses by the force at the older level, and the first half step takes the mean of its two levels.
//
// Option `compliance` = own (default, the paper's scheme) | matched: what cut and step take from the string's compliance stands in series
// with contacts and thread (contact/compliance.hpp, contact/obstacle.hpp), which may then be coupled; profiles are touched at points of
// their own (option `points`), and contact loss is left out. Refused where the scheme is too soft already.
//
// Order: free motion is exact. Forced motion is second order without losses and first order with them: eq 14 puts dt^2/m F on a mode where
// a damped one wants e^{-sigma dt} of it (a factor per mode would couple the nodes, so the paper's form is kept).
//
// Rows and energy are those of driver.hpp, the start that of every three-point scheme there; velocity is that of the free motion through
// levels n-1, n, n+1 corrected for F^n for the modes that tell it and a centred difference for the rest (three_point.hpp).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/modes.hpp"
#include "schemes/body/body_modes.hpp"
#include "schemes/body/instrument.hpp"
#include "schemes/contact/compliance.hpp"
#include "schemes/driver/pairings.hpp"
#include "schemes/making.hpp"
#include "schemes/modal/three_point.hpp"
#include "schemes/modal_coefficients.hpp"
#include "schemes/spatial/spatial_forms.hpp"
#include "schemes/spatial/spatial_ports.hpp"

namespace jvari {

namespace {

struct TapReading {
    Quantity quantity;
    AlignedVector displacement, increment, kept;  // weights on the form's levels
    std::vector<double> force, earlier_force;     // velocity: weights of F^n and F^{n-1}
};

double inner(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t j = 0; j < a.size(); ++j) sum += a[j] * b[j];
    return sum;
}

// What one scene and setting come to before a form is chosen.
struct Problem {
    Scene scene;
    const String& string() const { return scene.strings.front(); }
    double dt = 0;
    int steps_per_row = 1;
    Modes modes;
    std::vector<double> initial;  // modal displacement at t = 0 [m]
    ThreePoint three_point;
    LinearUpdate update;  // ports: contacts, thread, moving body, which all are read, and the pluck
    StringPoints points;
    std::vector<std::vector<double>> theta;  // of each port on every read [m/N]
    bool on_body = false;
};

template <class Form>
class SpatialNewton {
public:
    static constexpr int levels = 2;
    static constexpr long steps_between_looks = steps_between_questions;

    explicit SpatialNewton(Problem p) : p_(std::move(p)), form_(p_.update) {
        for (const Tap& tap : p_.scene.taps) readings_.push_back(reading_of(tap));
        const std::size_t reads = p_.update.reads;
        for (auto* v : {&older_, &now_, &coming_, &read_, &free_}) v->assign(reads, 0.0);
        for (auto* v : {&force_, &earlier_force_}) v->assign(p_.update.ports.size(), 0.0);
        for (auto* v : {&modal_now_, &modal_last_, &modal_coming_}) v->assign(p_.modes.count(), 0.0);
        pluck_port_ = p_.points.pluck ? static_cast<int>(reads) : -1;
        for (std::size_t z = 0; z < reads; ++z)
            for (std::size_t c = 0; c < reads; ++c) coupled_ = coupled_ || (z != c && p_.theta[c][z] != 0);
        reset();
    }

    const StringPoints& points() const { return p_.points; }
    ThreadStart thread_start() const { return p_.points.series ? ThreadStart::plain : ThreadStart::taut; }
    ReadingsBeforeStep readings() const { return {older_.data(), now_.data(), free_.data()}; }

    void reset() noexcept {
        modal_now_ = p_.initial;
        for (int j = 0; j < p_.modes.count(); ++j) modal_coming_[j] = p_.three_point.start[j] * modal_now_[j];
        form_.start(modal_now_.data(), modal_coming_.data());
        form_.read(read_.data());
        for (int z = 0; z < p_.update.reads; ++z) now_[z] = older_[z] = inner(p_.update.ports[z].weights, modal_now_);
        step_ = 0;
        std::fill(force_.begin(), force_.end(), 0.0);  // a pluck begins from 0
        failed_ = false;
        from(older_);
        inertia_ = p_.on_body ? 2 * free_.back() / (p_.dt * p_.dt) : 0;
    }
    void start(const double* force, double a) noexcept { put(force, a); }
    void approach(bool last_of_row) noexcept {
        if (last_of_row) keep();
        if (applied() != 1)
            for (double& f : force_) f *= 0.5;
        form_.advance(force_.data(), read_.data());
        older_.swap(now_);
        now_.swap(coming_);
        ++step_;
        if (pluck_port_ >= 0) push_by_pluck();
        from(older_);
        if (p_.on_body) inertia_ = (read_.back() - 2 * now_.back() + older_.back()) / (p_.dt * p_.dt);
    }
    Spent pass(const double* force, double a, bool probed) noexcept {
        put(force, a);
        return probed ? account() : Spent{};
    }
    bool failed() const { return failed_; }
    void reading(int level, double* out) const noexcept { std::copy_n((level == 0 ? now_ : coming_).begin(), p_.points.count(), out); }

    int dofs() const { return 2 * p_.update.modes(); }
    std::vector<Fact> facts() const {
        std::vector<Fact> facts = {{facts::interior_nodes, double(p_.update.modes())},
                                   {facts::modes_above_nyquist, double(p_.three_point.above_nyquist)}};
        if (!p_.points.series && p_.string().barriers.size() == 1 && std::holds_alternative<LumpedBarrier>(p_.string().barriers.front())) {
            const auto& g = p_.update.ports.front().weights;
            double own = 0;
            for (int j = 0; j < p_.modes.count(); ++j) own += p_.update.gain * g[j] * g[j] / p_.update.kappa[j];
            facts.push_back({facts::static_compliance, own / static_compliance(p_.modes, g)});
        }
        return facts;
    }
    std::vector<FreeMode> free_modes() const {
        std::vector<FreeMode> all;
        for (int j = 0; j < p_.modes.count(); ++j) all.push_back(three_point_mode(p_.three_point.kappa[j], p_.three_point.loss[j], p_.dt));
        return all;
    }

    // ---- On a body (schemes/body/instrument.hpp)

    double inertia() const { return inertia_; }
    double pluck() const { return pluck_port_ >= 0 ? force_[pluck_port_] : 0; }
    double share() const {
        const auto& mu = p_.update.ports[p_.points.count()].weights;
        double sum = 0;
        for (int j = 0; j < p_.modes.count(); ++j)  // of the mass that H shows (21)
            sum += mu[j] * mu[j] / (p_.modes.mass * (1 - 0.5 * p_.three_point.loss[j] - 0.25 * p_.three_point.kappa[j]));
        return sum;
    }
    double momentum() noexcept {  // sum mu_j v_j of the half step
        fill_coming();
        return inner(p_.update.ports[p_.points.count()].weights, modal_coming_) / p_.dt;
    }

private:
    double applied() const { return step_ == 0 ? 0.5 : 1; }  // of its force that a step applies: half in the first half step only

    void keep() noexcept {  // before the last step of a row
        if (!differenced_) return;
        form_.levels.keep();
        std::copy(force_.begin(), force_.end(), earlier_force_.begin());
        for (double& f : earlier_force_) f *= applied();
    }
    void push_by_pluck() noexcept {
        const double F_e = jvari::force(*p_.points.pluck, static_cast<double>(step_) * p_.dt);
        force_[pluck_port_] = F_e;
        for (std::size_t z = 0; F_e != 0 && z < read_.size(); ++z) read_[z] += p_.theta[pluck_port_][z] * F_e;
    }
    void from(const std::vector<double>& older) noexcept {
        double all = 0;
        for (std::size_t z = 0; z < free_.size(); ++z) {
            free_[z] = read_[z] - older[z];
            all += read_[z];
        }
        failed_ = !std::isfinite(all);
    }
    void put(const double* force, double a) noexcept {  // the forces of the step, and what they make of its newer level
        const double share = applied();
        const std::size_t points = p_.points.count(), reads = read_.size();
        std::copy_n(force, points, force_.begin());
        if (p_.on_body) force_[points] = -a;
        for (std::size_t z = 0; z < reads; ++z) {
            coming_[z] = read_[z] + share * p_.theta[z][z] * force_[z];
            for (std::size_t c = 0; coupled_ && c < reads; ++c)
                if (c != z) coming_[z] += share * p_.theta[c][z] * force_[c];
        }
    }

    // ---- Energy, in the modal constants of three_point.hpp

    void fill_coming() noexcept {  // y^{n+1} - y^n with the force of step n
        form_.to_modal(form_.levels.increment, modal_coming_.data());
        for (std::size_t z = 0; z < p_.update.ports.size(); ++z) {
            if (force_[z] == 0) continue;
            const double push = p_.update.gain * applied() * force_[z];
            for (int j = 0; j < p_.modes.count(); ++j) modal_coming_[j] += push * p_.update.ports[z].weights[j];
        }
    }

    Spent account() noexcept {  // what step n supplied and dissipated
        modal_last_.swap(modal_coming_);
        fill_coming();
        const double dt = p_.dt;
        Spent spent;
        for (int j = 0; j < p_.modes.count(); ++j) {
            const double r = modal_coming_[j] + modal_last_[j];
            spent.dissipated += p_.three_point.loss[j] * r * r;
        }
        spent.dissipated *= p_.modes.mass / (4 * dt * dt);  // (20)
        if (const double F_e = pluck(); F_e != 0) {
            const auto& g = p_.update.ports[pluck_port_].weights;
            for (int j = 0; j < p_.modes.count(); ++j) spent.supplied += g[j] * (modal_coming_[j] + modal_last_[j]);
            spent.supplied *= 0.5 * F_e;
        }
        const int last = p_.points.count() - 1;
        if (last >= 0) spent.moved = coming_[last] - older_[last];
        return spent;
    }

public:
    double stored() noexcept {  // H^{n+1/2}  (21)
        form_.to_modal(form_.levels.displacement, modal_now_.data());
        fill_coming();
        const double per_dt = 1 / (p_.dt * p_.dt);
        double H = 0;
        for (int j = 0; j < p_.modes.count(); ++j) {
            const double y = modal_now_[j], d = modal_coming_[j];
            H += 0.5 * (1 + p_.update.Ct[j]) * d * d + p_.update.kappa[j] * y * (y + d);
        }
        return 0.5 * p_.modes.mass * per_dt * H;
    }

private:
    // ---- Rows

    TapReading reading_of(const Tap& tap) {
        TapReading r{tap.quantity, {}, {}, {}, {}, {}};
        if (tap.quantity == Quantity::nut_force) r.displacement = form_.reading(nut_force_weights(p_.modes, p_.string()));
        if (tap.quantity == Quantity::displacement) r.displacement = form_.reading(displacement_weights(p_.modes, tap.position));
        if (tap.quantity != Quantity::velocity) return r;
        const auto w = displacement_weights(p_.modes, tap.position);
        const int n = p_.modes.count();
        std::vector<double> y(n), d(n), kept(n), now(n);
        for (int j = 0; j < n; ++j) {
            const double G = p_.three_point.velocity[j];
            y[j] = G > 0 ? w[j] * (G * (p_.three_point.kappa[j] + p_.three_point.loss[j]) - p_.modes.sigma[j]) : 0;
            d[j] = G > 0 ? 2 * G * w[j] : 0.5 * w[j] / p_.dt;
            now[j] = p_.update.gain * (G > 0 ? G * w[j] : 0.5 * w[j] / p_.dt);
            kept[j] = G > 0 ? 0 : 0.5 * w[j] / p_.dt;
            differenced_ = differenced_ || G == 0;
        }
        if (differenced_) form_.levels.listen();
        r.displacement = form_.reading(y);
        r.increment = form_.reading(d);
        r.kept = form_.reading(kept);
        for (const Port& port : p_.update.ports) {
            r.force.push_back(inner(now, port.weights));
            r.earlier_force.push_back(p_.update.gain * inner(kept, port.weights));
        }
        return r;
    }

    double value(const TapReading& r, double bridge, double thread) const {
        switch (r.quantity) {
            case Quantity::bridge_force: return bridge;
            case Quantity::thread_force: return thread;
            case Quantity::driving_force: return -(bridge + thread);
            case Quantity::displacement:
            case Quantity::nut_force: return dot(r.displacement, form_.levels.displacement);
            case Quantity::velocity: break;
        }
        if (step_ == 0) return 0;
        double v = dot(r.displacement, form_.levels.displacement) + dot(r.increment, form_.levels.increment);
        if (differenced_) v += dot(r.kept, form_.levels.kept);
        for (std::size_t z = 0; z < r.force.size(); ++z) v += r.force[z] * force_[z] + r.earlier_force[z] * earlier_force_[z];
        return v;
    }

public:
    void write(const Block& out, int row, double bridge, double thread) const noexcept {
        for (int k = 0; k < out.taps; ++k) out.tap[k * out.stride + row] = value(readings_[k], bridge, thread);
    }

private:
    Problem p_;
    Form form_;
    std::vector<TapReading> readings_;
    bool differenced_ = false;  // a velocity tap has modes near or above Nyquist
    bool coupled_ = false;      // reads by each other's forces: nodes are not
    bool failed_ = false;
    int pluck_port_ = -1;
    long step_ = 0;
    std::vector<double> older_, now_, coming_;                   // levels n-1, n, n+1 of the reads [m]
    std::vector<double> read_, free_;                            // level n+1 without the points' forces, and from level n-1 to there
    std::vector<double> force_, earlier_force_;                  // F^n and, for velocity taps, F^{n-1} of each port [N]
    double inertia_ = 0;                                         // sum mu v'' without forces [N]
    std::vector<double> modal_now_, modal_last_, modal_coming_;  // y^n, y^n - y^{n-1}, y^{n+1} - y^n
};

constexpr Option form_option{"form",
                             "restricted",
                             "how a step is computed: for the places that are read alone, or for all nodes by the paper's full matrices",
                             {"restricted", "dense"}};
constexpr Option options[] = {compliance_option, profile_points_option, form_option};

// What cut and step take from the string's compliance: a constant force on a mode moves it by gain/kappa (14).
MissingMatrix missing_of(const Descriptor& descriptor, const Problem& p) {
    const String& s = p.string();
    const Sites sites = sites_of(p.scene, footprints_of(s));
    std::vector<std::vector<double>> w;
    for (const Reading& r : sites.readings)
        w.push_back(r.nut_force ? nut_force_weights(p.modes, s) : footprint_weights(p.modes, r.at.position, r.at.width));
    return missing_matrix(descriptor.name, s, sites, p.scene.taps.size(), p.modes.count(), [&](int r, int f) {
        double sum = 0;
        for (int j = 0; j < p.modes.count(); ++j) sum += w[r][j] * p.update.ports[f].weights[j] / p.update.kappa[j];
        return p.update.gain * sum;
    });
}

Problem problem_of(const Descriptor& descriptor, const Scene& scene, const Settings& settings) {
    Problem p;
    p.scene = scene;
    p.dt = 1 / settings.sample_rate;
    p.steps_per_row = steps_per_row(settings);
    const bool matched = matched_without_loss(descriptor, scene, settings), on_body = needed_by(scene).has(Feature::moving_body);
    if (matched) p.scene.strings.front() = with_profile_points(p.string(), settings);
    const int intervals = matched ? modes_for(p.string(), settings) + 1 : intervals_for(p.string(), settings);
    if (intervals < 2) throw Refusal("modal_spatial_newton needs one mode at least");
    p.modes = modes_of(p.string(), intervals - 1);
    p.initial = initial_displacement(p.modes, p.string());
    p.on_body = on_body;
    const SpatialPorts ports = spatial_ports(p.string(), p.modes, intervals, scene.name, matched || on_body, on_body);
    const bool linear = ports.points.empty() && !p.string().thread;
    p.three_point = three_point(p.modes, p.dt, (linear ? 0.95 : 0.25) * std::numbers::pi);
    p.update = {intervals, p.three_point.Ct, p.three_point.kappa, p.three_point.gain, ports.ports, 0};
    p.update.reads = static_cast<int>(ports.points.size()) + (p.string().thread ? 1 : 0) + (on_body ? 1 : 0);
    p.points = points_of(p.string(), p.dt);
    for (const ContactPoint& point : ports.points) {
        p.points.contacts.add(point.law, point.height, point.contact_loss);
        p.points.positions.push_back(point.position);
    }
    if (p.string().thread) p.points.positions.push_back(p.string().thread->position);
    const std::vector<Port>& all = p.update.ports;
    for (std::size_t a = 0; a < all.size(); ++a) {
        p.theta.emplace_back();
        for (int b = 0; b < p.update.reads; ++b) {
            const bool apart = all[a].node != 0 && all[b].node != 0 && all[a].node != all[b].node;  // nodes are orthogonal
            p.theta[a].push_back(apart ? 0 : p.update.gain * inner(all[std::min<int>(a, b)].weights, all[std::max<int>(a, b)].weights));
            if (static_cast<int>(a) < p.update.reads) p.points.theta.push_back(p.theta[a].back());
        }
    }
    if (matched) p.points.series = missing_of(descriptor, p);
    return p;
}

template <class Form, class Rule>
std::unique_ptr<Scheme> in_form(const Scene& scene, std::vector<std::unique_ptr<Problem>> problems) {
    const double dt = problems.front()->dt;
    const int steps = problems.front()->steps_per_row;
    const bool on_body = problems.front()->on_body;
    std::vector<std::unique_ptr<SpatialNewton<Form>>> strings;
    for (auto& p : problems) strings.push_back(std::make_unique<SpatialNewton<Form>>(std::move(*p)));
    if (!on_body) return std::make_unique<Driver<SpatialNewton<Form>, Rule>>(std::move(strings.front()), steps);
    return std::make_unique<Instrument<SpatialNewton<Form>, ThreePointBody>>(scene, std::move(strings),
                                                                             ThreePointBody(scene.body->modes, dt), steps);
}

template <class Rule>
std::unique_ptr<Scheme> made(const Descriptor& descriptor, const Scene& scene, const Settings& settings) {
    validate(scene);
    if (scene.strings.empty()) throw Refusal("modal_spatial_newton: scene " + scene.name + " has no string");
    if (!(settings.sample_rate > 0)) throw Refusal("modal_spatial_newton needs a sample rate");
    auto problems =
        each_string<Problem>(scene, [&](const Scene& one) { return std::make_unique<Problem>(problem_of(descriptor, one, settings)); });
    if (choice_option(settings, form_option) == "restricted") return in_form<RestrictedForm, Rule>(scene, std::move(problems));
    constexpr int most_dense = 1 << 13;  // half a gigabyte of matrix
    for (const auto& p : problems)
        if (p->update.modes() > most_dense)
            throw Refusal("option form: dense takes no more than " + std::to_string(most_dense) + " modes, not " +
                          std::to_string(p->update.modes()));
    return in_form<DenseForm, Rule>(scene, std::move(problems));
}

constexpr Features represented = Feature::bending_stiffness | Feature::damping | Features(Feature::frequency_dependent_damping) |
                                 Features(Feature::measured_modes) | Features(Feature::lumped_barrier) |
                                 Features(Feature::profile_barrier) | Features(Feature::several_barriers) |
                                 Features(Feature::power_law_contact) | Features(Feature::contact_loss) | Features(Feature::thread) |
                                 Features(Feature::initial_shape) | Features(Feature::pluck) | Features(Feature::moving_body);

}  // namespace

extern const Descriptor modal_spatial_newton = {
    .name = "modal_spatial_newton",
    .source = "Issanchou et al. 2016, eqs 13-16, 20-21, 24-28",
    .represents = represented,
    .balance = Balance::exact,
    .clock = Clock::stepped,
    .make = made<GradientRule>,
    .options = options,
    .note = "But on a moving body several contact points only where each is a node of the grid, and a thread only with one contact point.",
    .stand_in_rank = 3};

extern const StringRow modal_spatial_newton_row;
const StringRow modal_spatial_newton_row = {&modal_spatial_newton, 2, {JVARI_RULES(JVARI_MAKER)}};

}  // namespace jvari
