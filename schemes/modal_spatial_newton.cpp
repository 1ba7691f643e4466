// Full-modal spatial Newton: exact three-point recursion per mode, conservative contact forces on the nodes x_i = iL/N of a grid with as
// many interior nodes as modes. Source: Issanchou et al. 2016, eqs 13-16, 20-21, 24-28.
//
// Beyond the paper: barriers with a footprint, a thread and a pluck act through modal weights; the thread's force is the average of the
// outer levels, F_c = k_c (h_c - (u+ + u-)/2) - r_c (u+ - u-)/(2 dt), and is eliminated from the contact equation as in van Walstijn et al.
// 2016, eqs 45-48. Leaves out: contacts coupled to each other (spatial_ports.cpp refuses them), two polarisations, several strings.
//
// Order: free motion is exact. Forced motion is second order without losses and first order with them: eq 14 puts dt^2/m F on a mode where
// a damped one wants e^{-sigma dt} of it (a factor per mode would couple the nodes, so the paper's form is kept).
//
// Instants. Step n centres on t = n dt and makes level n+1 of levels n and n-1; its force F^n stands for the interval n-1/2 .. n+1/2.
// Row n is written when F^n is known: displacement is level n; velocity is that of the free motion through levels n-1, n, n+1 corrected for
// F^n for the modes that tell it and a centred difference for the rest (three_point.hpp); a contact force is the trapezoidal mean of F over
// the interval. Stored energy is H^{n+1/2}, which F^n reaches; supplied and dissipated sum the steps after the former row up to n. Row 0:
// H^{1/2}. Start: from rest both neighbours of level 0 carry half of F^0, the contact force at level 1 (implicit, so deep contact is
// stable).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/excitation.hpp"
#include "scenes/modes.hpp"
#include "schemes/spatial_forms.hpp"
#include "schemes/spatial_ports.hpp"
#include "schemes/three_point.hpp"

namespace jvari {

extern const Descriptor modal_spatial_newton;

namespace {

// A place where the string meets a barrier, with what the solver needs.
struct Contact {
    ContactLaw law;
    double height;  // [m]
    double theta;   // increment of the point per force on it [m/N], the thread's yielding included
    double drag;    // contact_loss/(2 dt) [1/m]: the loss force is drag V'(eta) r
};

struct ThreadPort {  // u_c+ = free + theta F_c + cross F_b
    Thread thread;
    int port;
    double theta, cross;  // [m/N]; cross to the contact point, 0 without one
    double yield;         // B = k_c/2 + r_c/(2 dt) [N/m]
    double recoil;        // -dF_c/dF_b
};

struct PluckPort {
    Pluck pluck;
    int port;
    std::vector<double> reach;  // increment of each read per force [m/N]
};

struct TapReading {
    Quantity quantity;
    AlignedVector displacement, increment, kept;  // weights on the form's levels
    std::vector<double> force, earlier_force;     // velocity: weights of F^n and F^{n-1}
};

struct Effort {
    double solves = 0, iterations = 0, most = 0, residual = 0, smallest_force = 0, deepest = 0;
};

double inner(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t j = 0; j < a.size(); ++j) sum += a[j] * b[j];
    return sum;
}

// Depth d of a point pressed from `free` depth at rest: d + theta V'(d) = free. Newton from above on a convex function.
double settle(const ContactLaw& law, double free, double theta) {
    if (free <= 0) return 0;
    double d = std::min(free, std::pow(free / (theta * law.k), 1 / law.alpha));
    for (int i = 0; i < 60; ++i) {
        const double load = theta * law.force(d), step = (d + load - free) / (1 + law.alpha * load / d);
        d -= step;
        if (std::abs(step) <= 1e-15 * d) break;
    }
    return d;
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
};

template <class Form>
class SpatialNewton final : public Scheme {
public:
    explicit SpatialNewton(Problem p) : p_(std::move(p)), form_(p_.update) {
        const auto& ports = p_.update.ports;
        const double gain = p_.update.gain;
        for (std::size_t z = 0; z < p_.ports.points.size(); ++z) {
            const ContactPoint& point = p_.ports.points[z];
            contacts_.push_back(
                {point.law, point.height, gain * inner(ports[z].weights, ports[z].weights), point.contact_loss / (2 * p_.dt)});
        }
        int next = static_cast<int>(contacts_.size());
        if (const auto& t = p_.string().thread) {
            ThreadPort c{*t, next++, 0, 0, 0.5 * t->stiffness + 0.5 * t->damping / p_.dt, 0};
            c.theta = gain * inner(ports[c.port].weights, ports[c.port].weights);
            for (Contact& contact : contacts_) {  // one at most
                c.cross = gain * inner(ports[c.port].weights, ports[0].weights);
                c.recoil = c.yield * c.cross / (1 + c.yield * c.theta);
                own_theta_ = contact.theta;
                contact.theta -= c.cross * c.recoil;
            }
            threads_.push_back(c);
        }
        if (const auto& e = p_.string().pluck) {
            PluckPort pluck{*e, next++, {}};
            for (int z = 0; z < p_.update.reads; ++z) pluck.reach.push_back(gain * inner(ports[pluck.port].weights, ports[z].weights));
            plucks_.push_back(pluck);
        }
        for (const Tap& tap : p_.scene.taps) readings_.push_back(reading_of(tap));
        for (auto* v : {&older_, &now_, &free_, &coming_}) v->assign(std::max<std::size_t>(p_.update.reads, 1), 0.0);
        force_.assign(ports.size() + 1, 0.0);
        earlier_force_ = force_;
        for (auto* v : {&modal_now_, &modal_last_, &modal_coming_}) v->assign(p_.modes.count(), 0.0);
        reset();
    }

