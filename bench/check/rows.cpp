// Checks rows: row 0 holds the scene's shape and no contact force, contacts push, facts agree with
// forces, and the energy ledger balances.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bench/check/promise.hpp"
#include "bench/study/cell.hpp"
#include "bench/study/judgement.hpp"
#include "scenes/excitation.hpp"
#include "scenes/modes.hpp"
#include "scenes/start.hpp"

namespace jvari::bench::check {

Verdict starts_from_the_scenes_shape(const Case& c) {
    Scene scene = c.scene;
    scene.duration = 1 / contract_tap_rate;
    scene.taps.clear();
    std::vector<double> expected, scale;
    for (std::size_t k = 0; k < scene.strings.size(); ++k) {
        String s = scene.strings[k];
        s.damping = NoDamping{};
        const Modes all = modes_of(s, 2000);
        const auto shape = start_of(all, s).displacement;
        for (const double x : {0.1, 0.25, 0.4, 0.5, 0.7, 0.9}) {
            scene.taps.push_back({"y" + std::to_string(scene.taps.size()), Quantity::displacement,
                                  static_cast<int>(k), x * s.length});
            const auto w = displacement_weights(all, x * s.length);
            double y = 0;
            for (std::size_t i = 0; i < w.size(); ++i) y += w[i] * shape[i];
            expected.push_back(y);
            scale.push_back(s.start && std::holds_alternative<RestStart>(*s.start)
                                ? std::abs(*std::max_element(shape.begin(), shape.end()))
                                : largest_displacement(s));
        }
    }
    Settings settings = c.settings;
    settings.modes = contract_modes;  // enough for the shape
    const jvari::Run r = run(c.scheme, scene, settings);
    for (std::size_t k = 0; k < expected.size(); ++k) {
        const double y = r.trace.column(static_cast<int>(k))[0];
        if (!(std::abs(y - expected[k]) <= 0.02 * scale[k]))
            return broken(fmt::format("{:.4g} m at {:.3g} m in place of {:.4g} m", y,
                                      scene.taps[k].position, expected[k]));
    }
    return kept();
}

Verdict starts_without_contact_forces(const Case& c) {
    const jvari::Run r = fresh(c, {});
    for (int k = 0; r.trace.rows > 0 && k < r.trace.taps(); ++k) {
        const Tap& tap = c.scene.taps[k];
        const Quantity q = tap.quantity;
        const bool contact_force = q == Quantity::bridge_force || q == Quantity::thread_force ||
                                   q == Quantity::driving_force;
        const bool at_rest =
            contact_force || (!tap.mass && !needed_by(c.scene).has(Feature::initial_shape));
        if (at_rest && r.trace.column(k)[0] != 0)
            return broken(fmt::format("tap {} is {:.3g} {} in row 0", r.trace.names[k],
                                      r.trace.column(k)[0], unit_of(q)));
    }
    return kept();
}

// ---- Contacts push and never pull, except through a loss: a Hunt-Crossley law may pull while the
// string leaves fast.

Verdict never_pulls(const Case& c) {
    const auto touches = [](const String& s) { return !s.barriers.empty(); };
    if (std::none_of(c.scene.strings.begin(), c.scene.strings.end(), touches))
        return not_asked("the string touches nothing");
    const Features needed = needed_by(c.scene);
    if (needed.has(Feature::contact_loss) && !needed.has(Feature::clipped_loss))
        return not_asked("a contact with a loss may pull");
    Case one = c;
    one.scene.taps = {{"contact", Quantity::bridge_force, std::nullopt, 0}};
    const jvari::Run r = fresh(one, {});
    double least = fact_of(r.facts, facts::smallest_contact_force),
           largest = fact_of(r.facts, facts::largest_contact_force);
    // Tests both the reported forces of single steps and the means in the rows.
    for (const double force : r.trace.column(0)) {
        least = std::fmin(least, force);
        largest = std::fmax(largest, force);
    }
    const double pull = study::pull_of(least, largest);
    return pull <= study::pull_allowed
               ? kept()
               : broken(fmt::format("pulls with {:.2g} N, and pushes with {:.2g} N at most", -least,
                                    largest));
}

// ---- Reported contact forces agree with the rows: a row's force is a mean, which lies between the
// smallest and the largest. Tested with a loss too, if the scheme represents one: the force then
// depends on more than the penetration.

Verdict facts_agree_with_its_rows(const Case& c) {
    if (judge::is_external(c.scheme)) return not_asked(in_a_process);
    Case one = c;
    one.scene.taps.clear();
    for (int k = 0; k < static_cast<int>(c.scene.strings.size()); ++k)
        if (c.scene.strings[k].barriers.size() == 1 &&
            std::holds_alternative<LumpedBarrier>(c.scene.strings[k].barriers[0]))
            // With several contacts a row is a sum.
            one.scene.taps.push_back({"contact" + std::to_string(k), Quantity::bridge_force, k, 0});
    if (one.scene.taps.empty()) return not_asked("no string has one contact");
    // A reference knows the forces at its own steps, and interpolates between them.
    const double rounding = c.scheme.clock == Clock::stepped ? 1e-9 : 1e-6;
    bool reported = false;
    for (const double loss : {0.0, 0.5}) {
        for (String& s : one.scene.strings)
            for (Barrier& b : s.barriers)
                std::visit([loss](auto& x) { x.contact_loss = std::max(x.contact_loss, loss); }, b);
        if (loss > 0 &&
            (needed_by(one.scene).any(any_rigid) || !is_as_the_scene_says(c.scheme, one.scene) ||
             !takes(c.scheme, one.scene, c.settings)))
            break;
        const jvari::Run r = fresh(one, {});
        const double least = fact_of(r.facts, facts::smallest_contact_force),
                     largest = fact_of(r.facts, facts::largest_contact_force);
        reported = reported || !std::isnan(largest) || !std::isnan(least);
        for (int k = 0; k < r.trace.taps(); ++k) {
            // Pulling forces belong to the promise above.
            const double most = std::fmax(std::abs(least), std::abs(largest));
            for (const double force : r.trace.column(k))
                if (std::abs(force) > most * (1 + rounding))
                    return broken(
                        fmt::format("says that contact forces lie between {:.4g} and {:.4g} N, and "
                                    "writes a row of {:.4g} N",
                                    least, largest, force));
        }
    }
    return reported ? kept() : not_asked("it says nothing of its contact forces");
}

// ---- The energy ledger: stored[n] - stored[n-1] = supplied[n] - dissipated[n], in every row and
// in sum.

namespace {
struct Ledger {
    std::vector<double> residual, stored, dissipated;
    double scale = 1e-30;  // [J]
};
Ledger ledger_of(const Case& c) {
    const Trace t = fresh(c, {.energy = true}).trace;
    if (t.rows < 1) throw std::runtime_error("no row to keep a ledger of");
    Ledger l;
    const auto stored = t.energy_column(0), supplied = t.energy_column(1),
               dissipated = t.energy_column(2);
    if (available_energy(c.scene, c.settings.modes) > 0 &&
        std::ranges::all_of(t.energy, [](double x) { return x == 0; }))
        throw std::runtime_error("it promises a balance and writes no energies");
    for (long n = 0; n < t.rows; ++n) {
        l.scale = std::max(l.scale, stored[n]);
        l.residual.push_back(n == 0 ? supplied[0] + dissipated[0]
                                    : stored[n] - stored[n - 1] - supplied[n] + dissipated[n]);
    }
    l.stored.assign(stored.begin(), stored.begin() + t.rows);
    l.dissipated.assign(dissipated.begin(), dissipated.begin() + t.rows);
    return l;
}

constexpr const char* promises_none = "it promises no balance";

double row_bound(const Case& c) { return c.scheme.balance == Balance::exact ? 1e-11 : 1e-8; }

Verdict within(double worst, double bound, const char* of) {
    return worst <= bound ? kept(fmt::format("{:.1e}", worst))
                          : broken(fmt::format(
                                "{} {:.2g} of the largest stored energy, at most {:.0e} is owed",
                                of, worst, bound));
}
}  // namespace

Verdict keeps_its_ledger_in_every_row(const Case& c) {
    if (c.scheme.balance == Balance::none) return not_asked(promises_none);
    const Ledger l = ledger_of(c);
    double worst = 0;
    for (const double r : l.residual) worst = std::max(worst, std::abs(r));
    return within(worst / l.scale, row_bound(c), "a row is out by");
}

Verdict keeps_its_ledger_in_sum(const Case& c) {
    if (c.scheme.balance == Balance::none) return not_asked(promises_none);
    const Ledger l = ledger_of(c);
    double sum = 0, worst = 0;
    for (const double r : l.residual) worst = std::max(worst, std::abs(sum += r));
    return within(worst / l.scale, 10 * row_bound(c), "rows together are out by");
}

Verdict stores_no_negative_energy(const Case& c) {
    if (c.scheme.balance == Balance::none) return not_asked(promises_none);
    const Ledger l = ledger_of(c);
    const double bound = row_bound(c) * l.scale,
                 least = *std::min_element(l.stored.begin(), l.stored.end());
    if (!(least >= -bound)) return broken(fmt::format("stores {:.2g} J", least));
    const Features needed = needed_by(c.scene);
    if (needed.any(any_profile) && c.scheme.balance == Balance::to_tolerance)
        return kept("a rigid-profile rule may give energy; its scheme reports how much");
    const double loss = *std::min_element(l.dissipated.begin(), l.dissipated.end());
    return loss >= -bound ? kept() : broken(fmt::format("dissipates {:.2g} J in a row", loss));
}

}  // namespace jvari::bench::check
