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

void each_string(Scene& scene, auto change) {
    for (String& s : scene.strings) change(s);
}
void each_lumped(Scene& scene, auto change) {
    each_string(scene, [&](String& s) {
        for (Barrier& b : s.barriers)
            if (auto* lumped = std::get_if<LumpedBarrier>(&b)) change(*lumped);
    });
}
template <class Law>
void each_law(Scene& scene, auto change) {
    each_string(scene, [&](String& s) {
        if (auto* law = std::get_if<Law>(&s.damping)) change(*law);
    });
}
void second_barrier(Scene& scene, auto change) {
    each_string(scene, [&](String& s) {
        if (s.barriers.size() > 1) change(std::get<LumpedBarrier>(s.barriers[1]));
    });
}

struct Deaf {
    const char *name, *of;
    void (*change)(Scene&);
    double nut = 1;  // factor of the force at the nut of a string in contact
};

constexpr Deaf table_of[] = {
    {"sigma1_up", "modal_two_point",
     [](Scene& s) { each_law<PolynomialDamping>(s, [](auto& d) { d.sigma1 *= 1.2; }); }},
    {"sigma3_double", "modal_two_point",
     [](Scene& s) { each_law<PolynomialDamping>(s, [](auto& d) { d.sigma3 *= 2; }); }},
    {"contact_loss_half", "modal_two_point",
     [](Scene& s) { each_lumped(s, [](auto& b) { b.contact_loss *= 0.5; }); }},
    {"exponent_up", "modal_two_point",
     [](Scene& s) {
         each_lumped(s, [](auto& b) { b.exponent = b.exponent == 1 ? 1 : 1.05 * b.exponent; });
     }},
    {"power_stiffness_up", "modal_two_point",
     [](Scene& s) { each_lumped(s, [](auto& b) { b.stiffness.k *= b.exponent == 1 ? 1 : 1.2; }); }},
    {"power_stiffness_triple", "modal_two_point",
     [](Scene& s) { each_lumped(s, [](auto& b) { b.stiffness.k *= b.exponent == 1 ? 1 : 3; }); }},
    {"bending_up", "modal_two_point",
     [](Scene& s) { each_string(s, [](String& x) { x.bending_stiffness *= 1.01; }); }},
    {"thread_height_ignored", "modal_two_point",
     [](Scene& s) {
         each_string(s, [](String& x) {
             if (x.thread) x.thread->height = 0;
         });
     }},
    {"pluck_start_ignored", "modal_two_point",
     [](Scene& s) {
         each_string(s, [](String& x) {
             if (x.pluck) x.pluck->start = 0;
         });
     }},
    {"second_barrier_lower", "modal_two_point",
     [](Scene& s) { second_barrier(s, [](auto& b) { b.height -= 1e-4; }); }},
    {"second_barrier_softer", "modal_two_point",
     [](Scene& s) { second_barrier(s, [](auto& b) { b.stiffness.k *= 0.5; }); }},
    {"barriers_swapped", "modal_two_point",
     [](Scene& s) {
         if (s.strings.size() > 1) std::swap(s.strings[0].barriers, s.strings[1].barriers);
     }},
    {"diameter_up", "modal_two_point",
     [](Scene& s) { each_law<QualityFactorDamping>(s, [](auto& d) { d.diameter *= 1.2; }); }},
    {"air_viscosity_up", "modal_two_point",
     [](Scene& s) { each_law<QualityFactorDamping>(s, [](auto& d) { d.air_viscosity *= 1.2; }); }},
    {"air_density_up", "modal_two_point",
     [](Scene& s) { each_law<QualityFactorDamping>(s, [](auto& d) { d.air_density *= 1.2; }); }},
    {"viscoelastic_ignored", "modal_two_point",
     [](Scene& s) {
         each_law<QualityFactorDamping>(s, [](auto& d) { d.viscoelastic_angle = 0; });
     }},
    {"thermoelastic_ignored", "modal_two_point",
     [](Scene& s) {
         each_law<QualityFactorDamping>(s, [](auto& d) { d.thermoelastic_loss = 0; });
     }},
    {"measured_decay_up", "modal_two_point",
     [](Scene& s) {
         each_law<TableDamping>(s, [](auto& d) {
             for (double& x : d.decay_rate) x *= 1.5;
         });
     }},
    {"body_mass_up", "modal_two_point",
     [](Scene& s) {
         if (s.body)
             for (BodyMode& m : s.body->modes) m.mass *= 1.1;
     }},
    {"body_damping_double", "modal_two_point",
     [](Scene& s) {
         if (s.body)
             for (BodyMode& m : s.body->modes) m.damping *= 2;
     }},
    {"rotation_double", "sitar_waveguide",
     [](Scene& s) {
         each_string(s, [](String& x) {
             if (x.polarisation) x.polarisation->rotation *= 2;
         });
     }},
    {"rotation_of_the_wrong_sign", "sitar_waveguide",
     [](Scene& s) {
         each_string(s, [](String& x) {
             if (x.polarisation) x.polarisation->rotation *= -1;
         });
     }},
    {"pluck_angle_of_the_wrong_sign", "sitar_waveguide",
     [](Scene& s) {
         each_string(s, [](String& x) {
             if (x.polarisation) x.polarisation->pluck_angle *= -1;
         });
     }},
    {"axial_stiffness_up", "modal_tension",
     [](Scene& s) { each_string(s, [](String& x) { x.axial_stiffness *= 1.05; }); }},
    {"nut_up_in_contact", "modal_two_point", [](Scene&) {}, 1.01},
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
                !scene_.strings[*tap.string].barriers.empty())
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
