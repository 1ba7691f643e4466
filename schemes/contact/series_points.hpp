// A string's barrier b and thread c with a compliance C in series: what they are at one instant, and how the thread's state moves.
//
// With Y the displacement where a part touches, y that of the scheme's string (the pluck's part of C counted in) and C the missing
// compliance, Y_b - y_b = C_bb F_b + C_bc F_c, Y_c - y_c = C_bc F_b + C_cc F_c. Y_c is the thread's own state; Y_b follows. With
// e = C_bc/C_cc, S = C_bb - e C_bc, D = Y_c - y_c and zeta = h_b - y_b - e D the energy of it all is
//     W = D^2/(2 C_cc) + Phi(zeta) + k_c (Y_c - h_c)^2/2,    Phi of series_contact.hpp with S,
// the forces on the string are F_b = Phi'(zeta), F_c = D/C_cc - e F_b, and r_c dY_c/dt = -F_c - k_c (Y_c - h_c).
// A thread without damping has no state: its spring joins C_cc, and Y_c is its fixed end.
#pragma once

#include "schemes/contact/compliance.hpp"
#include "schemes/contact/series_contact.hpp"

namespace jvari {

struct SeriesPoints {
    bool barrier = false, thread = false;
    SeriesLaw law;
    double h_b = 0, h_c = 0;               // [m]
    double k_c = 0, r_c = 0;               // of the thread's state; 0 where it has none
    double e = 0, C_cc = 0, stiff_cc = 0;  // C_cc with the spring of a thread without state; stiff_cc its inverse
    double wave_resistance = 0;            // of the string [kg/s]

    SeriesPoints() = default;
    SeriesPoints(const ContactLaw* contact, double height_b, double thread_stiffness, double thread_damping, double height_c,
                 const MissingCompliance& C)
        : barrier(contact != nullptr), thread(C.cc > 0), h_b(height_b), h_c(height_c), C_cc(C.cc), wave_resistance(C.wave_resistance) {
        if (thread && thread_damping > 0) {
            k_c = thread_stiffness;
            r_c = thread_damping;
        } else if (thread) {
            C_cc += 1 / thread_stiffness;
        }
        if (thread) stiff_cc = 1 / C_cc;
        if (thread && barrier) e = C.bc * stiff_cc;
        if (barrier) law = SeriesLaw(*contact, C.bb - e * C.bc);
    }

    struct Forces {
        double b = 0, c = 0;  // on the string [N]
    };
    // Y: Y_c - h_c
    double stretch(double y_c, double Y) const { return Y + h_c - y_c; }
    double approach(double y_b, double y_c, double Y) const { return h_b - y_b - (thread ? e * stretch(y_c, Y) : 0); }
    Forces forces(double y_b, double y_c, double Y) const {
        const double F_b = barrier ? law.force(approach(y_b, y_c, Y)) : 0;
        return {F_b, thread ? stretch(y_c, Y) * stiff_cc - e * F_b : 0};
    }
    double energy(double y_b, double y_c, double Y) const {
        const double D = stretch(y_c, Y);
        return (barrier ? law.potential(approach(y_b, y_c, Y)) : 0) + (thread ? 0.5 * D * D / C_cc + 0.5 * k_c * Y * Y : 0);
    }
    // Y after `time` with the string held: exact while the contact neither closes nor opens and its law is linear, else of second order.
    double relaxed(double y_b, double y_c, double Y) const {
        if (r_c == 0) return Y;
        return relaxed(y_b, y_c, Y, barrier ? law.force(approach(y_b, y_c, Y)) : 0);
    }
    double relaxed(double y_b, double y_c, double Y, double F_b) const {  // F_b: at Y
        if (r_c == 0) return Y;
        const double pull = e * F_b - stretch(y_c, Y) * stiff_cc - k_c * Y;
        return Y + pull * (F_b <= 0 ? yield_out : law.law.alpha == 1 ? yield_in : yield(law.slope(approach(y_b, y_c, Y))));
    }
    void set_time(double t) {  // [s]
        time = t;
        yield_out = yield(0);
        yield_in = law.law.alpha == 1 ? yield(law.slope(1)) : 0;
        const double k = law.both;
        out = {1 - yield_out * (stiff_cc + k_c), -yield_out * stiff_cc, 0};
        in = {1 - yield_in * (e * e * k + stiff_cc + k_c), -yield_in * (e * e * k + stiff_cc), yield_in * e * k};
    }

    // An instant between two such times: Y there, the forces, Y after the second. The string is held in each.
    struct Instant {
        double Y_now = 0;
        Forces force;
        double Y_after = 0;
    };
    // Always inlined: as a call it writes the two forces one by one, which are then read as a pair, and the processor waits.
    [[gnu::always_inline]] Instant instant(double y_b, double y_c, double Y, bool at_start) const {  // at_start: there is no time before it
        return law.law.alpha == 1 || !barrier ? linear_instant(y_b, y_c, Y, at_start) : power_instant(y_b, y_c, Y, at_start);
    }

private:
    struct Relaxation {  // Y -> on_Y Y + on_c (h_c - y_c) + on_b (h_b - y_b)
        double on_Y = 1, on_c = 0, on_b = 0;
        double operator()(double Y, double c, double b) const { return on_Y * Y + (on_c * c + on_b * b); }
    };
    Relaxation in, out;  // in contact, and not: exponent 1
    [[gnu::always_inline]] Instant linear_instant(double y_b, double y_c, double Y, bool at_start) const {
        const double b = h_b - y_b, c = h_c - y_c;
        const double from_in = in(Y, c, b), from_out = out(Y, c, b);
        Instant i;
        i.Y_now = at_start ? Y : b - e * (Y + c) > 0 && barrier ? from_in : from_out;
        const double D = i.Y_now + c, zeta = b - e * D, after_in = in(i.Y_now, c, b), after_out = out(i.Y_now, c, b);
        const bool touching = zeta > 0 && barrier;
        i.force.b = touching ? law.both * zeta : 0;
        i.force.c = D * stiff_cc - e * i.force.b;
        i.Y_after = touching ? after_in : after_out;
        return i;
    }
    Instant power_instant(double y_b, double y_c, double Y, bool at_start) const;
    double yield(double slope) const {  // of Y in that time, per newton of pull [m/N]
        const double kappa = k_c + 1 / C_cc + e * e * slope;
        return r_c > 0 ? -std::expm1(-kappa * time / r_c) / kappa : 0;
    }
    double time = 0, yield_out = 0, yield_in = 0;
};

inline SeriesPoints::Instant SeriesPoints::power_instant(double y_b, double y_c, double Y, bool at_start) const {
    Instant i;
    i.Y_now = at_start ? Y : relaxed(y_b, y_c, Y);
    i.force = forces(y_b, y_c, i.Y_now);
    i.Y_after = relaxed(y_b, y_c, i.Y_now, i.force.b);
    return i;
}

}  // namespace jvari
