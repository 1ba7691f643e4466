// Schemes of the tree that do not feel a number of the scene, or feel another: each changes the
// scene before the scheme gets it. Nothing but the answer to that number is wrong, so energies,
// instants and convergence of what they play are sound.
#include <algorithm>
#include <utility>

#include "schemes/making.hpp"
#include "schemes/plugin.hpp"
#include "schemes/registry.hpp"

namespace {
using namespace jvari;

void strings(Scene& scene, auto change) {
    for (String& s : scene.strings) change(s);
}
void lumped(Scene& scene, auto change) {
    strings(scene, [&](String& s) {
        for (Barrier& b : s.barriers)
            if (auto* barrier = std::get_if<LumpedBarrier>(&b)) change(*barrier);
    });
}
void powers(Scene& scene, auto change) {
    lumped(scene, [&](LumpedBarrier& b) {
        if (b.exponent != 1) change(b);
    });
}
bool is_harder(const String& s, double hardness) {
    return std::ranges::any_of(s.barriers, [&](const Barrier& b) {
        const auto* one = std::get_if<LumpedBarrier>(&b);
        return hardness == 0 || (one && one->exponent == 1 && !is_rigid(b) &&
                                 one->stiffness.k * s.length > hardness * s.tension);
    });
}
void second(Scene& scene, auto change) {
    strings(scene, [&](String& s) {
        if (s.barriers.size() > 1) change(std::get<LumpedBarrier>(s.barriers[1]));
    });
}
template <class Kind>
void curves(Scene& scene, auto change) {
    strings(scene, [&](String& s) {
        for (Barrier& b : s.barriers)
            if (auto* profile = std::get_if<ProfileBarrier>(&b))
                if (auto* curve = std::get_if<Kind>(&profile->curve)) change(*profile, *curve);
    });
}
template <class Law>
void laws(Scene& scene, auto change) {
    strings(scene, [&](String& s) {
        if (auto* law = std::get_if<Law>(&s.damping)) change(*law);
    });
}
template <class Part>
void parts(Scene& scene, std::optional<Part> String::*part, auto change) {
    strings(scene, [&](String& s) {
        if (s.*part) change(*(s.*part));
    });
}
template <class Kind>
void starts(Scene& scene, auto change) {
    strings(scene, [&](String& s) {
        if (auto* start = s.start ? std::get_if<Kind>(&*s.start) : nullptr) change(s, *start);
    });
}
void measured(Scene& scene, auto change) {
    parts(scene, &String::pluck, [&](Pluck& p) {
        if (!p.file.empty()) change(p);
    });
}
void masses(Scene& scene, auto change) {
    strings(scene, [&](String& s) {
        for (Mass& m : s.masses) change(m);
    });
}
void body(Scene& scene, auto change) {
    if (scene.body)
        for (BodyMode& m : scene.body->modes) change(m);
}
void swap_barriers(Scene& scene) {
    if (scene.strings.size() > 1) std::swap(scene.strings[0].barriers, scene.strings[1].barriers);
}

using Air = QualityFactorDamping;
using Poly = PolynomialDamping;

struct Deaf {
    const char* name;
    void (*change)(Scene&);
    const char* of = "modal_two_point";
    double nut = 1;          // factor of the force at the nut of a string in contact
    double harder_than = 0;  // k L/T of the bridges in that contact
};

constexpr const char* waveguide = "sitar_waveguide";
constexpr Deaf table_of[] = {
    {"sigma1_up", [](Scene& s) { laws<Poly>(s, [](auto& d) { d.sigma1 *= 1.2; }); }},
    {"sigma3_double", [](Scene& s) { laws<Poly>(s, [](auto& d) { d.sigma3 *= 2; }); }},
    {"contact_loss_half", [](Scene& s) { lumped(s, [](auto& b) { b.contact_loss *= 0.5; }); }},
    {"exponent_up", [](Scene& s) { powers(s, [](auto& b) { b.exponent *= 1.05; }); }},
    {"power_stiffness_up", [](Scene& s) { powers(s, [](auto& b) { b.stiffness.k *= 1.2; }); }},
    {"power_stiffness_triple", [](Scene& s) { powers(s, [](auto& b) { b.stiffness.k *= 3; }); }},
    {"bending_up", [](Scene& s) { strings(s, [](auto& x) { x.bending_stiffness *= 1.01; }); }},
    {"thread_height_ignored",
     [](Scene& s) { parts(s, &String::thread, [](auto& t) { t.height = 0; }); }},
    {"pluck_start_ignored",
     [](Scene& s) { parts(s, &String::pluck, [](auto& p) { p.start = 0; }); }},
    {"velocity_up",
     [](Scene& s) {
         parts(s, &String::velocity,
               [](auto& v) { std::visit([](auto& shape) { shape.amplitude *= 1.02; }, v); });
     }},
    {"second_barrier_lower", [](Scene& s) { second(s, [](auto& b) { b.height *= 1.25; }); }},
    {"second_barrier_softer", [](Scene& s) { second(s, [](auto& b) { b.stiffness.k *= 0.5; }); }},
    {"barriers_swapped", swap_barriers},
    {"diameter_up", [](Scene& s) { laws<Air>(s, [](auto& d) { d.diameter *= 1.2; }); }},
    {"air_viscosity_up", [](Scene& s) { laws<Air>(s, [](auto& d) { d.air_viscosity *= 1.2; }); }},
    {"air_density_up", [](Scene& s) { laws<Air>(s, [](auto& d) { d.air_density *= 1.2; }); }},
    {"viscoelastic_ignored",
     [](Scene& s) { laws<Air>(s, [](auto& d) { d.viscoelastic_angle = 0; }); }},
    {"thermoelastic_ignored",
     [](Scene& s) { laws<Air>(s, [](auto& d) { d.thermoelastic_loss = 0; }); }},
    {"measured_decay_up",
     [](Scene& s) {
         laws<TableDamping>(s, [](auto& d) {
             for (double& x : d.decay_rate) x *= 1.5;
         });
     }},
    {"body_mass_up", [](Scene& s) { body(s, [](auto& m) { m.mass *= 1.1; }); }},
    {"body_damping_double", [](Scene& s) { body(s, [](auto& m) { m.damping *= 2; }); }},
    {"rotation_double",
     [](Scene& s) { parts(s, &String::polarisation, [](auto& p) { p.rotation *= 2; }); },
     waveguide},
    {"rotation_of_the_wrong_sign",
     [](Scene& s) { parts(s, &String::polarisation, [](auto& p) { p.rotation *= -1; }); },
     waveguide},
    {"pluck_angle_of_the_wrong_sign",
     [](Scene& s) { parts(s, &String::polarisation, [](auto& p) { p.pluck_angle *= -1; }); },
     waveguide},
    {"axial_stiffness_up", [](Scene& s) { strings(s, [](auto& x) { x.axial_stiffness *= 1.05; }); },
     "modal_tension"},
    {"start_of_a_file_down",
     [](Scene& s) {
         starts<TableStart>(s, [](String&, auto& t) {
             for (double& y : t.displacement) y *= 0.98;
         });
     }},
    {"velocities_of_a_file_ignored",
     [](Scene& s) {
         starts<TableStart>(s, [](String&, auto& t) { std::ranges::fill(t.velocity, 0.0); });
     }},
    {"measured_force_down", [](Scene& s) { measured(s, [](auto& p) { p.amplitude *= 0.98; }); }},
    {"measured_force_late",
     [](Scene& s) {
         measured(s, [](auto& p) {
             const double late = 0.1 * p.duration;
             for (double& t : p.time) t += late;
             p.start += late;
         });
     }},
    {"clipped_loss_as_hunt_crossley",
     [](Scene& s) { lumped(s, [](auto& b) { b.loss_law = LossLaw::hunt_crossley; }); }},
    {"thread_at_rest_lower",
     [](Scene& s) {
         starts<RestStart>(s, [](String& x, auto&) {
             if (x.thread) x.thread->height = 0;
         });
     }},
    {"second_mass_at_rest",
     [](Scene& s) {
         strings(s, [](String& x) {
             if (x.masses.size() > 1) x.masses[1].velocity = 0;
         });
     }},
    {"mass_up", [](Scene& s) { masses(s, [](auto& m) { m.mass *= 1.1; }); }},
    {"gap_of_a_mass_ignored", [](Scene& s) { masses(s, [](auto& m) { m.gap = 0; }); }},
    {"clipped_loss_of_a_mass_as_hunt_crossley",
     [](Scene& s) { masses(s, [](auto& m) { m.loss_law = LossLaw::hunt_crossley; }); }},
    {"profile_a_millimetre_aside",
     [](Scene& s) {
         strings(s, [](String& x) {
             for (Barrier& b : x.barriers)
                 if (auto* profile = std::get_if<ProfileBarrier>(&b))
                     profile->from += 1e-3, profile->to += 1e-3;
         });
     }},
    {"parabola_of_a_profile_up",
     [](Scene& s) { curves<ParabolaCurve>(s, [](auto&, auto& c) { c.coefficient *= 1.05; }); }},
    {"line_of_a_profile_up",
     [](Scene& s) { curves<LineCurve>(s, [](auto&, auto& c) { c.coefficient *= 1.05; }); }},
    {"density_of_a_profile_up",
     [](Scene& s) { curves<ParabolaCurve>(s, [](auto& b, auto&) { b.stiffness.K *= 1.2; }); }},
    {"bridge_above_2e5_newtons_per_metre_softer",
     [](Scene& s) {
         lumped(s, [](auto& b) {
             if (b.stiffness.k > 2e5 && b.stiffness.k != rigid) b.stiffness.k *= 0.02;
         });
     }},
    {"hard_bridge_softer",
     [](Scene& scene) {
         strings(scene, [](String& s) {
             if (!is_harder(s, 1e3)) return;
             for (Barrier& b : s.barriers)
                 if (auto* one = std::get_if<LumpedBarrier>(&b)) one->stiffness.k *= 0.5;
         });
     }},
    {"nut_up_over_a_hard_bridge", [](Scene&) {}, "modal_two_point", 1.1, 1e5},
    {"nut_up_in_contact", [](Scene&) {}, "modal_two_point", 1.01},
};

class Played : public Scheme {
public:
    Played(const Deaf& deaf, Scene scene, const Settings& settings)
        : deaf_(deaf), scene_(std::move(scene)) {
        deaf.change(scene_);
        inner_ = make_scheme(of_the_tree(deaf), scene_, settings);
    }
    void reset() noexcept override { inner_->reset(); }
    Status advance(const Block& out) noexcept override {
        const Status status = inner_->advance(out);
        for (int k = 0; k < out.taps; ++k) {
            const Tap& tap = scene_.taps[k];
            if (tap.quantity == Quantity::nut_force && tap.string &&
                is_harder(scene_.strings[*tap.string], deaf_.harder_than))
                for (int n = 0; n < out.rows; ++n) out.tap[n + k * out.stride] *= deaf_.nut;
        }
        return status;
    }
    int dofs() const override { return inner_->dofs(); }
    std::vector<Fact> facts() const override { return inner_->facts(); }
    std::vector<FreeMode> free_modes() const override { return inner_->free_modes(); }

    static const Descriptor& of_the_tree(const Deaf& deaf) {
        return *std::ranges::find_if(
            schemes(), [&deaf](const Descriptor& d) { return std::string(d.name) == deaf.of; });
    }

private:
    const Deaf& deaf_;
    Scene scene_;
    std::unique_ptr<Scheme> inner_;
};

constexpr int count = std::size(table_of);

struct Table {
    Descriptor schemes[count];
    Table() {
        for (int i = 0; i < count; ++i) {
            Descriptor& d = schemes[i] = Played::of_the_tree(table_of[i]);
            d.name = table_of[i].name;
            d.own = &table_of[i];
            d.all_strings = true;  // barriers of two strings are swapped here
            d.make = [](const Descriptor& own, const Scene& scene,
                        const Settings& settings) -> std::unique_ptr<Scheme> {
                return std::make_unique<Played>(*static_cast<const Deaf*>(own.own), scene,
                                                settings);
            };
        }
    }
};
const Table all;
}  // namespace

JVARI_PLUGIN(all.schemes)
