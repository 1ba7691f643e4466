// Errors of matched and own compliance, figure by figure: a line of CSV for each tap of each run of
// two schemes, with all modes below 20 kHz and with half of them, at 44.1 and 176.4 kHz.
//
// The truth is exact_contact, matched, with 4 to 8 times the modes. Its uncertainty is the larger
// of its change from half the modes, and its distance from half as many own modes where that
// exceeds their own change. `exact_*` are errors of exact_contact with the scheme's modes,
// `own_twice` the scheme's with twice the own modes; -1: refused, or no run.
#include <algorithm>
#include <cstdio>
#include <optional>

#include "random_checks.hpp"
#include "reference/references.hpp"
#include "scenes/excitation.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"

namespace jvari::test {

namespace {
std::optional<Trace> trace_of(const Descriptor& d, const RandomCase& c, int modes, double rate,
                              const char* compliance) try {
    const Run r = run(d, c.scene, {rate, c.settings.tap_rate, modes, {{"compliance", compliance}}});
    if (r.status.outcome != Outcome::ok) return std::nullopt;
    return r.trace;
} catch (const Refusal&) { return std::nullopt; }
}  // namespace

const char* const harm_columns =
    "seed,below,modes,scheme,times,tap,own,matched,uncertain,exact_own,exact_matched,own_twice";

void harm_figures(const RandomCase& c, const std::function<void(const std::string&)>& line) {
    const int below = c.settings.modes, most = below * std::clamp(600 / below, 4, 8);
    const double from = free_from(c.scene);
    const auto exact = [&](int modes, const char* compliance) {
        return trace_of(exact_contact, c, modes, 0, compliance);
    };
    const auto truth = exact(most, "matched"), fewer = exact(most / 2, "matched"),
               own = exact(most / 2, "own"), own_fewer = exact(most / 4, "own");
    if (!truth || !fewer || !own || !own_fewer) return;
    const auto off = [&](const std::optional<Trace>& t, int k) {
        return t ? apart(*t, *truth, k, from) : -1;
    };
    const auto uncertain = [&](int k) {
        const double change = off(fewer, k), by_own = off(own, k);
        return by_own > apart(*own_fewer, *own, k, from) ? std::max(change, by_own) : change;
    };
    for (const int modes : {below, below / 2}) {
        const auto exact_own = exact(modes, "own"), exact_matched = exact(modes, "matched");
        for (const Descriptor& d : schemes()) {
            if (const std::string name = d.name;
                name != "modal_two_point" && name != "modal_two_moment")
                continue;
            for (const int times : {1, 4}) {
                const auto of = [&](int count, const char* compliance) {
                    return trace_of(d, c, count, times * c.settings.sample_rate, compliance);
                };
                const auto o = of(modes, "own"), m = of(modes, "matched"),
                           twice = of(2 * modes, "own");
                for (int k = 0; k < truth->taps(); ++k) {
                    char text[300];
                    std::snprintf(
                        text, sizeof text, "%llu,%d,%d,%s,%d,%s,%.4g,%.4g,%.3g,%.4g,%.4g,%.4g",
                        static_cast<unsigned long long>(c.seed), below, modes, d.name, times,
                        truth->names[static_cast<std::size_t>(k)].c_str(), off(o, k), off(m, k),
                        uncertain(k), off(exact_own, k), off(exact_matched, k), off(twice, k));
                    line(text);
                }
            }
        }
    }
}

}  // namespace jvari::test
