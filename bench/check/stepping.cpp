// Checks stepping: no allocation, all rows to the last, identical with and without probing.
#include <fmt/core.h>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>

#include "bench/check/allocations.hpp"
#include "bench/check/promise.hpp"
#include "schemes/contact/compliance.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::check {

namespace {
// Returns "" if both traces have equally many rows and taps with identical bits.
std::string apart(const Trace& a, const Trace& b) {
    if (a.rows != b.rows) return fmt::format("{} rows in place of {}", b.rows, a.rows);
    if (a.taps() != b.taps()) return fmt::format("{} taps in place of {}", b.taps(), a.taps());
    for (int k = 0; k < a.taps(); ++k)
        if (std::memcmp(a.column(k).data(), b.column(k).data(), a.rows * sizeof(double)) != 0) {
            long n = 0;
            while (std::bit_cast<std::uint64_t>(a.column(k)[n]) ==
                   std::bit_cast<std::uint64_t>(b.column(k)[n]))
                ++n;
            return fmt::format("tap {} in row {}: {:.17g} in place of {:.17g}", a.names[k], n,
                               b.column(k)[n], a.column(k)[n]);
        }
    return "";
}
}  // namespace

Verdict allocates_nothing(const Case& c) {
    if (judge::is_external(c.scheme)) return not_asked(in_a_process);
    if (*c.scheme.untimed) return not_asked(c.scheme.untimed);
    if (!Allocations::counted()) return not_asked("allocations are not counted on this C library");
    const auto scheme = make_scheme(c.scheme, c.scene, c.settings);
    const int taps = static_cast<int>(c.scene.taps.size());
    std::vector<double> tap(64 * taps), energy(64 * 3);
    scheme->reset();
    const Allocations allocations;
    scheme->advance({64, taps, 64, tap.data(), nullptr});
    scheme->advance({64, taps, 64, tap.data(), energy.data()});
    scheme->reset();
    const long count = allocations.count();
    return count == 0 ? kept()
                      : broken(fmt::format("{} allocations in 128 rows and a reset", count));
}

Verdict gives_numbers(const Case& c) {
    const jvari::Run r = fresh(c, {.energy = c.scheme.balance != Balance::none});
    if (r.trace.rows <= 0) return broken("gives no row");
    const auto touched = [](const String& s) { return s.has_contacts(); };
    if (c.scheme.balance == Balance::none &&
        std::any_of(c.scene.strings.begin(), c.scene.strings.end(), touched))
        return kept("it may diverge: it promises no balance");
    if (r.status.outcome != Outcome::ok)
        return broken(fmt::format("{} at step {}", name_of(r.status.outcome), r.status.step));
    return r.trace.rows == r.trace.stride
               ? kept()
               : broken(fmt::format("{} of {} rows", r.trace.rows, r.trace.stride));
}

Verdict same_bits_whatever_the_block(const Case& c) {
    const jvari::Run first = fresh(c, {.block_rows = 64});
    for (const int rows : {1, 7, 1000})
        if (const std::string fault = apart(first.trace, fresh(c, {.block_rows = rows}).trace);
            !fault.empty())
            return broken(fmt::format("with {} rows a block: {}", rows, fault));
    return kept();
}

namespace {
// Tests a run that probes the energy of only some rows (schemes/looks.hpp).
Verdict stores_the_same_probed_now_and_then(const Case& c, const Trace& probed) {
    constexpr int each = 7;  // rows between two probes
    const auto scheme = make_scheme(c.scheme, c.scene, c.settings);
    std::vector<double> tap(c.scene.taps.size());
    double energy[3];
    const FlushDenormals flush;
    scheme->reset();
    for (long row = 0; row < probed.rows; ++row) {
        const bool probe = row % each == each - 1;
        scheme->advance({1, static_cast<int>(tap.size()), 1, tap.data(), probe ? energy : nullptr});
        if (probe && std::bit_cast<std::uint64_t>(energy[0]) !=
                         std::bit_cast<std::uint64_t>(probed.energy[static_cast<std::size_t>(row)]))
            return broken(
                fmt::format("stores {:.17g} J in row {} in place of {:.17g} J where the rows "
                            "before it are not probed",
                            energy[0], row, probed.energy[static_cast<std::size_t>(row)]));
    }
    return kept();
}
}  // namespace

