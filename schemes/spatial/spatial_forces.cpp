// Sources: Issanchou et al. 2016, eqs 16, 24-28 (contact); van Walstijn et al. 2016, eqs 14-15 and 45-48 (pluck, elimination of the
// thread).
#include "schemes/spatial/spatial_forces.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scenes/excitation.hpp"
#include "schemes/contact/contact.hpp"

namespace jvari {

namespace {
double inner(const std::vector<double>& a, const std::vector<double>& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
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

}  // namespace

SpatialForces::SpatialForces(const String& s, const std::vector<ContactPoint>& points, const LinearUpdate& update, double dt,
                             const std::optional<MissingMatrix>& missing, bool on_body)
    : older(update.reads), now(update.reads), free(update.reads), coming(update.reads), force(update.ports.size()), dt_(dt) {
    const auto theta = [&](int a, int b) { return update.gain * inner(update.ports[a].weights, update.ports[b].weights); };
    int next = 0;
    for (const ContactPoint& point : points) {
        contacts_.push_back({point.law, point.height, theta(next, next), point.contact_loss / (2 * dt)});
        ++next;
    }
    if (s.thread) {
        Coil c{*s.thread, next, theta(next, next), 0, 0.5 * s.thread->stiffness + 0.5 * s.thread->damping / dt, 0};
        for (Contact& contact : contacts_) {  // one at most
            c.cross = theta(next, 0);
            c.recoil = c.yield * c.cross / (1 + c.yield * c.theta);
            own_theta_ = contact.theta;
            contact.theta -= c.cross * c.recoil;
        }
        threads_.push_back(c);
        ++next;
    }
    if (on_body) {
        ++next;
        for (int a = 0; a < update.reads; ++a)
            for (int b = 0; b < update.reads; ++b) theta_.push_back(theta(std::min(a, b), std::max(a, b)));
    }
    if (s.pluck) {
        Finger e{*s.pluck, next, {}};
        for (int z = 0; z < update.reads; ++z) e.reach.push_back(theta(next, z));
        plucks_.push_back(e);
    }
    if (!missing) return;
    const int reads = update.reads;
    series_ = Series{*missing, {}, {}, {}, std::vector<double>(reads), std::vector<double>(reads), std::vector<double>(reads)};
    std::vector<double> half;
    for (int a = 0; a < reads; ++a)
        for (int b = 0; b < reads; ++b) {
            series_->theta.push_back(theta(std::min(a, b), std::max(a, b)));
            half.push_back(0.5 * series_->theta.back());
        }
    std::vector<ContactLaw> laws;
    std::vector<double> heights;
    for (const ContactPoint& point : points) {
        laws.push_back(point.law);
        heights.push_back(point.height);
    }
    series_->step = ObstacleStep(laws, heights, s.thread, series_->theta, 2 * dt);
    series_->start = ObstacleStep(laws, heights, s.thread, half, dt);
    series_->step.put_in_series(*missing, 2);
    series_->start.put_in_series(*missing, 1);
}

double SpatialForces::pluck_at(long n) const {
    return plucks_.empty() ? 0 : jvari::force(plucks_.front().law, double(n) * dt_);
}

void SpatialForces::begin_in_series() noexcept {
    Series& s = *series_;
    const std::size_t reads = now.size();
    n_ = 0;
    s.step.clear();
    s.start.clear();
    for (std::size_t z = 0; z < reads; ++z) {
        s.a[z] = now[z] + pluck_on(z, 0);
        s.b[z] = free[z] + pluck_on(z, 1) - s.a[z];
    }
    s.start.begin(s.a.data());
    s.start.solve(s.a.data(), s.b.data(), force.data());
    move(s.theta, 0.5);
    s.step.follow(s.start);
}

Outcome SpatialForces::solve_in_series(long n) noexcept {
    Series& s = *series_;
    const std::size_t reads = now.size();
    n_ = n;
    for (std::size_t z = 0; z < reads; ++z) {
        s.a[z] = older[z] + pluck_on(z, n - 1);
        s.b[z] = free[z] + pluck_on(z, n + 1) - s.a[z];
        if (!std::isfinite(free[z])) return Outcome::diverged;
    }
    const bool converged = s.step.solve(s.a.data(), s.b.data(), force.data());
    move(s.theta, 1);
    return converged ? Outcome::ok : Outcome::not_converged;
}

double SpatialForces::supplied() const {
    if (!series_) return 0;
    double work = 0;
    for (std::size_t z = 0; z < now.size(); ++z) work -= 0.5 * force[z] * (pluck_on(z, n_ + 1) - pluck_on(z, n_ - 1));
    return work;
}

double SpatialForces::on_tap(std::size_t k) const {
    if (!series_) return 0;
    for (std::size_t z = 0; z < now.size(); ++z) series_->a[z] = now[z] + pluck_on(z, n_);
    series_->step.forces(0, series_->now.data());
    return series_->missing.on_tap(k, series_->now.data(), pluck_at(n_));
}

double SpatialForces::bridge() const {
    return std::accumulate(force.begin(), force.begin() + static_cast<long>(contacts_.size()), 0.0);
}

double SpatialForces::thread() const {
    return threads_.empty() ? 0 : force[threads_.front().port];
}

void SpatialForces::begin() noexcept {
    std::fill(force.begin(), force.end(), 0.0);  // a pluck begins from 0
    effort_ = {};
    if (!theta_.empty()) return;
    if (series_) return begin_in_series();
    std::copy(free.begin(), free.end(), coming.begin());
    double recoil = 0;
    for (Coil& c : threads_) {
        const double give = 1 + 0.5 * c.law.stiffness * c.theta;
        recoil = 0.5 * c.law.stiffness * c.cross / give;
        force[c.port] = c.law.stiffness * (c.law.height - free[c.port]) / give;
        if (!contacts_.empty()) coming[0] += 0.5 * c.cross * force[c.port];
    }
    for (std::size_t z = 0; z < contacts_.size(); ++z) {
        const Contact& contact = contacts_[z];
        const double theta = threads_.empty() ? 0.5 * contact.theta : 0.5 * (own_theta_ - threads_.front().cross * recoil);
        const double depth = settle(contact.law, contact.height - coming[z], theta);
        force[z] = contact.law.force(depth);
        coming[z] += theta * force[z];
        effort_.deepest = std::max({effort_.deepest, depth, contact.height - now[z]});
    }
    for (Coil& c : threads_) {
        const double F_b = contacts_.empty() ? 0 : force[0];
        force[c.port] -= recoil * F_b;
        coming[c.port] += 0.5 * (c.theta * force[c.port] + c.cross * F_b);
    }
}

void SpatialForces::shift() noexcept {
    older.swap(now);
    now.swap(coming);
}

void SpatialForces::put(const double* points, double body, double share) noexcept {
    std::copy_n(points, now.size() - 1, force.begin());
    force[now.size() - 1] = body;
    move(theta_, share);
}

void SpatialForces::move(const std::vector<double>& theta, double share) noexcept {
    const std::size_t reads = now.size();
    for (std::size_t z = 0; z < reads; ++z) {
        coming[z] = free[z];
        for (std::size_t c = 0; c < reads; ++c) coming[z] += share * theta[z * reads + c] * force[c];
    }
}

Outcome SpatialForces::pluck(long n) noexcept {
    for (Finger& e : plucks_) {
        const double t = double(n) * dt_ - e.law.start;
        force[e.port] = t < 0 || t > e.law.duration ? 0 : jvari::force(e.law, double(n) * dt_);
        if (force[e.port] != 0)
            for (std::size_t z = 0; z < free.size(); ++z) free[z] += e.reach[z] * force[e.port];
    }
    return std::all_of(free.begin(), free.end(), [](double y) { return std::isfinite(y); }) ? Outcome::ok : Outcome::diverged;
}

Outcome SpatialForces::solve(long n) noexcept {
    pluck(n);
    if (series_) return solve_in_series(n);
    for (Coil& c : threads_) {
        const double pull = c.law.stiffness * c.law.height + (c.yield - c.law.stiffness) * older[c.port];
        force[c.port] = (pull - c.yield * free[c.port]) / (1 + c.yield * c.theta);
        coming[c.port] = free[c.port] + c.theta * force[c.port];
        if (!contacts_.empty()) free[0] += c.cross * force[c.port];
    }
    Outcome outcome = Outcome::ok;
    for (std::size_t z = 0; z < contacts_.size(); ++z) {
        const Contact& contact = contacts_[z];
        const double eta = contact.height - older[z], above = free[z] - contact.height;
        const double drag = contact.drag == 0 ? 0 : contact.drag * contact.law.force(contact.height - now[z]);  // [N/m]
        if (eta <= 0 && above >= 0 && drag == 0) {
            force[z] = 0;
            coming[z] = free[z];
            continue;
        }
        const double c = contact.theta * drag, scale = 1 / (1 + c);  // (27)
        const ContactSolution s = solve_contact(contact.law, eta, (older[z] - free[z]) * scale, contact.theta * scale);
        force[z] = s.force - drag * s.r;
        coming[z] = older[z] + s.r;
        ++effort_.solves;
        effort_.iterations += s.iterations;
        effort_.most = std::max(effort_.most, double(s.iterations));
        effort_.residual = std::max(effort_.residual, s.residual);
        effort_.force.note(force[z]);
        effort_.deepest = std::max(effort_.deepest, contact.height - coming[z]);
        if (!s.converged) outcome = Outcome::not_converged;
        if (!std::isfinite(free[z])) outcome = Outcome::diverged;
    }
    for (Coil& c : threads_) {
        if (contacts_.empty()) break;
        force[c.port] -= c.recoil * force[0];
        coming[c.port] += (c.cross - c.theta * c.recoil) * force[0];
    }
    return outcome;
}

double SpatialForces::stored() const {
    if (!theta_.empty()) return 0;
    if (series_) {
        for (std::size_t z = 0; z < now.size(); ++z) {
            series_->a[z] = now[z] + pluck_on(z, n_);
            series_->b[z] = coming[z] + pluck_on(z, n_ + 1);
        }
        return 0.5 * (series_->step.potential(series_->a.data(), 0) + series_->step.potential(series_->b.data(), 1));
    }
    double H = 0;
    for (std::size_t z = 0; z < contacts_.size(); ++z) {
        const Contact& c = contacts_[z];
        H += 0.5 * (c.law.potential(c.height - now[z]) + c.law.potential(c.height - coming[z]));  // (21)
    }
    for (const Coil& c : threads_) {
        const double a = c.law.height - now[c.port], b = c.law.height - coming[c.port];
        H += 0.25 * c.law.stiffness * (a * a + b * b);
    }
    return H;
}

double SpatialForces::dissipated() const {
    if (!theta_.empty()) return 0;
    if (series_) return now.empty() ? 0 : dt_ * series_->step.loss(coming.back() - older.back());
    double lost = 0;
    for (std::size_t z = 0; z < contacts_.size(); ++z) {
        const Contact& c = contacts_[z];
        if (c.drag == 0) continue;
        const double r = coming[z] - older[z];
        lost += 0.5 * c.drag * c.law.force(c.height - now[z]) * r * r;  // (28)
    }
    for (const Coil& c : threads_) {
        const double r = coming[c.port] - older[c.port];
        lost += 0.25 * c.law.damping / dt_ * r * r;
    }
    return lost;
}

void SpatialForces::add_facts(std::vector<Fact>& facts) const {
    if (!theta_.empty()) return;
    if (series_) {
        const ObstacleStep::Tally& t = series_->step.tally();
        facts.push_back({facts::smallest_contact_force, t.force.least});
        facts.push_back({facts::largest_contact_force, t.force.most});
        facts.push_back({facts::deepest_penetration, t.deepest});
        facts.push_back({facts::contact_points, double(contacts_.size())});
        facts.push_back({facts::contact_iterations_mean, t.solves > 0 ? double(t.iterations) / double(t.solves) : 0});
        facts.push_back({facts::contact_iterations_most, double(t.most_iterations)});
        facts.push_back({facts::contact_residual, t.residual});
        facts.push_back({facts::series_compliance, contacts_.empty() ? 0 : series_->missing.C[0]});
        facts.push_back({facts::compliance_excess, series_->missing.excess});
        return;
    }
    facts.push_back({facts::smallest_contact_force, effort_.force.least});
    facts.push_back({facts::largest_contact_force, effort_.force.most});
    facts.push_back({facts::deepest_penetration, effort_.deepest});
    facts.push_back({facts::contact_points, double(contacts_.size())});
    facts.push_back({facts::contact_solves, effort_.solves});
    facts.push_back({facts::contact_iterations_mean, effort_.solves > 0 ? effort_.iterations / effort_.solves : 0});
    facts.push_back({facts::contact_iterations_most, effort_.most});
    facts.push_back({facts::contact_residual, effort_.residual});
}

}  // namespace jvari
