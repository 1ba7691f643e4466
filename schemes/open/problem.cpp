// Source: van Walstijn et al. 2016, eqs 5-8 and 14-22; the compliances come from
// contact/compliance.hpp.
#include "schemes/open/problem.hpp"

#include <algorithm>
#include <cmath>

#include "scenes/excitation.hpp"
#include "scenes/modes.hpp"
#include "scenes/scene_file.hpp"
#include "scenes/start.hpp"
#include "schemes/contact/compliance.hpp"
#include "schemes/making.hpp"
#include "schemes/run.hpp"

namespace jvari {

namespace {
std::vector<double> pluck_samples(const Pluck& pluck, const jvari_problem& p) {
    const double steps = static_cast<double>((p.rows - 1) * p.steps_per_row) + 1;
    const double last =
        std::min(std::ceil((pluck.start + pluck.duration) * p.sample_rate) + 1, steps);
    std::vector<double> samples;
    for (double n = 0; n < last; ++n)
        samples.push_back(mean_about(pluck, n / p.sample_rate, 1 / p.sample_rate));
    return samples;
}

template <class Value>
std::vector<double> of_contacts(const String& s, Value value) {
    std::vector<double> all;
    for (const Barrier& b : s.barriers) all.push_back(value(std::get<LumpedBarrier>(b)));
    return all;
}

std::vector<double> weights_of(const Tap& tap, const Modes& modes, const String& s) {
    switch (tap.quantity) {
        case Quantity::displacement:
        case Quantity::velocity: return displacement_weights(modes, tap.position);
        case Quantity::nut_force: return nut_force_weights(modes, s);
        default: return std::vector<double>(static_cast<std::size_t>(modes.count()));
    }
}

void append(std::vector<double>& to, const std::vector<double>& more) {
    to.insert(to.end(), more.begin(), more.end());
}
}  // namespace

const double* Problem::keep(std::vector<double> v) {
    return numbers_.emplace_back(std::move(v)).data();
}
const char* const* Problem::keep(const std::vector<std::string>& words) {
    auto& list = lists_.emplace_back();
    for (const std::string& word : words) list.push_back(texts_.emplace_back(word).c_str());
    return list.data();
}

void Problem::put_contacts(const String& s, const Modes& modes) {
    std::vector<double> weights;
    for (const Footprint& f : footprints_of(s))
        append(weights, footprint_weights(modes, f.position, f.width));
    p_.contact_weights = keep(weights);
    p_.contact_position = keep(of_contacts(s, [](const LumpedBarrier& b) { return b.position; }));
    p_.contact_width = keep(of_contacts(s, [](const LumpedBarrier& b) { return b.width; }));
    p_.contact_stiffness =
        keep(of_contacts(s, [](const LumpedBarrier& b) { return b.stiffness.k; }));
    p_.contact_exponent = keep(of_contacts(s, [](const LumpedBarrier& b) { return b.exponent; }));
    p_.contact_height = keep(of_contacts(s, [](const LumpedBarrier& b) { return b.height; }));
    p_.contact_loss = keep(of_contacts(s, [](const LumpedBarrier& b) { return b.contact_loss; }));
}

void Problem::put_thread(const Thread& thread, const Modes& modes) {
    p_.threads = 1;
    p_.thread_position = thread.position, p_.thread_width = thread.width;
    p_.thread_weights = keep(footprint_weights(modes, thread.position, thread.width));
    p_.thread_stiffness = thread.stiffness, p_.thread_damping = thread.damping,
    p_.thread_height = thread.height;
}

void Problem::put_pluck(const Pluck& pluck, const Modes& modes) {
    p_.plucks = 1;
    p_.pluck_position = pluck.position, p_.pluck_width = pluck.width;
    p_.pluck_weights = keep(footprint_weights(modes, pluck.position, pluck.width));
    std::vector<double> samples = pluck_samples(pluck, p_);
    p_.pluck_samples = static_cast<std::int64_t>(samples.size());
    p_.pluck_force = keep(std::move(samples));
}

void Problem::put_options(const OptionValues& options) {
    std::vector<std::string> names, values;
    for (const auto& [name, value] : options) names.push_back(name), values.push_back(value);
    p_.options = static_cast<std::int64_t>(names.size());
    p_.option_names = keep(names), p_.option_values = keep(values);
}

Problem::Problem(const Scene& scene, const Settings& settings) {
    const String s = with_profile_points(scene.strings.front(), settings);
    const Modes modes = modes_of(s, settings);
    p_.size = sizeof p_;
    p_.name = texts_.emplace_back(scene.name).c_str();
    p_.scene = texts_.emplace_back(write_scene(scene)).c_str();
    p_.sample_rate = settings.sample_rate, p_.tap_rate = settings.tap_rate,
    p_.duration = scene.duration;
    p_.rows = rows_of(scene, settings), p_.steps_per_row = steps_per_row(settings);
    p_.modes = modes.count(), p_.modes_asked = settings.modes;
    p_.contacts = static_cast<std::int64_t>(s.barriers.size()),
    p_.taps = static_cast<std::int64_t>(scene.taps.size());
    p_.length = s.length, p_.linear_density = s.linear_density, p_.tension = s.tension,
    p_.bending_stiffness = s.bending_stiffness;
    p_.modal_mass = modes.mass;
    p_.beta = keep(modes.beta), p_.omega0 = keep(modes.omega0), p_.sigma = keep(modes.sigma);
    p_.start = keep(start_of(modes, s).displacement);

    std::vector<Footprint> points = footprints_of(s);
    put_contacts(s, modes);
    p_.thread_weights = p_.pluck_weights = p_.pluck_force = keep(std::vector<double>{});
    if (s.thread) {
        put_thread(*s.thread, modes);
        points.push_back({s.thread->position, s.thread->width});
    }
    if (s.pluck) put_pluck(*s.pluck, modes);

    if (const auto* table = std::get_if<TableDamping>(&s.damping)) {
        p_.measured = static_cast<std::int64_t>(table->frequency_hz.size());
        p_.measured_hz = keep(table->frequency_hz), p_.measured_decay = keep(table->decay_rate);
    }

    std::vector<std::string> names, quantities;
    std::vector<double> positions, tap_weights, compliance, tap_compliance, radiation;
    for (const Footprint& at : points) {
        for (const Footprint& pushed : points)
            compliance.push_back(static_deflection(s, at, pushed));
        radiation.push_back(radiation_resistance(s, at, modes.count()));
    }
    for (const Tap& tap : scene.taps) {
        names.push_back(tap.name), quantities.emplace_back(name_of(tap.quantity)),
            positions.push_back(tap.position);
        append(tap_weights, weights_of(tap, modes, s));
        for (const Footprint& pushed : points)
            tap_compliance.push_back(tap.quantity == Quantity::displacement
                                         ? static_deflection(s, {tap.position, 0}, pushed)
                                     : tap.quantity == Quantity::nut_force
                                         ? static_nut_force(s, pushed)
                                         : 0);
    }
    p_.tap_names = keep(names), p_.tap_quantities = keep(quantities),
    p_.tap_position = keep(positions);
    p_.tap_weights = keep(tap_weights);
    p_.compliance = keep(compliance), p_.tap_compliance = keep(tap_compliance),
    p_.radiation = keep(radiation);
    put_options(settings.options);
}

void refuse_beyond_arrays(const Scene& scene) {
    const Features needed = needed_by(scene);
    const char* beyond = scene.strings.size() != 1               ? "several strings"
                         : needed.has(Feature::moving_body)      ? "a moving body"
                         : needed.has(Feature::polarisation)     ? "two polarisations"
                         : needed.any(any_rigid)                 ? "a rigid barrier"
                         : needed.has(Feature::initial_velocity) ? "a velocity at the start"
                         : needed.has(Feature::free_mass)        ? "a free mass"
                         : needed.has(Feature::barrier_above)    ? "a barrier above the string"
                         : needed.has(Feature::clipped_loss) ? "a contact loss that does not pull"
                         : needed.has(Feature::tension_modulation)
                             ? "a tension that grows as the string stretches"
                             : nullptr;
    if (beyond)
        throw Refusal("scene " + scene.name + " has " + beyond +
                      ": the problem as arrays is of one string that moves in one plane between "
                      "ends at rest, over barriers that give way");
}

}  // namespace jvari