    void reset() noexcept override {
        modal_now_ = p_.initial;
        for (int j = 0; j < p_.modes.count(); ++j) modal_coming_[j] = p_.three_point.start[j] * modal_now_[j];
        form_.start(modal_now_.data(), modal_coming_.data());
        form_.read(free_.data());
        for (int z = 0; z < p_.update.reads; ++z) now_[z] = inner(p_.update.ports[z].weights, modal_now_);
        effort_ = {};
        step_ = 0;
        bridge_impulse_ = thread_impulse_ = supplied_ = dissipated_ = 0;
        begin();
        bridge_half_ = 0.5 * bridge_force();
        thread_half_ = 0.5 * thread_force();
    }

    Status advance(const Block& out) noexcept override {
        for (int row = 0; row < out.rows; ++row) {
            write(out, row);
            for (int s = 0; s < p_.steps_per_row; ++s) {
                if (differenced_ && s + 1 == p_.steps_per_row) {
                    form_.keep();
                    std::copy(force_.begin(), force_.end(), earlier_force_.begin());
                    for (double& f : earlier_force_) f *= share();
                }
                const Outcome outcome = step(out.energy != nullptr);
                if (outcome != Outcome::ok) return {outcome, step_};
            }
        }
        return {};
    }

    int dofs() const override { return 2 * p_.update.modes(); }

    std::vector<Fact> facts() const override {
        return {{"smallest_contact_force", effort_.smallest_force, "N"},
                {"deepest_penetration", effort_.deepest, "m"},
                {"interior_nodes", double(p_.update.modes()), ""},
                {"contact_points", double(contacts_.size()), ""},
                {"contact_solves", effort_.solves, ""},
                {"contact_iterations_mean", effort_.solves > 0 ? effort_.iterations / effort_.solves : 0, ""},
                {"contact_iterations_most", effort_.most, ""},
                {"contact_residual", effort_.residual, ""},
                {"modes_above_nyquist", double(p_.three_point.above_nyquist), ""}};
    }

private:
    double share() const { return step_ == 0 ? 0.5 : 1; }  // of its force that a step applies: the first half step only
    double bridge_force() const {
        double sum = 0;
        for (std::size_t z = 0; z < contacts_.size(); ++z) sum += force_[z];
        return sum;
    }
    double thread_force() const { return threads_.empty() ? 0 : force_[threads_.front().port]; }

