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
// with contacts and thread (contact/compliance.hpp, obstacle_step.hpp), which may then be coupled; profiles are touched at points of their
// own (option `points`), and contact loss is left out. Refused where the scheme is too soft already.
//
// Order: free motion is exact. Forced motion is second order without losses and first order with them: eq 14 puts dt^2/m F on a mode where
// a damped one wants e^{-sigma dt} of it (a factor per mode would couple the nodes, so the paper's form is kept).
//
// Instants. Step n centres on t = n dt and makes level n+1 of levels n and n-1; its force F^n stands for the interval n-1/2 .. n+1/2.
// Row n is written when F^n is known: displacement is level n; velocity is that of the free motion through levels n-1, n, n+1 corrected for
// F^n for the modes that tell it and a centred difference for the rest (three_point.hpp); a contact force is the trapezoidal mean of F over
// the interval. Stored energy is H^{n+1/2}, which F^n reaches; supplied and dissipated sum the steps after the former row up to n. Row 0:
// H^{1/2}. Start: exact free motion and half of F^0 (spatial_forces.hpp).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/modes.hpp"
#include "schemes/body/body_modes.hpp"
#include "schemes/body/instrument.hpp"
#include "schemes/contact/compliance.hpp"
#include "schemes/making.hpp"
#include "schemes/modal/three_point.hpp"
#include "schemes/modal_coefficients.hpp"
#include "schemes/spatial/spatial_forces.hpp"
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
    SpatialPorts ports;
    LinearUpdate update;
    std::optional<MissingMatrix> missing;  // in series, compliance=matched
    std::optional<StringAtBody> at_body;   // on a moving body
};

template <class Form>
class SpatialNewton final : public Scheme {
public:
    explicit SpatialNewton(Problem p)
        : p_(std::move(p)), form_(p_.update), forces_(p_.string(), p_.ports.points, p_.update, p_.dt, p_.missing, p_.at_body.has_value()) {
        for (const Tap& tap : p_.scene.taps) readings_.push_back(reading_of(tap));
        if (p_.at_body) older_.assign(p_.at_body->points(), 0.0);
        free_ = older_;
        earlier_force_.assign(p_.update.ports.size(), 0.0);
        for (auto* v : {&modal_now_, &modal_last_, &modal_coming_}) v->assign(p_.modes.count(), 0.0);
        reset();
    }

    void reset() noexcept override {
        modal_now_ = p_.initial;
        for (int j = 0; j < p_.modes.count(); ++j) modal_coming_[j] = p_.three_point.start[j] * modal_now_[j];
        form_.start(modal_now_.data(), modal_coming_.data());
        form_.read(forces_.free.data());
        for (int z = 0; z < p_.update.reads; ++z) forces_.now[z] = inner(p_.update.ports[z].weights, modal_now_);
        step_ = 0;
        bridge_impulse_ = thread_impulse_ = supplied_ = dissipated_ = 0;
        forces_.begin();
        bridge_half_ = 0.5 * forces_.bridge();
        thread_half_ = 0.5 * forces_.thread();
    }

    // ---- On a body (schemes/body/instrument.hpp)

    const StringAtBody& at_body() const { return *p_.at_body; }
    const double* older() const { return older_.data(); }
    const double* free() const { return free_.data(); }
    double inertia() const { return inertia_; }
    double pluck() const { return forces_.pluck_port() >= 0 ? forces_.force[forces_.pluck_port()] : 0; }
    double share() const {
        const auto& mu = p_.update.ports[at_body().points()].weights;
        double sum = 0;
        for (int j = 0; j < p_.modes.count(); ++j)  // of the mass that H shows (21)
            sum += mu[j] * mu[j] / (p_.modes.mass * (1 - 0.5 * p_.three_point.loss[j] - 0.25 * p_.three_point.kappa[j]));
        return sum;
    }
    void begin() noexcept {
        reset();
        failed_ = false;
        between(forces_.now);
        inertia_ = 2 * (forces_.free.back() - forces_.now.back()) / (p_.dt * p_.dt);
    }
    void start(const double* force, double a) noexcept {
        forces_.put(force, -a, 0.5);
        bridge_half_ = 0.5 * forces_.bridge();
        thread_half_ = 0.5 * forces_.thread();
    }
    void approach(bool last_of_row) noexcept {
        if (last_of_row) keep();
        next_level();
        failed_ = forces_.pluck(step_) != Outcome::ok;
        between(forces_.older);
        inertia_ = (forces_.free.back() - 2 * forces_.now.back() + forces_.older.back()) / (p_.dt * p_.dt);
    }
    void pass(const double* force, double a, bool probed) noexcept {
        forces_.put(force, -a, 1);
        end_step(probed);
    }
    void reading(int level, double* out) const noexcept {
        std::copy_n((level == 0 ? forces_.now : forces_.coming).begin(), older_.size(), out);
    }
    double momentum() noexcept {  // sum mu_j v_j of the half step
        fill_coming();
        return inner(p_.update.ports[at_body().points()].weights, modal_coming_) / p_.dt;
    }
    bool failed() const { return failed_; }

