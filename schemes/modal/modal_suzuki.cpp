#include "schemes/modal/modal_suzuki.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "scenes/excitation.hpp"
#include "schemes/contact/matching_facts.hpp"
#include "schemes/contact/series_points.hpp"
#include "schemes/modal/kernels/kick_pass.hpp"
#include "schemes/modal/modal_compliance.hpp"

namespace jvari {

namespace {
constexpr int parts = 5;
const double outer = 1 / (4 - std::cbrt(4.0)), inner = 1 - 4 * outer;
const std::array<double, parts> lengths{outer, outer, inner, outer, outer};  // of dt
bool backwards(int part) {
    return lengths[part] < 0;
}
double kick_before(int part) {  // length of the kick that opens it: halves of two parts
    return 0.5 * (lengths[(part + parts - 1) % parts] + lengths[part]);
}

double omega0_squared(const ModalString& m, int i) {  // without damping [rad^2/s^2]
    const double w = m.omega[i], s = m.sigma[i];
    return w >= 0 ? s * s + w * w : s * s - w * w;
}

struct Free {  // motion of each mode over some time: (q, v) -> (a q + b v, c q + d v)
    ModalArray a, b, c, d;
    Free(const ModalString& m, double t) {
        for (int i = 0; i < m.count; ++i) {
            const double w = m.omega[i], s = m.sigma[i], E = std::exp(-s * t);
            const double C = w >= 0 ? std::cos(w * t) : std::cosh(w * t), S = sine_over(w, t);
            a.push_back(E * (C + s * S));
            b.push_back(E * S);
            c.push_back(-E * omega0_squared(m, i) * S);
            d.push_back(E * (C - s * S));
        }
        for (ModalArray* all : {&a, &b, &c, &d}) all->resize(m.size);
    }
};

class ModalSuzuki final : public Scheme {
public:
    ModalSuzuki(const Descriptor& descriptor, const Scene& scene, ModalString string)
        : m_(std::move(string)), free_{Free(m_, outer * m_.dt), Free(m_, inner * m_.dt)}, q_(m_.size), v_(m_.size) {
        const String& s = scene.strings.front();
        pluck_ = s.pluck;
        C_ = modal_compliance(descriptor, scene, modes_of(s, m_.count), yielding());
        for (const bool back : {false, true}) {
            points_[back] = SeriesPoints(s.barriers.empty() ? nullptr : &m_.barrier, m_.h_b, m_.k_c, m_.r_c, m_.h_c, C_);
            points_[back].set_time(0.5 * (back ? inner : outer) * m_.dt);
        }
        pass_ = {m_.size, q_.data(), v_.data(), nullptr, nullptr, nullptr, nullptr, m_.g_b.data(), m_.g_c.data(), m_.g_e.data()};
        for (const bool plucked : {false, true}) passes_[plucked] = kick_pass(!m_.g_b.empty(), !m_.g_c.empty(), plucked);
        ModalSuzuki::reset();
    }

    void reset() noexcept override {
        q_ = m_.y0;
        v_.assign(m_.size, 0.0);
        step_ = 0;
        status_ = {};
        impulse_ = {};
        impacts_ = ImpactShare(m_.dt);
        supplied_ = dissipated_ = least_ = most_ = 0;
        const double y_c = modal_dot(m_.g_c, q_);
        Y_ = points_[0].r_c > 0 ? y_c - m_.h_c : 0;
        stand(modal_dot(m_.g_b, q_), y_c, 0, false);
        act();
    }

    Status advance(const Block& out) noexcept override {
        for (int row = 0; row < out.rows && status_.outcome == Outcome::ok; ++row) {
            write(out, row);
            impulse_ = {};
            for (int k = 0; k < m_.steps_per_row; ++k) {
                step(out.energy != nullptr);
                if (out.stopped(k, steps_between_questions)) return {};
            }
            if (!(std::abs(y_b_ + y_c_) < modal_overflow)) status_ = {Outcome::diverged, step_ - 1};
        }
        return status_;
    }

    int dofs() const override { return 2 * m_.count; }
    std::vector<Fact> facts() const override {
        if (m_.g_b.empty()) return {};
        std::vector<Fact> f = {{facts::smallest_contact_force, least_},
                               {facts::largest_contact_force, most_},
                               {facts::deepest_penetration, most_ > 0 ? std::pow(most_ / m_.barrier.k, 1 / m_.barrier.alpha) : 0},
                               {facts::series_compliance, points_[0].law.S}};
        for (const Fact& fact : matching_facts(points_[0], impacts_)) f.push_back(fact);
        return f;
    }

private:
    void step(bool probed) {
        const double begins = static_cast<double>(step_) * m_.dt;
        double passed = 0;  // of dt
        for (int part = 0; part < parts; ++part) {
            const SeriesPoints& points = points_[backwards(part)];
            const double kick = part == 0 && step_ == 0 ? 0.5 * lengths[0] : kick_before(part);
            const double share = part == 0 ? 0.5 * lengths[0] : kick;  // of this row: half of the kick at a row is the row's before
            impulse_.b += share * F_.b;
            impulse_.c += share * F_.c;
            relax(points.relaxed(y_b_, y_c_, Y_, F_.b), probed);
            move(free_[backwards(part)], kick, probed);
            passed += lengths[part];
            stand(pass_.y_b, pass_.y_c, part + 1 == parts ? begins + m_.dt : begins + passed * m_.dt, probed);
            relax(points.relaxed(y_b_, y_c_, Y_), probed);
            act();
        }
        impulse_.b += 0.5 * lengths[parts - 1] * F_.b;
        impulse_.c += 0.5 * lengths[parts - 1] * F_.c;
        impacts_.take(F_.b);
        ++step_;
    }
    void relax(double Y, bool probed) {  // to what it is after half a part's time, the string held
        if (probed) dissipated_ += points_[0].energy(y_b_, y_c_, Y_) - points_[0].energy(y_b_, y_c_, Y);
        Y_ = Y;
    }
    void move(const Free& free, double kick, bool probed) {
        pass_.a = free.a.data();
        pass_.b = free.b.data();
        pass_.c = free.c.data();
        pass_.d = free.d.data();
        aim(kick);
        const Kicked kicked = probed ? now() : Kicked{};
        passes_[F_e_ != 0](pass_);
        if (!probed) return;
        aim(0);
        supplied_ += kicked.work;
        dissipated_ += kicked.energy - now().energy;
    }
    void aim(double kick) {
        const double over_mass = kick * m_.dt / m_.mass;
        pass_.P_b = over_mass * F_.b;
        pass_.P_c = over_mass * F_.c;
        pass_.P_e = over_mass * F_e_;
    }
    void stand(double y_b, double y_c, double t, bool probed) {  // the points at that time
        const double before = probed ? points_[0].energy(y_b + C_.be * F_e_, y_c + C_.ce * F_e_, Y_) : 0;
        F_e_ = pluck_ ? force(*pluck_, t) : 0;
        y_b_ = y_b + C_.be * F_e_;
        y_c_ = y_c + C_.ce * F_e_;
        if (probed) supplied_ += points_[0].energy(y_b_, y_c_, Y_) - before;  // what the pluck moves within C
    }
    void act() {
        F_ = points_[0].forces(y_b_, y_c_, Y_);
        least_ = std::min(least_, F_.b);
        most_ = std::max(most_, F_.b);
    }