    // From rest: the same equations with u- = u+ and half the compliance.
    void begin() noexcept {
        for (PluckPort& e : plucks_) {
            force_[e.port] = jvari::force(e.pluck, 0);
            for (int z = 0; z < p_.update.reads; ++z) free_[z] += 0.5 * e.reach[z] * force_[e.port];
        }
        std::copy(free_.begin(), free_.end(), coming_.begin());
        double recoil = 0;
        for (ThreadPort& c : threads_) {
            const double give = 1 + 0.5 * c.thread.stiffness * c.theta;
            recoil = 0.5 * c.thread.stiffness * c.cross / give;
            force_[c.port] = c.thread.stiffness * (c.thread.height - free_[c.port]) / give;
            if (!contacts_.empty()) coming_[0] += 0.5 * c.cross * force_[c.port];
        }
        for (std::size_t z = 0; z < contacts_.size(); ++z) {
            const Contact& contact = contacts_[z];
            const double theta = threads_.empty() ? 0.5 * contact.theta : 0.5 * (own_theta_ - threads_.front().cross * recoil);
            const double depth = settle(contact.law, contact.height - coming_[z], theta);
            force_[z] = contact.law.force(depth);
            coming_[z] += theta * force_[z];
            effort_.deepest = std::max({effort_.deepest, depth, contact.height - now_[z]});
        }
        for (ThreadPort& c : threads_) {
            const double F_b = contacts_.empty() ? 0 : force_[0];
            force_[c.port] -= recoil * F_b;
            coming_[c.port] += 0.5 * (c.theta * force_[c.port] + c.cross * F_b);
        }
    }

    Outcome step(bool probed) noexcept {
        if (share() != 1)
            for (double& f : force_) f *= 0.5;
        form_.advance(force_.data(), free_.data());
        older_.swap(now_);
        now_.swap(coming_);
        ++step_;
        const Outcome outcome = solve();
        bridge_impulse_ += bridge_force();
        thread_impulse_ += thread_force();
        if (probed) account();
        return outcome;
    }

    // F^n of every port, and coming_ = level n+1 at the reads.
    Outcome solve() noexcept {
        for (PluckPort& e : plucks_) {
            const double t = double(step_) * p_.dt - e.pluck.start;
            force_[e.port] = t < 0 || t > e.pluck.duration ? 0 : jvari::force(e.pluck, double(step_) * p_.dt);
            if (force_[e.port] != 0)
                for (int z = 0; z < p_.update.reads; ++z) free_[z] += e.reach[z] * force_[e.port];
        }
        for (ThreadPort& c : threads_) {
            const double pull = c.thread.stiffness * c.thread.height + (c.yield - c.thread.stiffness) * older_[c.port];
            force_[c.port] = (pull - c.yield * free_[c.port]) / (1 + c.yield * c.theta);
            coming_[c.port] = free_[c.port] + c.theta * force_[c.port];
            if (!contacts_.empty()) free_[0] += c.cross * force_[c.port];
        }
        Outcome outcome = Outcome::ok;
        for (std::size_t z = 0; z < contacts_.size(); ++z) {
            const Contact& contact = contacts_[z];
            const double eta = contact.height - older_[z], above = free_[z] - contact.height;
            const double drag = contact.drag == 0 ? 0 : contact.drag * contact.law.force(contact.height - now_[z]);  // [N/m]
            if (eta <= 0 && above >= 0 && drag == 0) {
                force_[z] = 0;
                coming_[z] = free_[z];
                continue;
            }
            const double c = contact.theta * drag, scale = 1 / (1 + c);  // (27)
            const ContactSolution s = solve_contact(contact.law, eta, (older_[z] - free_[z]) * scale, contact.theta * scale);
            force_[z] = s.force - drag * s.r;
            coming_[z] = older_[z] + s.r;
            ++effort_.solves;
            effort_.iterations += s.iterations;
            effort_.most = std::max(effort_.most, double(s.iterations));
            effort_.residual = std::max(effort_.residual, s.residual);
            effort_.smallest_force = std::min(effort_.smallest_force, force_[z]);
            effort_.deepest = std::max(effort_.deepest, contact.height - coming_[z]);
            if (!s.converged) outcome = Outcome::not_converged;
            if (!std::isfinite(free_[z])) outcome = Outcome::diverged;
        }
        for (ThreadPort& c : threads_) {
            if (contacts_.empty()) break;
            force_[c.port] -= c.recoil * force_[0];
            coming_[c.port] += (c.cross - c.theta * c.recoil) * force_[0];
        }
        return outcome;
    }

