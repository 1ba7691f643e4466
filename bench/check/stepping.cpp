// How a scheme steps: without allocating, to the last row, the same whatever it is asked beside.
#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

#include "bench/check/allocations.hpp"
#include "bench/check/judges.hpp"

namespace jvari::bench::check {

namespace {
// "" where the rows that both have are the same bits, and both have as many.
std::string apart(const Trace& a, const Trace& b) {
    if (a.rows != b.rows) return fmt::format("{} rows in place of {}", b.rows, a.rows);
    if (a.taps() != b.taps()) return fmt::format("{} taps in place of {}", b.taps(), a.taps());
    for (int k = 0; k < a.taps(); ++k)
        if (std::memcmp(a.column(k).data(), b.column(k).data(), a.rows * sizeof(double)) != 0) {
            long n = 0;
            while (std::bit_cast<std::uint64_t>(a.column(k)[n]) == std::bit_cast<std::uint64_t>(b.column(k)[n])) ++n;
            return fmt::format("tap {} in row {}: {:.17g} in place of {:.17g}", a.names[k], n, b.column(k)[n], a.column(k)[n]);
        }
    return "";
}
}  // namespace

Verdict allocates_nothing(const Case& c) {
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
    return count == 0 ? kept() : broken(fmt::format("{} allocations in 128 rows and a reset", count));
}

Verdict gives_numbers(const Case& c) {
    const jvari::Run r = fresh(c, {.energy = c.scheme.balance != Balance::none});
    if (r.trace.rows <= 0) return broken("gives no row");
    const auto touched = [](const String& s) { return !s.barriers.empty(); };
    if (c.scheme.balance == Balance::none && std::any_of(c.scene.strings.begin(), c.scene.strings.end(), touched))
        return kept("it may diverge: it promises no balance");
    if (r.status.outcome != Outcome::ok) return broken(fmt::format("{} at step {}", name_of(r.status.outcome), r.status.step));
    return r.trace.rows == r.trace.stride ? kept() : broken(fmt::format("{} of {} rows", r.trace.rows, r.trace.stride));
}

Verdict same_bits_whatever_the_block(const Case& c) {
    const jvari::Run first = fresh(c, {.block_rows = 64});
    for (const int rows : {1, 7, 1000})
        if (const std::string found = apart(first.trace, fresh(c, {.block_rows = rows}).trace); !found.empty())
            return broken(fmt::format("with {} rows a block: {}", rows, found));
    return kept();
}

namespace {
// A run looks at the energy of some rows alone (schemes/looks.hpp).
Verdict stores_the_same_probed_now_and_then(const Case& c, const Trace& probed) {
    constexpr int each = 7;  // row
    const auto scheme = make_scheme(c.scheme, c.scene, c.settings);
    std::vector<double> tap(c.scene.taps.size());
    double energy[3];
    const FlushDenormals flush;
    scheme->reset();
    for (long row = 0; row < probed.rows; ++row) {
        const bool asked = row % each == each - 1;
        scheme->advance({1, static_cast<int>(tap.size()), 1, tap.data(), asked ? energy : nullptr});
        if (asked && std::bit_cast<std::uint64_t>(energy[0]) != std::bit_cast<std::uint64_t>(probed.energy[static_cast<std::size_t>(row)]))
            return broken(fmt::format("stores {:.17g} J in row {} in place of {:.17g} J where the rows before it are not probed", energy[0],
                                      row, probed.energy[static_cast<std::size_t>(row)]));
    }
    return kept();
}
}  // namespace

Verdict same_bits_with_energy_probed(const Case& c) {
    const jvari::Run bare = fresh(c, {.timed = true});
    jvari::Run probed = fresh(c, {.energy = true});
    if (c.scheme.balance == Balance::none)
        probed.trace.rows = std::min(probed.trace.rows, bare.trace.rows);  // it is seen to diverge sooner
    jvari::Trace seen = bare.trace;
    if (c.scheme.balance == Balance::none) seen.rows = probed.trace.rows;
    const std::string found = apart(seen, probed.trace);
    return found.empty() ? stores_the_same_probed_now_and_then(c, probed.trace) : broken(found);
}

Verdict starts_anew_after_a_reset(const Case& c) {
    const auto scheme = make_scheme(c.scheme, c.scene, c.settings);
    const jvari::Run first = run(*scheme, c.scene, c.settings, {.energy = true}),
                     again = run(*scheme, c.scene, c.settings, {.energy = true});
    const std::string found = apart(first.trace, again.trace);
    if (!found.empty()) return broken(found);
    const auto &was = first.trace.energy, &is = again.trace.energy;
    return was.size() == is.size() && std::memcmp(was.data(), is.data(), was.size() * sizeof(double)) == 0
               ? kept()
               : broken("its energy columns are others the second time");
}

}  // namespace jvari::bench::check