    double kicked(int i) const {  // velocity of a mode after the kick that is aimed
        return v_[i] + (m_.g_b.empty() ? 0 : m_.g_b[i] * pass_.P_b) + (m_.g_c.empty() ? 0 : m_.g_c[i] * pass_.P_c) +
               (m_.g_e.empty() ? 0 : m_.g_e[i] * pass_.P_e);
    }
    struct Kicked {
        double energy = 0, work = 0;  // of the modes after it, of the pluck in it [J]
    };
    Kicked now() const {
        Kicked k;
        for (int i = 0; i < m_.count; ++i) {
            const double v = kicked(i);
            k.energy += 0.5 * m_.mass * (v * v + omega0_squared(m_, i) * q_[i] * q_[i]);
            if (!m_.g_e.empty()) k.work += 0.5 * m_.mass * m_.g_e[i] * pass_.P_e * (v_[i] + v);
        }
        return k;
    }
    void write(const Block& out, int row) {
        aim(step_ > 0 ? 0.5 * lengths[parts - 1] : 0);  // the half kick before the instant
        const auto velocity = [this](const ModalArray& weights) {
            double sum = 0;
            for (int i = 0; i < m_.count; ++i) sum += weights[i] * kicked(i);
            return sum;
        };
        write_taps(out, row, m_.taps, q_, velocity, impulse_.b / m_.steps_per_row, impulse_.c / m_.steps_per_row);
        for (int k = 0; k < out.taps; ++k)
            if (!m_.taps[k].weights.empty()) out.tap[k * out.stride + row] += C_.on_tap(k, F_.b, F_.c, F_e_);
        if (!out.energy) return;
        const Kicked instant = now();
        write_energy(out, row, instant.energy + points_[0].energy(y_b_, y_c_, Y_), supplied_ + instant.work, dissipated_);
        supplied_ = -instant.work;  // the next kick counts it once more
        dissipated_ = 0;
    }

    // Of each mode under 1 N: what five kicks and five moves leave where it was [m/N].
    std::vector<double> yielding() const {
        std::vector<double> all;
        for (int i = 0; i < m_.count; ++i) {
            const auto step = [&](double q, double v, double F) {
                for (int part = 0; part < parts; ++part) {
                    const Free& free = free_[backwards(part)];
                    v += kick_before(part) * m_.dt / m_.mass * F;
                    const double moved = free.a[i] * q + free.b[i] * v;
                    v = free.c[i] * q + free.d[i] * v;
                    q = moved;
                }
                return std::array{q, v};
            };
            const auto on_q = step(1, 0, 0), on_v = step(0, 1, 0), by_F = step(0, 0, 1);
            const double a = 1 - on_q[0], b = -on_v[0], c = -on_q[1], d = 1 - on_v[1];
            all.push_back((d * by_F[0] - b * by_F[1]) / (a * d - b * c));
        }
        return all;
    }

    ModalString m_;
    std::optional<Pluck> pluck_;
    std::array<Free, 2> free_;  // over an outer part, over the inner, which goes backwards
    std::array<SeriesPoints, 2> points_;
    MissingCompliance C_;
    ModalArray q_, v_;
    KickPass pass_;
    KickPassFunction passes_[2] = {};  // without pluck, with it
    long step_ = 0;
    Status status_;
    double y_b_ = 0, y_c_ = 0, Y_ = 0;  // of the points, the pluck's share of C counted in; of the thread, less h_c [m]
    SeriesPoints::Forces F_;            // at the instant
    double F_e_ = 0;                    // [N]
    SeriesPoints::Forces impulse_;      // since the last row, over dt [N]
    double supplied_ = 0, dissipated_ = 0;
    double least_ = 0, most_ = 0;  // of the contact force [N]
    ImpactShare impacts_;
};

}  // namespace

std::unique_ptr<Scheme> modal_suzuki(const Descriptor& descriptor, const Scene& scene, ModalString string) {
    return std::make_unique<ModalSuzuki>(descriptor, scene, std::move(string));
}

}  // namespace jvari