Verdict same_bits_with_energy_probed(const Case& c) {
    const jvari::Run bare = fresh(c, {.timed = true});
    jvari::Run probed = fresh(c, {.energy = true});
    if (c.scheme.balance == Balance::none)
        // Probed runs detect divergence sooner.
        probed.trace.rows = std::min(probed.trace.rows, bare.trace.rows);
    jvari::Trace seen = bare.trace;
    if (c.scheme.balance == Balance::none) seen.rows = probed.trace.rows;
    const std::string fault = apart(seen, probed.trace);
    return fault.empty() ? stores_the_same_probed_now_and_then(c, probed.trace) : broken(fault);
}

Verdict starts_anew_after_a_reset(const Case& c) {
    const auto scheme = make_scheme(c.scheme, c.scene, c.settings);
    const jvari::Run first = run(*scheme, c.scene, c.settings, {.energy = true}),
                     again = run(*scheme, c.scene, c.settings, {.energy = true});
    const std::string fault = apart(first.trace, again.trace);
    if (!fault.empty()) return broken(fault);
    const auto &was = first.trace.energy, &is = again.trace.energy;
    return was.size() == is.size() &&
                   std::memcmp(was.data(), is.data(), was.size() * sizeof(double)) == 0
               ? kept()
               : broken("its energy columns are others the second time");
}

// ---- Size of the state that a scheme carries from step to step.

namespace {
std::optional<int> dofs_of(const Case& c) {  // nothing if it refuses
    try {
        return make_scheme(c.scheme, c.scene, c.settings)->dofs();
    } catch (const Refusal&) { return std::nullopt; } catch (const BadScene&) {
        return std::nullopt;
    }
}

// State bound: displacement and velocity for each mode, or for each node of a grid no finer than a
// wave travels in a step. Each contact adds a value at two levels, and a filter at an end a few
// values. A second plane doubles the count. A profile has a contact at each of its nodes, or at the
// points declared by the scheme.
double contacts_on(const ProfileBarrier& profile, double length, double nodes, const Case& c) {
    const bool own = std::ranges::any_of(c.scheme.options, [](const Option& o) {
        return o.name == std::string(profile_points_option.name);
    });
    const double on_nodes = std::ceil(nodes * (profile.to - profile.from) / length);
    return own ? std::max(on_nodes, number_option(c.settings, profile_points_option)) : on_nodes;
}
int most_state(const Case& c, bool sized_by_modes) {
    double most = 0;
    for (const String& s : c.scene.strings) {
        const double speed = std::sqrt(s.tension / s.linear_density);
        const double nodes = sized_by_modes ? c.settings.modes
                                            : std::ceil(s.length * c.settings.sample_rate / speed);
        double contacts = 0;
        for (const Barrier& b : s.barriers) {
            const auto* profile = std::get_if<ProfileBarrier>(&b);
            contacts += profile ? contacts_on(*profile, s.length, nodes, c) : 1;
        }
        constexpr int at_an_end = 6;
        most += (2 * (nodes + contacts) + at_an_end) * (s.polarisation ? 2 : 1);
    }
    return static_cast<int>(most);
}
}  // namespace

Verdict carries_no_more_state(const Case& c) {
    const int dofs = dofs_of(c).value();
    if (dofs <= 0) return broken(fmt::format("says that it carries {} doubles", dofs));
    Case more = c;
    more.settings.modes *= 2;
    const int most = most_state(c, dofs_of(more).value_or(0) > dofs);
    if (dofs > most) return broken(fmt::format("carries {} doubles, where {} do", dofs, most));
    Case bare = c;  // without pluck, barriers, thread, second plane and extra taps
    bare.scene.taps.resize(1);
    for (String& s : bare.scene.strings) {
        s.pluck.reset();
        s.thread.reset();
        s.barriers.clear();
        s.polarisation.reset();
    }
    std::erase_if(bare.scene.taps, [](const Tap& t) {
        return t.quantity != Quantity::displacement && t.quantity != Quantity::nut_force;
    });
    if (const auto other = dofs_of(bare); other && *other > dofs)
        return broken(
            fmt::format("carries {} doubles without contact, thread and pluck, and {} with them",
                        *other, dofs));
    Case quiet = c;
    quiet.scene.taps.resize(1);
    if (const auto other = dofs_of(quiet); other && *other != dofs)
        return broken(fmt::format("carries {} doubles for one tap, and {} for {}", *other, dofs,
                                  c.scene.taps.size()));
    return kept();
}

}  // namespace jvari::bench::check