    // ---- Energy, in the modal constants of three_point.hpp

    void fill_coming() noexcept {  // y^{n+1} - y^n with the force of step n
        form_.to_modal(form_.levels.increment, modal_coming_.data());
        for (std::size_t z = 0; z < p_.update.ports.size(); ++z) {
            if (force_[z] == 0) continue;
            const double push = p_.update.gain * share() * force_[z];
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
        for (const PluckPort& e : plucks_) {
            if (force_[e.port] == 0) continue;
            const auto& g = p_.update.ports[e.port].weights;
            double r = 0;
            for (int j = 0; j < p_.modes.count(); ++j) r += g[j] * (modal_coming_[j] + modal_last_[j]);
            supplied_ += 0.5 * force_[e.port] * r;
        }
        for (std::size_t z = 0; z < contacts_.size(); ++z) {
            const Contact& c = contacts_[z];
            if (c.drag == 0) continue;
            const double r = coming_[z] - older_[z];
            dissipated_ += 0.5 * c.drag * c.law.force(c.height - now_[z]) * r * r;  // (28)
        }
        for (const ThreadPort& c : threads_) {
            const double r = coming_[c.port] - older_[c.port];
            dissipated_ += 0.25 * c.thread.damping / dt * r * r;
        }
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
        H *= 0.5 * p_.modes.mass * per_dt;
        for (std::size_t z = 0; z < contacts_.size(); ++z) {
            const Contact& c = contacts_[z];
            H += 0.5 * (c.law.potential(c.height - now_[z]) + c.law.potential(c.height - coming_[z]));
        }
        for (const ThreadPort& c : threads_) {
            const double a = c.thread.height - now_[c.port], b = c.thread.height - coming_[c.port];
            H += 0.25 * c.thread.stiffness * (a * a + b * b);
        }
        return H;
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
        if (differenced_) form_.listen();
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

    void write(const Block& out, int row) noexcept {
        const double per_row = 1.0 / p_.steps_per_row;
        double bridge = 0, thread = 0;
        if (step_ > 0) {  // trapezoidal mean since the former row
            const double bridge_end = 0.5 * bridge_force(), thread_end = 0.5 * thread_force();
            bridge = (bridge_half_ + bridge_impulse_ - bridge_end) * per_row;
            thread = (thread_half_ + thread_impulse_ - thread_end) * per_row;
            bridge_half_ = bridge_end;
            thread_half_ = thread_end;
        }
        bridge_impulse_ = thread_impulse_ = 0;
        for (int k = 0; k < out.taps; ++k) out.tap[k * out.stride + row] = value(readings_[k], bridge, thread);
        if (!out.energy) return;
        out.energy[row] = stored();
        out.energy[out.stride + row] = supplied_;
        out.energy[2 * out.stride + row] = dissipated_;
        supplied_ = dissipated_ = 0;
    }

    Problem p_;
    Form form_;
    std::vector<Contact> contacts_;
    std::vector<ThreadPort> threads_;  // one or none, as plucks_
    std::vector<PluckPort> plucks_;
    double own_theta_ = 0;  // of the contact point, without a yielding thread
    std::vector<TapReading> readings_;
    bool differenced_ = false;  // a velocity tap has modes near or above Nyquist

    long step_ = 0;
    std::vector<double> older_, now_, coming_, free_;  // levels n-1, n, n+1 and n+1 without F^n, of each read [m]
    std::vector<double> force_, earlier_force_;        // of each port [N]
    double bridge_impulse_ = 0, thread_impulse_ = 0, bridge_half_ = 0, thread_half_ = 0;  // [N], sums over steps
    double supplied_ = 0, dissipated_ = 0;                                                // since the former row [J]
    std::vector<double> modal_now_, modal_last_, modal_coming_;                           // y^n, y^n - y^{n-1}, y^{n+1} - y^n
    Effort effort_;
};

// Multiply-adds a step. A transform of 2N points costs about 2N times the sum of N's prime factors: a large prime in N is expensive.
std::string cheapest_form(const LinearUpdate& u) {
    double factors = 1;
    for (int n = u.intervals, f = 2; n > 1; ++f)
        for (; n % f == 0; n /= f) factors += f;
    const double n = u.modes(), restricted = n * (3.0 + u.reads), sine = n * 3 + 4 * n * factors;
    return restricted <= sine ? "restricted" : "dst";  // dense, 2 n^2, is never below restricted: reads <= n
}

std::unique_ptr<Scheme> make(const Scene& scene, const Settings& settings) {
    validate(scene);
    refuse_missing(modal_spatial_newton, scene);
    refuse_unknown_options(settings, {"form"});
    if (scene.strings.empty()) throw Refusal("modal_spatial_newton: scene " + scene.name + " has no string");
    if (!(settings.sample_rate > 0)) throw Refusal("modal_spatial_newton needs a sample rate");
    Problem p;
    p.scene = scene;
    p.dt = 1 / settings.sample_rate;
    p.steps_per_row = steps_per_row(settings);
    const int intervals = intervals_for(p.string(), settings);
    if (intervals < 2) throw Refusal("modal_spatial_newton needs one mode at least");
    p.modes = modes_of(p.string(), intervals - 1);
    p.initial = initial_displacement(p.modes, p.string());
    p.ports = spatial_ports(p.string(), p.modes, intervals, scene.name);
    const bool linear = p.ports.points.empty() && !p.string().thread;
    p.three_point = three_point(p.modes, p.dt, (linear ? 0.95 : 0.25) * std::numbers::pi);
    p.update = {intervals, p.three_point.Ct, p.three_point.kappa, p.three_point.gain, p.ports.ports, 0};
    p.update.reads = static_cast<int>(p.ports.points.size()) + (p.string().thread ? 1 : 0);

    std::string form = option(settings, "form", "auto");
    if (form == "auto") form = cheapest_form(p.update);
    if (form == "dense") return std::make_unique<SpatialNewton<DenseForm>>(std::move(p));
    if (form == "restricted") return std::make_unique<SpatialNewton<RestrictedForm>>(std::move(p));
    if (form == "dst") return std::make_unique<SpatialNewton<SineForm>>(std::move(p));
    throw Refusal("option form: found \"" + form + "\", expected auto, dense, restricted or dst");
}

constexpr Features represented = Feature::bending_stiffness | Feature::damping | Features(Feature::frequency_dependent_damping) |
                                 Features(Feature::measured_modes) | Features(Feature::lumped_barrier) |
                                 Features(Feature::profile_barrier) | Features(Feature::several_barriers) |
                                 Features(Feature::power_law_contact) | Features(Feature::contact_loss) | Features(Feature::thread) |
                                 Features(Feature::initial_shape) | Features(Feature::pluck);

}  // namespace

const Descriptor modal_spatial_newton = {
    "modal_spatial_newton", "Issanchou et al. 2016, eqs 13-16, 20-21, 24-28", represented, Balance::exact, Clock::stepped, make};

}  // namespace jvari
