#include "schemes/modal/three_point_modes.hpp"

#include <cmath>

#include "schemes/making.hpp"
#include "schemes/modal/modal_compliance.hpp"

namespace jvari {

ModalArray ThreePointModes::plain_gain(const ModalString& string) {
    return ModalArray(string.size, string.dt * string.dt / string.mass);
}
ModalArray ThreePointModes::modal_mass(const ModalString& string, const ModalArray&) {
    return ModalArray(string.count, string.mass);
}

ThreePointModes::ThreePointModes(const Descriptor& descriptor, const Scene& scene, const Settings& settings, Gain gain_of,
                                 Inertia inertia_of) {
    Scene bare = scene, pointwise = scene;
    const String s = pointwise.strings.front() = with_profile_points(scene.strings.front(), settings);
    bare.strings.front().barriers.clear();
    m_ = modal_string(descriptor, bare, settings);
    p_ = points_of(s, m_.dt);
    add_lumped(p_, s);
    for (ModalArray* a : {&q_, &d_, &next_}) a->assign(m_.size, 0.0);
    d0_ = rest_increments(m_);
    const ModalArray gain = gain_of(m_);
    W_ = inertia_of(m_, gain);
    W_.resize(m_.size);
    const Modes modes = modes_of(s, settings);
    for (const Footprint& f : sites_of(pointwise).forces) {
        if (g_.size() == p_.positions.size()) break;
        const auto g = footprint_weights(modes, f.position, f.width);
        g_.emplace_back(g.begin(), g.end());
        g_.back().resize(m_.size);
    }
    const auto moved = [&](ModalArray g) {
        for (int i = 0; i < m_.count; ++i) g[i] *= gain[i];
        return g;
    };
    for (const ModalArray& g : g_) e_.push_back(moved(g));
    if (!m_.g_e.empty()) e_e_ = moved(m_.g_e);
    for (std::size_t a = 0; a < g_.size(); ++a)
        for (std::size_t b = 0; b < g_.size(); ++b) p_.theta.push_back(modal_dot(g_[std::min(a, b)], e_[std::max(a, b)]));
    std::vector<double> own;
    for (int i = 0; i < m_.count; ++i) own.push_back(m_.num[i] > 0 ? gain[i] / m_.num[i] : 0);  // under a steady force: d = 0
    if (choice_option(settings, compliance_option) == "matched") p_.series = modal_missing_matrix(descriptor, pointwise, modes, own);
    else if (p_.contacts.count() == 1) compliance_ = relative_compliance(modes, s, own);
    for (auto* v : {&now_, &older_, &coming_, &free_}) v->assign(g_.size(), 0.0);
    for (std::size_t p = 0; p < g_.size(); ++p) theta_e_.push_back(m_.g_e.empty() ? 0 : modal_dot(g_[p], e_e_));
    if (p_.contacts.count() <= 1) {
        const bool barrier = p_.contacts.count() == 1, thread = p_.thread.has_value();
        fused_ = {m_.size, q_.data(), d_.data(), m_.loss.data(), m_.num.data()};
        if (barrier) fused_.g_b = g_.front().data(), fused_.e_b = e_.front().data();
        if (thread) fused_.g_c = g_.back().data(), fused_.e_c = e_.back().data();
        fused_.e_e = e_e_.data();
        unplucked_ = three_point_pass(barrier, thread, false);
        plucked_ = three_point_pass(barrier, thread, true);
    }
    reset();
}

void ThreePointModes::reset() noexcept {
    std::copy(m_.y0.begin(), m_.y0.end(), q_.begin());
    std::copy(d0_.begin(), d0_.end(), d_.begin());
    step_ = 0;
    for (std::size_t p = 0; p < g_.size(); ++p) now_[p] = older_[p] = modal_dot_by_eights(g_[p], q_);
    F_e_ = 0.5 * m_.pluck_at(0);
    fill_next(F_e_);
    free_motion();
}

void ThreePointModes::start(const double* force, double) noexcept {
    apply(force, 0.5);
}

void ThreePointModes::approach(bool) noexcept {
    ++step_;
    const double F_e = m_.pluck_at(step_);
    if (unplucked_) {
        (fused_.F_e != 0 ? plucked_ : unplucked_)(fused_);
        F_e_ = F_e;
        const std::size_t c = p_.contacts.count();
        older_.swap(now_);
        if (c == 1) now_[0] = fused_.x_b, free_[0] = fused_.v_b + theta_e_[0] * F_e;
        if (p_.thread) now_[c] = fused_.x_c, free_[c] = fused_.v_c + theta_e_[c] * F_e;
        return;
    }
    for (int i = 0; i < m_.size; ++i) q_[i] += next_[i];
    d_.swap(next_);
    older_.swap(now_);
    now_.swap(coming_);
    F_e_ = F_e;
    fill_next(F_e);
    free_motion();
}

void ThreePointModes::fill_next(double F_e) noexcept {  // without the points' forces
    for (int i = 0; i < m_.size; ++i) next_[i] = (1 - m_.loss[i]) * d_[i] - m_.num[i] * q_[i];
    for (int i = 0; F_e != 0 && i < m_.size; ++i) next_[i] += e_e_[i] * F_e;
}

void ThreePointModes::free_motion() noexcept {
    for (std::size_t p = 0; p < g_.size(); ++p) free_[p] = now_[p] - older_[p] + modal_dot_by_eights(g_[p], next_);
}

void ThreePointModes::apply(const double* force, double share) noexcept {
    sum_ = 0;
    if (unplucked_) {
        const std::size_t c = p_.contacts.count(), points = g_.size();
        fused_.F_b = c == 1 ? share * force[0] : 0;
        fused_.F_c = p_.thread ? share * force[c] : 0;
        fused_.F_e = F_e_;
        for (std::size_t p = 0; p < points; ++p) {
            coming_[p] = older_[p] + free_[p];
            for (std::size_t q = 0; q < points; ++q) coming_[p] += share * p_.theta[p * points + q] * force[q];
            sum_ += now_[p];
        }
        return;
    }
    for (std::size_t p = 0; p < g_.size(); ++p) {
        const double F = share * force[p];
        for (int i = 0; F != 0 && i < m_.size; ++i) next_[i] += e_[p][i] * F;
    }
    for (std::size_t p = 0; p < g_.size(); ++p) sum_ += coming_[p] = now_[p] + modal_dot_by_eights(g_[p], next_);
}

void ThreePointModes::see_next() noexcept {  // d^{n+1} of the step in hand, where the pass has not made it yet
    if (!unplucked_) return;
    fill_next(fused_.F_e);
    const double F[] = {p_.contacts.count() == 1 ? fused_.F_b : fused_.F_c, fused_.F_c};
    for (std::size_t p = 0; p < g_.size(); ++p)
        for (int i = 0; F[p] != 0 && i < m_.size; ++i) next_[i] += e_[p][i] * F[p];
}

Spent ThreePointModes::pass(const double* force, double, bool probed) noexcept {
    apply(force, 1);
    Spent spent;
    if (!probed) return spent;
    see_next();
    double work = 0;
    for (int i = 0; i < m_.size; ++i) {
        const double r = next_[i] + d_[i];
        spent.dissipated += W_[i] * m_.loss[i] * r * r;
        if (F_e_ != 0) work += m_.g_e[i] * r;
    }
    spent.dissipated /= 4 * m_.dt * m_.dt;
    spent.supplied = 0.5 * F_e_ * work;
    if (p_.thread) spent.moved = coming_.back() - older_.back();
    return spent;
}

void ThreePointModes::reading(int level, double* out) const noexcept {
    std::copy_n((level == 0 ? now_ : coming_).begin(), g_.size(), out);
}

double ThreePointModes::stored() noexcept {
    see_next();
    double sum = 0;
    for (int i = 0; i < m_.size; ++i) {
        const double s = 2 * q_[i] + next_[i];
        sum += W_[i] * (m_.den[i] * next_[i] * next_[i] + m_.num[i] * s * s);
    }
    return sum / (8 * m_.dt * m_.dt);
}

void ThreePointModes::write(const Block& out, int row, double bridge, double thread) noexcept {
    for (int k = 0; k < out.taps; ++k)
        if (m_.taps[k].quantity == Quantity::velocity) see_next();
    const auto velocity = [this](const ModalArray& weights) {  // centred; at rest in row 0
        double sum = 0;
        for (int i = 0; step_ > 0 && i < m_.size; ++i) sum += weights[i] * (next_[i] + d_[i]);
        return sum / (2 * m_.dt);
    };
    write_taps(out, row, m_.taps, q_, velocity, bridge, thread);
}

std::vector<Fact> ThreePointModes::facts() const {
    return compliance_ > 0 ? std::vector<Fact>{{facts::static_compliance, compliance_}} : std::vector<Fact>{};
}

}  // namespace jvari
