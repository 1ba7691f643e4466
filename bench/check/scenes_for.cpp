// Adapts a scene to a scheme: unrepresented features are removed, and tables become files.
#include <fmt/core.h>

#include <algorithm>

#include "bench/check/promise.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/records.hpp"
#include "scenes/schema.hpp"
#include "schemes/contact/compliance.hpp"

namespace jvari::bench::check {

bool has_points_for_a_profile(const Descriptor& d) {
    const auto by_points = [](const Approximation& a) {
        return a.feature != Feature::profile_barrier ||
               a.fact.name == std::string(facts::contact_points.name);
    };
    return declares(d, profile_points_option.name) &&
           approximated(d).has(Feature::profile_barrier) &&
           std::ranges::all_of(d.approximates, by_points);
}

Scene as_far_as(const Descriptor& d, Scene scene) {
    Features f = d.represents - approximated(d);
    if (has_points_for_a_profile(d)) f = f | Feature::profile_barrier;
    for (String& s : scene.strings) {
        if (!f.has(Feature::bending_stiffness)) s.bending_stiffness = 0;
        if (!f.has(Feature::tension_modulation)) s.axial_stiffness = 0;
        if (!f.has(Feature::damping)) s.damping = NoDamping{};
        if (auto* p = std::get_if<PolynomialDamping>(&s.damping);
            p && !f.has(Feature::frequency_dependent_damping))
            p->sigma1 = p->sigma3 = 0;
        if (!f.has(Feature::thread)) s.thread.reset();
        const bool rests = s.start && std::holds_alternative<RestStart>(*s.start);
        if (!f.has(rests ? Feature::equilibrium : Feature::initial_shape)) s.start.reset();
        if (!f.has(Feature::initial_velocity)) s.velocity.reset();
        if (auto* t = s.start ? std::get_if<TableStart>(&*s.start) : nullptr;
            t && !f.has(Feature::initial_velocity))
            std::ranges::fill(t->velocity, 0.0);
        if (!f.has(Feature::pluck)) s.pluck.reset();
        if (!f.has(Feature::free_mass)) s.masses.clear();
        for (Mass& m : s.masses) {
            if (!f.has(Feature::joined_mass)) m.spring = m.damping = 0;
            if (!f.has(Feature::weighed_mass)) m.weight = 0;
        }
        if (!f.has(Feature::barrier_above))
            std::erase_if(s.barriers, [](const Barrier& b) {
                const auto* lumped = std::get_if<LumpedBarrier>(&b);
                return lumped && lumped->side == Side::above;
            });
        if (!f.has(Feature::polarisation)) s.polarisation.reset();
        std::erase_if(s.barriers, [f](const Barrier& b) {
            return !f.has(std::holds_alternative<LumpedBarrier>(b) ? Feature::lumped_barrier
                          : is_rigid(b)                            ? Feature::rigid_profile
                                                                   : Feature::profile_barrier) ||
                   (is_rigid(b) && std::holds_alternative<LumpedBarrier>(b) &&
                    !f.has(Feature::rigid_barrier));
        });
        if (!f.has(Feature::several_barriers) && s.barriers.size() > 1) s.barriers.resize(1);
        if (!f.has(Feature::several_barriers) && s.masses.size() > 1) s.masses.resize(1);
        for (Barrier& b : s.barriers)
            std::visit(
                [f](auto& one) {
                    if (!f.has(Feature::power_law_contact)) one.exponent = 1;
                    if (!f.has(Feature::contact_loss)) one.contact_loss = 0;
                    if (!f.has(Feature::clipped_loss)) one.loss_law = LossLaw::hunt_crossley;
                },
                b);
    }
    if (!f.has(Feature::moving_body)) scene.body.reset();
    std::erase_if(scene.taps, [&scene](const Tap& t) {
        return lacks(scene.strings[*t.string], t.quantity, t.mass) != nullptr;
    });
    return scene;
}

namespace {
struct IntoFiles : Pass<IntoFiles> {
    const std::filesystem::path& folder;
    int tables = 0;
    explicit IntoFiles(const std::filesystem::path& in) : folder(in) {}

    using Named = std::pair<const char*, const std::vector<double>*>;
    void write(std::string& file, std::initializer_list<Named> columns) {
        std::string text;
        for (const auto& [name, values] : columns)
            text += (text.empty() ? "" : ",") + std::string(name);
        for (std::size_t n = 0; n < columns.begin()->second->size(); ++n) {
            std::string row;
            for (const auto& [name, values] : columns)
                row += (row.empty() ? "" : ",") + store::text_of((*values)[n]);
            text += "\n" + row;
        }
        file = (folder / fmt::format("{}.csv", tables++)).string();
        store::write_fresh(file, text + "\n");
    }
    void columns(const char*, std::string& file, const Column& first, std::vector<double>& a,
                 const Column& second, std::vector<double>& b) {
        write(file, {{first.name, &a}, {second.name, &b}});
    }
    void start_table(TableStart& t) {
        write(t.file, {{t.of_modes ? "mode" : "x_m", &t.at},
                       {"displacement_m", &t.displacement},
                       {"velocity_m_per_s", &t.velocity}});
    }
    void force(const char*, Pluck& p) {
        if (p.file.empty()) return;
        std::vector<double> newtons;
        for (const double share : p.share) newtons.push_back(share * p.peak);
        write(p.file, {{"time_s", &p.time}, {"force_N", &newtons}});
    }
};
}  // namespace

Scene in_files(Scene scene, const std::filesystem::path& folder) {
    IntoFiles pass(folder);
    fields(pass, scene);
    return scene;
}

}  // namespace jvari::bench::check