    // ----

    Status advance(const Block& out) noexcept override {
        for (int row = 0; row < out.rows; ++row) {
            write(out, row);
            for (int s = 0; s < p_.steps_per_row; ++s) {
                if (s + 1 == p_.steps_per_row) keep();
                const Outcome outcome = step(out.energy != nullptr);
                if (outcome != Outcome::ok) return {outcome, step_};
                if (out.stopped(s, steps_between_questions)) return {};
            }
        }
        return {};
    }

    int dofs() const override { return 2 * p_.update.modes(); }

    std::vector<Fact> facts() const override {
        std::vector<Fact> facts = {{facts::interior_nodes, double(p_.update.modes())},
                                   {facts::modes_above_nyquist, double(p_.three_point.above_nyquist)}};
        forces_.add_facts(facts);
        if (!p_.missing && p_.string().barriers.size() == 1 && std::holds_alternative<LumpedBarrier>(p_.string().barriers.front())) {
            const auto& g = p_.update.ports.front().weights;
            double own = 0;
            for (int j = 0; j < p_.modes.count(); ++j) own += p_.update.gain * g[j] * g[j] / p_.update.kappa[j];
            facts.push_back({facts::static_compliance, own / static_compliance(p_.modes, g)});
        }
        return facts;
    }

    std::vector<FreeMode> free_modes() const override {
        std::vector<FreeMode> all;
        for (int j = 0; j < p_.modes.count(); ++j) all.push_back(three_point_mode(p_.three_point.kappa[j], p_.three_point.loss[j], p_.dt));
        return all;
    }

private:
    double applied() const { return step_ == 0 ? 0.5 : 1; }  // of its force that a step applies: half in the first half step only

    void keep() noexcept {  // before the last step of a row
        if (!differenced_) return;
        form_.levels.keep();
        std::copy(forces_.force.begin(), forces_.force.end(), earlier_force_.begin());
        for (double& f : earlier_force_) f *= applied();
    }
    void between(const std::vector<double>& older) noexcept {  // of the points, from there to the next level without forces
        for (std::size_t z = 0; z < older_.size(); ++z) {
            older_[z] = older[z];
            free_[z] = forces_.free[z] - older[z];
        }
    }

    void next_level() noexcept {
        if (applied() != 1)
            for (double& f : forces_.force) f *= 0.5;
        form_.advance(forces_.force.data(), forces_.free.data());
        forces_.shift();
        ++step_;
    }
    Outcome step(bool probed) noexcept {
        next_level();
        const Outcome outcome = forces_.solve(step_);
        end_step(probed);
        return outcome;
    }
    void end_step(bool probed) noexcept {
        bridge_impulse_ += forces_.bridge();
        thread_impulse_ += forces_.thread();
        if (probed) account();
    }

    // ---- Energy, in the modal constants of three_point.hpp

    void fill_coming() noexcept {  // y^{n+1} - y^n with the force of step n
        form_.to_modal(form_.levels.increment, modal_coming_.data());
        for (std::size_t z = 0; z < p_.update.ports.size(); ++z) {
            if (forces_.force[z] == 0) continue;
            const double push = p_.update.gain * applied() * forces_.force[z];
            for (int j = 0; j < p_.modes.count(); ++j) modal_coming_[j] += push * p_.update.ports[z].weights[j];
        }
    }

    void account() noexcept {  // adds what step n supplied and dissipated
        modal_last_.swap(modal_coming_);
        fill_coming();
        const double dt = p_.dt;
        double lost = 0;
        for (int j = 0; j < p_.modes.count(); ++j) {
            const double r = modal_coming_[j] + modal_last_[j];
            lost += p_.three_point.loss[j] * r * r;
        }
        dissipated_ += p_.modes.mass * lost / (4 * dt * dt);  // (20)
        if (const int e = forces_.pluck_port(); e >= 0 && forces_.force[e] != 0) {
            const auto& g = p_.update.ports[e].weights;
            double r = 0;
            for (int j = 0; j < p_.modes.count(); ++j) r += g[j] * (modal_coming_[j] + modal_last_[j]);
            supplied_ += 0.5 * forces_.force[e] * r;
        }
        dissipated_ += forces_.dissipated();
        supplied_ += forces_.supplied();
    }

    double stored() noexcept {  // H^{n+1/2}  (21)
        form_.to_modal(form_.levels.displacement, modal_now_.data());
        fill_coming();
        const double per_dt = 1 / (p_.dt * p_.dt);
        double H = 0;
        for (int j = 0; j < p_.modes.count(); ++j) {
            const double y = modal_now_[j], d = modal_coming_[j];
            H += 0.5 * (1 + p_.update.Ct[j]) * d * d + p_.update.kappa[j] * y * (y + d);
        }
        return 0.5 * p_.modes.mass * per_dt * H + forces_.stored();
    }

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
        for (std::size_t z = 0; z < r.force.size(); ++z) v += r.force[z] * forces_.force[z] + r.earlier_force[z] * earlier_force_[z];
        return v;
    }

