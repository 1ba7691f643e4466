#include "bench/check/promise.hpp"

#include "scenes/scene_file.hpp"
#include "scenes/start.hpp"

namespace jvari::bench::check {

namespace {
// Shortens scenes to the time until the string touches everything in reach.
std::vector<Scene> shortened(std::vector<Scene> scenes) {
    for (Scene& s : scenes) {
        const bool late = s.name == "guitar_over_fret" || s.name == "prepared_piano";
        s.duration = static_cast<double>(late ? 240 : contract_rows) / contract_tap_rate;
    }
    return scenes;
}

Scene named(Scene scene, const char* name) {
    scene.name = name;
    return scene;
}

Scene lossless(Scene scene) {
    for (String& s : scene.strings) {
        s.damping = NoDamping{};
        if (s.thread) s.thread->damping = 0;
    }
    return scene;
}

Scene least(bool plucked) {  // string without stiffness and losses
    Scene scene = named(lossless(string_at_rest()), "string");
    String& s = scene.strings.front();
    s.bending_stiffness = 0;
    if (plucked) s.pluck = Pluck{-0.4, 2e-3, 30.0, 0.0, 0.5, 0.1};
    else s.start = ModeShape{1, 1.9e-3};
    return scene;
}

Scene released() {  // first mode, released over bridge and thread
    return read_scene("tanpura_c3_release");
}

// Point bridge on a grid node; the grid has as many nodes between the ends as there are modes.
LumpedBarrier bridge_at(const String& s, int node) {
    return {node * s.length / (contract_modes + 1), 0, 0, {4.39e8}, 1, 0};
}

LumpedBarrier soft_bridge(const String& s, int node, double height = 0) {
    LumpedBarrier b = bridge_at(s, node);
    b.stiffness.k = 1e4;
    b.height = height;
    return b;
}

// Adds a missing feature. The scene is returned unchanged if it has the feature, or cannot have it.
Scene with(Feature feature, Scene scene) {
    String& s = scene.strings.front();
    const auto on_its_barriers = [&s](auto change) {
        if (s.barriers.empty()) s.barriers = {bridge_at(s, 1)};
        for (Barrier& b : s.barriers) std::visit(change, b);
    };
    switch (feature) {
        case Feature::bending_stiffness:
            s.bending_stiffness = 1e-6 * s.tension * s.length * s.length;
            break;
        case Feature::damping: s.damping = PolynomialDamping{0.6, 0, 0}; break;
        case Feature::frequency_dependent_damping:
            s.damping = PolynomialDamping{0.6, 6.5e-3, 5.0e-6};
            break;
        case Feature::measured_modes: {
            TableDamping table;
            for (int i = 1; i <= contract_modes; ++i)
                table.frequency_hz.push_back(131.3 * i), table.decay_rate.push_back(0.6);
            s.damping = table;
            break;
        }
        case Feature::lumped_barrier: s.barriers.emplace_back(bridge_at(s, 1)); break;
        case Feature::profile_barrier:
            s.barriers.emplace_back(ProfileBarrier{FlatCurve{}, 0, 0.2 * s.length, {1e9}, 1, 0});
            break;
        // Soft bridges: a force computed before the step explodes on a stiff bridge before the
        // other acts.
        case Feature::several_barriers: s.barriers = {soft_bridge(s, 1), soft_bridge(s, 3)}; break;
        case Feature::power_law_contact: on_its_barriers([](auto& b) { b.exponent = 1.5; }); break;
        case Feature::contact_loss: on_its_barriers([](auto& b) { b.contact_loss = 0.5; }); break;
        case Feature::clipped_loss:  // pulls if the string leaves at more than 0.02 m/s
            if (s.barriers.empty()) s.barriers = {soft_bridge(s, 3)};
            on_its_barriers([](auto& b) {
                b.contact_loss = 50;
                b.loss_law = LossLaw::clipped;
            });
            break;
        case Feature::thread:
            s.thread = Thread{5e-3 * s.length, 1.2e-3 * s.length, 1.2e5, 0, 0};
            break;
        case Feature::polarisation: s.polarisation = Polarisation{0.1, 0.3}; break;
        case Feature::initial_shape: s.start = ModeShape{1, 1.9e-3 * s.length}; break;
        case Feature::pluck:
            s.pluck = Pluck{-0.4, 2e-3, 30.0, 0.0, 0.5 * s.length, 0.1 * s.length};
            break;
        case Feature::rigid_barrier:
            s.barriers = {bridge_at(s, 1)},
            std::get<LumpedBarrier>(s.barriers[0]).stiffness.k = rigid;
            break;
        case Feature::rigid_profile:
            s.barriers.emplace_back(ProfileBarrier{FlatCurve{}, 0, 0.2 * s.length, {rigid}, 1, 0});
            break;
        case Feature::tension_modulation: s.axial_stiffness = 5e3; break;
        case Feature::initial_velocity: s.velocity = ModeShape{1, s.length}; break;
        case Feature::equilibrium:  // rests on a bridge that lifts the string
            if (needed_by(scene).any(Feature::moving_body | Feature::tension_modulation)) break;
            s.start = RestStart{};
            s.barriers = {soft_bridge(s, 3, 1e-3 * s.length)};
            break;
        case Feature::free_mass:  // strikes the string at once
            if (needed_by(scene).any(Feature::moving_body | Feature::tension_modulation)) break;
            s.masses = {{2e-3, 6 * s.length / (contract_modes + 1), 0, 2 * s.length, 0, 1e4, 1, 0}};
            break;
        case Feature::joined_mass:
        case Feature::weighed_mass:
            scene = with(Feature::free_mass, scene);
            for (Mass& m : scene.strings.back().masses)
                if (feature == Feature::joined_mass) m.spring = 2e3, m.damping = 0.5;
                else m.weight = 0.2;
            break;
        case Feature::barrier_above: {  // one of two jaws
            if (needed_by(scene).any(Feature::moving_body | Feature::tension_modulation)) break;
            LumpedBarrier jaw = soft_bridge(s, 3);
            jaw.height = 1e-5 * s.length, jaw.side = Side::above;
            s.barriers = {jaw};
            break;
        }
        case Feature::moving_body:
            scene.body = Body{"", "", {{0.02, 2.5e4, 0.5}, {0.05, 2e5, 2}}};
            break;
    }
    return scene;
}

// Changes the frequency-dependent part of the losses; false if there is nothing to change.
bool with_other_losses_of_high_modes(String& s) {
    if (auto* p = std::get_if<PolynomialDamping>(&s.damping))
        return p->sigma1 = p->sigma3 = 0, true;
    if (auto* q = std::get_if<QualityFactorDamping>(&s.damping))
        return q->viscoelastic_angle *= 2, true;
    if (auto* t = std::get_if<TableDamping>(&s.damping)) return t->decay_rate.back() *= 2, true;
    return false;
}

bool with_other_frequencies(String& s) {
    auto* t = std::get_if<TableDamping>(&s.damping);
    if (!t) return false;
    for (double& f : t->frequency_hz) f *= 1.01;
    return true;
}

template <class Kind>
bool rid_of(String& s) {
    return std::erase_if(s.barriers,
                         [](const Barrier& b) { return std::holds_alternative<Kind>(b); }) > 0;
}
}  // namespace

Scene string_at_rest() {
    Scene scene = released();
    String& s = scene.strings.front();
    s.barriers.clear();
    s.thread.reset();
    s.start.reset();
    scene.taps.resize(2);
    return scene;
}

namespace {
std::vector<Scene> read_contract_scenes() {
    std::vector<Scene> scenes;
    for (const std::string& name : library_scenes()) scenes.push_back(read_scene(name));
    scenes.push_back(named(string_at_rest(), "rest"));
    scenes.push_back(named(string_at_rest(), "plucked_from_rest"));
    scenes.back().strings.front().start = RestStart{};
    scenes.back().strings.front().pluck = Pluck{-0.4, 2e-3, 30.0, 0.0, 0.5, 0.1};
    scenes.push_back(named(lossless(released()), "lossless_release"));
    scenes.push_back(named(lossless(string_at_rest()), "lossless_free"));
    scenes.back().strings.front().start = ModeShape{2, 1e-3};
    scenes.push_back(named(with(Feature::rigid_barrier, released()), "rigid_release"));
    scenes.push_back(
        named(read_scene("flat_bridge_ideal", {"string.0.barrier.0.stiffness_density=rigid"}),
              "rigid_wall"));
    scenes.push_back(named(with(Feature::free_mass, string_at_rest()), "hammered"));
    Mass& hammer = scenes.back().strings.front().masses.front();
    hammer.gap = 1e-4, hammer.stiffness = 1e9, hammer.exponent = 2.3;
    for (const auto& [name, quantity] : {std::pair{"z", Quantity::displacement},
                                         {"v", Quantity::velocity},
                                         {"F", Quantity::bridge_force}})
        scenes.back().taps.push_back({name, quantity, 0, 0, 0});
    scenes.push_back(named(released(), "pluck_that_starts_and_ends_between_rows"));
    scenes.back().strings.front().start.reset();
    scenes.back().strings.front().pluck = Pluck{-0.4, 2.003e-3, 30.0, 1.01e-3, 0.5, 1.0};
    return shortened(scenes);
}
}  // namespace

const std::vector<Scene>& contract_scenes() {
    static const std::vector<Scene> scenes = read_contract_scenes();
    return scenes;
}

std::vector<Scene> scenes_with(Feature feature) {
    std::vector<Scene> scenes;
    for (const bool plucked : {false, true}) scenes.push_back(with(feature, least(plucked)));
    for (const Scene& s : contract_scenes()) {
        scenes.push_back(s);
        if (!needed_by(s).has(feature)) scenes.push_back(with(feature, s));
    }
    std::erase_if(scenes, [feature](const Scene& s) { return !needed_by(s).has(feature); });
    for (Scene& s : scenes) {
        s.taps.clear();  // taps also serve strings without the feature
        for (const double x : {0.3, 0.4375})
            s.taps.push_back({"y" + std::to_string(s.taps.size()), Quantity::displacement,
                              static_cast<int>(s.strings.size()) - 1, x * s.strings.back().length});
    }
    return shortened(scenes);
}

std::vector<Scene> otherwise(const Scene& scene, Feature feature) {
    std::vector<Scene> all;
    // Applies `change` to the last string; `change` returns false if there is nothing to change.
    const auto add = [&](auto change) {
        Scene other = scene;
        if (change(other.strings.back())) all.push_back(std::move(other));
    };
    const auto each_barrier = [&add](auto change) {
        add([change](String& s) {
            for (Barrier& b : s.barriers) std::visit(change, b);
            return !s.barriers.empty();
        });
    };
    switch (feature) {
        case Feature::bending_stiffness:
            add([](String& s) { return s.bending_stiffness *= 2, true; });
            break;
        case Feature::damping: add([](String& s) { return s.damping = NoDamping{}, true; }); break;
        case Feature::frequency_dependent_damping: add(with_other_losses_of_high_modes); break;
        case Feature::measured_modes: add(with_other_frequencies); break;
        case Feature::lumped_barrier: add(rid_of<LumpedBarrier>); break;
        case Feature::profile_barrier: add(rid_of<ProfileBarrier>); break;
        case Feature::rigid_profile:
            each_barrier([](auto& b) {
                if constexpr (requires { b.to; }) b.to = 0.5 * (b.from + b.to);
            });
            break;
        case Feature::several_barriers:
            for (const bool first : {false, true})
                add([first](String& s) {
                    return s.barriers.size() > 1 &&
                           (s.barriers.erase(first ? s.barriers.begin() : s.barriers.end() - 1),
                            true);
                });
            break;
        case Feature::power_law_contact: each_barrier([](auto& b) { b.exponent += 0.25; }); break;
        case Feature::contact_loss: each_barrier([](auto& b) { b.contact_loss *= 2; }); break;
        case Feature::clipped_loss:
            each_barrier([](auto& b) { b.loss_law = LossLaw::hunt_crossley; });
            break;
        case Feature::thread:
            add([](String& s) { return s.thread && (s.thread->stiffness *= 0.5, true); });
            break;
        case Feature::initial_shape:
            add([](String& s) {
                return largest_displacement(s) != 0 && (s = scaled(s, 1.1), true);
            });
            break;
        case Feature::initial_velocity:
            add([](String& s) { return s.velocity.reset(), true; });
            break;
        case Feature::equilibrium:  // a string that touches nothing rests in its zero start
            add([](String& s) {
                if (s.barriers.empty()) s.start = ModeShape{1, 1e-3 * s.length};
                else s.start.reset();
                return true;
            });
            break;
        case Feature::pluck:
            add([](String& s) { return s.pluck && (s.pluck->amplitude *= 1.1, true); });
            break;
        case Feature::polarisation:
            add([](String& s) {
                return s.polarisation &&
                       (s.polarisation->rotation += 0.2, s.polarisation->pluck_angle += 0.2, true);
            });
            break;
        case Feature::rigid_barrier: each_barrier([](auto& b) { b.stiffness = {1e5}; }); break;
        case Feature::tension_modulation:
            add([](String& s) { return s.axial_stiffness *= 3, true; });
            break;
        case Feature::free_mass:
            for (double Mass::*member : {&Mass::mass, &Mass::velocity})
                add([member](String& s) { return s.masses[0].*member *= 2, true; });
            break;
        case Feature::joined_mass:
            for (double Mass::*member : {&Mass::spring, &Mass::damping})
                add([member](String& s) { return s.masses[0].*member *= 4, true; });
            break;
        case Feature::weighed_mass:
            add([](String& s) { return s.masses[0].weight *= 4, true; });
            break;
        case Feature::barrier_above:
            each_barrier([](auto& b) {
                if constexpr (requires { b.side; }) b.side = Side::below;
            });
            break;
        case Feature::moving_body:
            all.push_back(scene);
            for (BodyMode& m : all.back().body->modes) m.stiffness *= 2;
            break;
    }
    return all;
}

}  // namespace jvari::bench::check
