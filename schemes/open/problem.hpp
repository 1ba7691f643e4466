// One string in plain arrays (jvari_scheme.h): the form in which schemes from outside receive a
// scene, by C structures, NumPy arrays or JSON.
//
// A profile becomes contacts in the middles of equal parts, 16 unless an option `points` says
// otherwise. Leaves out: polarisation, a moving body and all strings but the first; they are in the
// scene's text alone.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "schemes/open/jvari_scheme.h"
#include "schemes/scheme.hpp"

namespace jvari {

struct Modes;

class Problem {
public:
    Problem(const Scene&, const Settings&);  // throws Refusal, BadScene
    Problem(const Problem&) = delete;
    Problem& operator=(const Problem&) = delete;
    const jvari_problem& arrays() const { return p_; }

private:
    void put_contacts(const String&, const Modes&);
    void put_thread(const Thread&, const Modes&);
    void put_pluck(const Pluck&, const Modes&);
    void put_options(const OptionValues&);
    const double* keep(std::vector<double>);
    const char* const* keep(const std::vector<std::string>&);
    jvari_problem p_{};
    std::deque<std::vector<double>> numbers_;
    std::deque<std::string> texts_;
    std::deque<std::vector<const char*>> lists_;
};

// Refusal if the scene has features that the arrays do not hold; for schemes that see the arrays
// alone.
void refuse_beyond_arrays(const Scene&);

// Calls to(name, value) for each member that a reader of arrays needs: double, std::int64_t, const
// char*, Matrix or Words.
struct Matrix {
    const double* data;
    std::int64_t rows, columns;  // rows < 0: a vector of `columns` numbers
};
struct Words {
    const char* const* data;
    std::int64_t count;
};
template <class To>
void each_member(const jvari_problem& p, To to) {
    const std::int64_t points = p.contacts + p.threads;
    const auto vector = [&](const char* name, const double* data, std::int64_t n) {
        to(name, Matrix{data, -1, n});
    };
    to("name", p.name), to("scene", p.scene);
    to("sample_rate", p.sample_rate), to("tap_rate", p.tap_rate), to("duration", p.duration);
    to("rows", p.rows), to("steps_per_row", p.steps_per_row);
    to("modes", p.modes), to("contacts", p.contacts), to("threads", p.threads),
        to("plucks", p.plucks), to("taps", p.taps);
    to("length", p.length), to("linear_density", p.linear_density), to("tension", p.tension);
    to("bending_stiffness", p.bending_stiffness), to("modal_mass", p.modal_mass);
    vector("beta", p.beta, p.modes), vector("omega0", p.omega0, p.modes),
        vector("sigma", p.sigma, p.modes);
    vector("start", p.start, p.modes);
    vector("contact_position", p.contact_position, p.contacts),
        vector("contact_width", p.contact_width, p.contacts);
    to("contact_weights", Matrix{p.contact_weights, p.contacts, p.modes});
    vector("contact_stiffness", p.contact_stiffness, p.contacts),
        vector("contact_exponent", p.contact_exponent, p.contacts);
    vector("contact_height", p.contact_height, p.contacts),
        vector("contact_loss", p.contact_loss, p.contacts);
    to("thread_position", p.thread_position), to("thread_width", p.thread_width);
    vector("thread_weights", p.thread_weights, p.threads * p.modes);
    to("thread_stiffness", p.thread_stiffness), to("thread_damping", p.thread_damping),
        to("thread_height", p.thread_height);
    to("pluck_position", p.pluck_position), to("pluck_width", p.pluck_width);
    vector("pluck_weights", p.pluck_weights, p.plucks * p.modes),
        vector("pluck_force", p.pluck_force, p.pluck_samples);
    to("tap_names", Words{p.tap_names, p.taps}),
        to("tap_quantities", Words{p.tap_quantities, p.taps});
    vector("tap_position", p.tap_position, p.taps);
    to("tap_weights", Matrix{p.tap_weights, p.taps, p.modes});
    to("compliance", Matrix{p.compliance, points, points}),
        to("tap_compliance", Matrix{p.tap_compliance, p.taps, points});
    vector("radiation", p.radiation, points);
}

}  // namespace jvari
