// Names, and the features that a scene needs from a scheme. validate.cpp has the rules for valid
// scenes.
#include "scenes/scene.hpp"

#include <algorithm>

#include "scenes/schema.hpp"

namespace jvari {

const char* name_of(Quantity q) { return quantity_names[static_cast<std::size_t>(q)]; }

const char* unit_of(Quantity q) {
    return q == Quantity::displacement ? "m" : q == Quantity::velocity ? "m/s" : "N";
}

const char* lacks(const String& s, Quantity q, std::optional<int> mass) {
    if (mass) return *mass < std::ssize(s.masses) ? nullptr : "that mass";
    const bool barrier = !s.barriers.empty(), thread = s.thread.has_value();
    if (q == Quantity::bridge_force && !barrier) return "a barrier";
    if (q == Quantity::thread_force && !thread) return "a thread";
    if (q == Quantity::driving_force && !barrier && !thread) return "a barrier or a thread";
    return nullptr;
}

bool hears(const Tap& tap, const Scene& scene, int string) {
    return tap.string ? *tap.string == string
                      : !lacks(scene.strings[string], tap.quantity, tap.mass);
}

Scene alone(const Scene& scene, int string) {
    Scene one = scene;
    one.strings = {scene.strings[string]};
    one.taps.clear();
    for (Tap tap : scene.taps) {
        if (!hears(tap, scene, string)) continue;
        if (tap.string) tap.string = 0;
        one.taps.push_back(std::move(tap));
    }
    return one;
}

Scene unfiltered(Scene scene) {
    if (!scene.body) return scene;
    scene.body = Body{"", "", std::move(scene.body->modes)};
    if (scene.body->modes.empty()) scene.body.reset();
    return scene;
}

const char* name_of(Feature f) {
    switch (f) {
        case Feature::bending_stiffness: return "bending stiffness";
        case Feature::damping: return "damping";
        case Feature::frequency_dependent_damping: return "frequency-dependent damping";
        case Feature::measured_modes: return "measured modes";
        case Feature::lumped_barrier: return "lumped barrier";
        case Feature::profile_barrier: return "profile barrier";
        case Feature::several_barriers: return "several barriers";
        case Feature::power_law_contact: return "contact exponent other than 1";
        case Feature::contact_loss: return "contact loss";
        case Feature::thread: return "thread";
        case Feature::initial_shape: return "initial shape";
        case Feature::pluck: return "pluck";
        case Feature::polarisation: return "two polarisations";
        case Feature::moving_body: return "moving body";
        case Feature::rigid_barrier: return "rigid barrier";
        case Feature::rigid_profile: return "rigid profile";
        case Feature::tension_modulation: return "tension modulation";
        case Feature::initial_velocity: return "initial velocity";
        case Feature::equilibrium: return "static equilibrium";
        case Feature::clipped_loss: return "contact loss that does not pull";
        case Feature::free_mass: return "free mass";
        case Feature::joined_mass: return "mass on a spring or damper";
        case Feature::weighed_mass: return "mass with a weight";
        case Feature::barrier_above: return "barrier above the string";
    }
    return "?";
}

std::string names_of(Features features) {
    std::string text;
    for (int i = 0; i < feature_count; ++i) {
        const auto f = static_cast<Feature>(1u << i);
        if (features.has(f)) text += (text.empty() ? "" : ", ") + std::string(name_of(f));
    }
    return text;
}

bool is_rigid(const Barrier& barrier) {
    const auto* lumped = std::get_if<LumpedBarrier>(&barrier);
    return (lumped ? lumped->stiffness.k : std::get<ProfileBarrier>(barrier).stiffness.K) == rigid;
}

namespace {
struct DampingNeeds {
    Features operator()(const NoDamping&) const { return {}; }
    Features operator()(const PolynomialDamping& d) const {
        if (d.sigma1 != 0 || d.sigma3 != 0)
            return Feature::damping | Feature::frequency_dependent_damping;
        return d.sigma0 != 0 ? Features(Feature::damping) : Features();
    }
    Features operator()(const QualityFactorDamping&) const {
        return Feature::damping | Feature::frequency_dependent_damping;
    }
    Features operator()(const TableDamping&) const {
        return Feature::damping | Feature::frequency_dependent_damping | Feature::measured_modes;
    }
    Features operator()(const PerPeriodDamping& d) const {
        return d.factor != 1 ? Features(Feature::damping) : Features();
    }
};

Features needed_by_law(const auto& b) {
    Features f;
    if (b.exponent != 1) f = f | Feature::power_law_contact;
    if (b.contact_loss == 0) return f;
    f = f | Feature::contact_loss;
    return b.loss_law == LossLaw::clipped ? f | Feature::clipped_loss : f;
}

Features needed_by(const Barrier& barrier) {
    const bool lumped = std::holds_alternative<LumpedBarrier>(barrier);
    if (is_rigid(barrier))
        return lumped ? Feature::lumped_barrier | Feature::rigid_barrier
                      : Features(Feature::rigid_profile);
    return (lumped ? Feature::lumped_barrier : Feature::profile_barrier) |
           std::visit([](const auto& b) { return needed_by_law(b); }, barrier);
}

Features needed_by(const Mass& m) {
    Features f = Feature::free_mass | needed_by_law(m);
    if (m.joined()) f = f | Feature::joined_mass;
    return m.weight > 0 ? f | Feature::weighed_mass : f;
}

bool stands_above(const Barrier& barrier) {
    const auto* b = std::get_if<LumpedBarrier>(&barrier);
    return b && b->side == Side::above;
}

Features needed_by(const Start& start) {
    const auto* table = std::get_if<TableStart>(&start);
    const bool moves = table && std::any_of(table->velocity.begin(), table->velocity.end(),
                                            [](double v) { return v != 0; });
    return std::holds_alternative<RestStart>(start) ? Features(Feature::equilibrium)
           : moves ? Feature::initial_shape | Feature::initial_velocity
                   : Features(Feature::initial_shape);
}
}  // namespace

Features needed_by(const Scene& scene) {
    Features f;
    for (const String& s : scene.strings) {
        if (s.bending_stiffness != 0) f = f | Feature::bending_stiffness;
        if (s.axial_stiffness != 0) f = f | Feature::tension_modulation;
        f = f | std::visit(DampingNeeds{}, s.damping);
        for (const Barrier& b : s.barriers) f = f | needed_by(b);
        for (const Mass& m : s.masses) f = f | needed_by(m);
        if (std::any_of(s.barriers.begin(), s.barriers.end(), stands_above))
            f = f | Feature::barrier_above;
        if (s.barriers.size() + s.masses.size() > 1) f = f | Feature::several_barriers;
        if (s.thread) f = f | Feature::thread;
        if (s.start) f = f | needed_by(*s.start);
        if (s.velocity) f = f | Feature::initial_velocity;
        if (s.pluck) f = f | Feature::pluck;
        if (s.polarisation) f = f | Feature::polarisation;
    }
    if (scene.body && !scene.body->modes.empty()) f = f | Feature::moving_body;
    return f;
}

BadScene::BadScene(std::string k, std::string f, std::string e)
    : std::runtime_error(k + ": found " + f + ", expected " + e),
      key(std::move(k)),
      found(std::move(f)),
      expected(std::move(e)) {}

}  // namespace jvari