public:
    void write(const Block& out, int row) noexcept {
        const double per_row = 1.0 / p_.steps_per_row;
        double bridge = 0, thread = 0;
        if (step_ > 0) {  // trapezoidal mean since the former row
            const double bridge_end = 0.5 * forces_.bridge(), thread_end = 0.5 * forces_.thread();
            bridge = (bridge_half_ + bridge_impulse_ - bridge_end) * per_row;
            thread = (thread_half_ + thread_impulse_ - thread_end) * per_row;
            bridge_half_ = bridge_end;
            thread_half_ = thread_end;
        }
        bridge_impulse_ = thread_impulse_ = 0;
        for (int k = 0; k < out.taps; ++k) out.tap[k * out.stride + row] = value(readings_[k], bridge, thread);
        if (p_.missing)
            for (int k = 0; k < out.taps; ++k) out.tap[k * out.stride + row] += forces_.on_tap(k);
        if (!out.energy) return;
        write_energy(out, row, stored(), supplied_, dissipated_);
        supplied_ = dissipated_ = 0;
    }

private:
    Problem p_;
    Form form_;
    SpatialForces forces_;
    std::vector<TapReading> readings_;
    bool differenced_ = false;  // a velocity tap has modes near or above Nyquist

    long step_ = 0;
    std::vector<double> older_, free_;  // of the points, on a body [m]
    double inertia_ = 0;                // sum mu v'' without forces [N]
    bool failed_ = false;
    std::vector<double> earlier_force_;                                                   // F^{n-1} of each port [N], for velocity taps
    double bridge_impulse_ = 0, thread_impulse_ = 0, bridge_half_ = 0, thread_half_ = 0;  // [N], sums over steps
    double supplied_ = 0, dissipated_ = 0;                                                // since the former row [J]
    std::vector<double> modal_now_, modal_last_, modal_coming_;                           // y^n, y^n - y^{n-1}, y^{n+1} - y^n
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
    p.ports = spatial_ports(p.string(), p.modes, intervals, scene.name, matched || on_body, on_body);
    const bool linear = p.ports.points.empty() && !p.string().thread;
    p.three_point = three_point(p.modes, p.dt, (linear ? 0.95 : 0.25) * std::numbers::pi);
    p.update = {intervals, p.three_point.Ct, p.three_point.kappa, p.three_point.gain, p.ports.ports, 0};
    p.update.reads = static_cast<int>(p.ports.points.size()) + (p.string().thread ? 1 : 0) + (on_body ? 1 : 0);
    if (matched) p.missing = missing_of(descriptor, p);
    if (!on_body) return p;
    StringAtBody at = at_body(p.string());
    for (const ContactPoint& point : p.ports.points) {
        at.laws.push_back(point.law);
        at.heights.push_back(point.height);
        at.loss.push_back(point.contact_loss);
        at.positions.push_back(point.position);
    }
    if (p.string().thread) at.positions.push_back(p.string().thread->position);
    for (int a = 0; a < p.update.reads; ++a)
        for (int b = 0; b < p.update.reads; ++b)
            at.theta.push_back(p.update.gain * inner(p.update.ports[std::min(a, b)].weights, p.update.ports[std::max(a, b)].weights));
    p.at_body = std::move(at);
    return p;
}

template <class Form>
std::unique_ptr<Scheme> in_form(const Scene& scene, std::vector<std::unique_ptr<Problem>> problems) {
    if (!problems.front()->at_body) return std::make_unique<SpatialNewton<Form>>(std::move(*problems.front()));
    const double dt = problems.front()->dt;
    const int steps = problems.front()->steps_per_row;
    std::vector<std::unique_ptr<SpatialNewton<Form>>> strings;
    for (auto& p : problems) strings.push_back(std::make_unique<SpatialNewton<Form>>(std::move(*p)));
    return std::make_unique<Instrument<SpatialNewton<Form>, ThreePointBody>>(scene, std::move(strings),
                                                                             ThreePointBody(scene.body->modes, dt), steps);
}

std::unique_ptr<Scheme> made(const Descriptor& descriptor, const Scene& scene, const Settings& settings) {
    validate(scene);
    if (scene.strings.empty()) throw Refusal("modal_spatial_newton: scene " + scene.name + " has no string");
    if (!(settings.sample_rate > 0)) throw Refusal("modal_spatial_newton needs a sample rate");
    auto problems =
        each_string<Problem>(scene, [&](const Scene& one) { return std::make_unique<Problem>(problem_of(descriptor, one, settings)); });
    if (choice_option(settings, form_option) == "restricted") return in_form<RestrictedForm>(scene, std::move(problems));
    constexpr int most_dense = 1 << 13;  // half a gigabyte of matrix
    for (const auto& p : problems)
        if (p->update.modes() > most_dense)
            throw Refusal("option form: dense takes no more than " + std::to_string(most_dense) + " modes, not " +
                          std::to_string(p->update.modes()));
    return in_form<DenseForm>(scene, std::move(problems));
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
    .make = made,
    .options = options,
    .note = "But on a moving body several contact points only where each is a node of the grid, and a thread only with one contact point.",
    .stand_in_rank = 3};

}  // namespace jvari
