// What tests do with runs: a scheme by its name and options, a scene as it is wanted, and what a
// run shows. Independent of analysis, which is tested as well.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

#include "reference/references.hpp"
#include "schemes/driver/pairings.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"
#include "tests/says.hpp"

namespace jvari {

// ---- Scenes

inline Scene lasting(Scene scene, double seconds) {
    scene.duration = seconds;
    return scene;
}
// displacement of the string at x, and all that a scene hears of its first mass
inline std::vector<Tap> taps_beside_a_mass(double x) {
    return {{"y", Quantity::displacement, 0, x},
            {"z", Quantity::displacement, 0, 0, 0},
            {"v", Quantity::velocity, 0, 0, 0},
            {"F", Quantity::bridge_force, 0, 0, 0}};
}
inline LumpedBarrier& barrier(Scene& scene, int k = 0) {
    return std::get<LumpedBarrier>(scene.strings.front().barriers[static_cast<std::size_t>(k)]);
}
inline Scene with_exponent(Scene scene, double exponent) {
    barrier(scene).exponent = exponent;
    return scene;
}
inline Scene with_damping(Scene scene, const Damping& damping) {
    scene.strings.front().damping = damping;
    return scene;
}
inline Scene with_loss(Scene scene, double beta) {
    for (Barrier& b : scene.strings.front().barriers)
        std::visit([beta](auto& x) { x.contact_loss = beta; }, b);
    return scene;
}

// ---- Runs

inline const Descriptor& named(const std::string& name) {
    for (const auto& table : {schemes(), references(), std::span(schemes_of_pairings())})
        for (const Descriptor& d : table)
            if (name == d.name) return d;
    throw std::runtime_error("no scheme " + name);
}

inline std::vector<const Descriptor*> all_descriptors() {
    std::vector<const Descriptor*> all;
    for (const auto& table : {schemes(), references()})
        for (const Descriptor& d : table) all.push_back(&d);
    return all;
}

// A form is a scheme with options: "modal_quadratised levels=3 variant=raw".
inline const Descriptor& with_options(const std::string& form, Settings& settings) {
    std::istringstream words(form);
    std::string name, option;
    words >> name;
    while (words >> option) {
        const std::size_t is = option.find('=');
        settings.options.emplace_back(option.substr(0, is), option.substr(is + 1));
    }
    const Descriptor& d = named(name);
    if (d.clock == Clock::continuous) settings.sample_rate = 0;
    return d;
}
inline Run play(const std::string& form, const Scene& scene, Settings settings,
                const RunOptions& how = {}) {
    const Descriptor& d = with_options(form, settings);
    return run(d, scene, settings, how);
}

// Why a form does not take a scene; "" where it does.
inline std::string refusal(const std::string& form, const Scene& scene, Settings settings) {
    const Descriptor& d = with_options(form, settings);
    try {
        make_scheme(d, scene, settings);
    } catch (const Refusal& refusal) { return refusal.what(); }
    return "";
}

// ---- What they show

inline double fact(const std::vector<Fact>& facts, const std::string& name) {
    for (const Fact& f : facts)
        if (f.name == name) return f.value;
    ADD_FAILURE() << "no fact " << name;
    return std::nan("");
}
inline double fact(const Run& r, const std::string& name) { return fact(r.facts, name); }

inline double apart(const Run& a, const Run& b, int tap) {  // relative, L2
    return relative_difference(a.trace.column(tap), b.trace.column(tap));
}
inline double largest(std::span<const double> x) {
    double most = 0;
    for (const double v : x) most = std::max(most, std::abs(v));
    return most;
}
inline double largest_difference(std::span<const double> a, std::span<const double> b) {
    double most = 0;
    for (std::size_t n = 0; n < b.size(); ++n) most = std::max(most, std::abs(a[n] - b[n]));
    return most;
}

// The energy columns: how far a row, and all rows together, are from balance, relative to the
// largest energy stored until then; what is lost, relative to the largest of all.
struct Ledger {
    double row = 0, sum = 0, lost = 0, least_loss = 0;
};
inline Ledger ledger(const Trace& t) {
    const auto stored = t.energy_column(0), supplied = t.energy_column(1),
               dissipated = t.energy_column(2);
    Ledger l;
    double sum = 0, most = std::abs(stored[0]);
    const auto worse = [](double& worst, double x) {
        if (!(std::abs(x) <= worst)) worst = std::abs(x);  // also where it is no number
    };
    for (long n = 1; n < t.rows; ++n) {
        const double residual = stored[n] - stored[n - 1] - supplied[n] + dissipated[n];
        most = std::max(most, std::abs(stored[n]));
        if (most == 0 && residual == 0) continue;  // before a pluck
        worse(l.row, residual / most);
        worse(l.sum, (sum += residual) / most);
        l.lost += dissipated[n];
        l.least_loss = std::min(l.least_loss, dissipated[n]);
    }
    l.lost /= most;
    return l;
}

}  // namespace jvari
