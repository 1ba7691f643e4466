// Errors of matched and own compliance, figure by figure: a line of CSV for each tap of each run of
// two schemes, with all modes below 20 kHz and with half of them, at 44.1 and 176.4 kHz.
//
//   harm_figures string|bar|wide COUNT SEED    COUNT scenes of random_scene.hpp, seeds SEED and on
//
// The truth is exact_contact, matched, with 4 to 8 times the modes. Its uncertainty is the larger
// of its change from half the modes, and its distance from half as many own modes where that
// exceeds their own change. `exact_*` are errors of exact_contact with the scheme's modes,
// `own_twice` the scheme's with twice the own modes; -1: refused, or no run.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>

#include "random_scene.hpp"
#include "reference/agreement.hpp"
#include "reference/references.hpp"
#include "scenes/excitation.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"

namespace jvari::test {
namespace {

constexpr rlim_t seconds_allowed = 20;  // of CPU, all runs of one scene together

std::optional<Trace> trace_of(const Descriptor& d, const RandomCase& c, int modes, double rate,
                              const char* compliance) try {
    const Run r = run(d, c.scene, {rate, c.settings.tap_rate, modes, {{"compliance", compliance}}});
    if (r.status.outcome != Outcome::ok) return std::nullopt;
    return r.trace;
} catch (const Refusal&) { return std::nullopt; }

// relative L2 from the end of what pulls the string
double apart(const Trace& a, const Trace& b, int k, double from) {
    return relative_difference(rows_from(a.column(k), from, a.tap_rate),
                               rows_from(b.column(k), from, b.tap_rate));
}

void print_figures(const RandomCase& c, const char* kind) {
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
    const auto print_run = [&](const Descriptor& d, int modes, int times) {
        const double rate = times * c.settings.sample_rate;
        const auto o = trace_of(d, c, modes, rate, "own"),
                   m = trace_of(d, c, modes, rate, "matched"),
                   twice = trace_of(d, c, 2 * modes, rate, "own"), in_own = exact(modes, "own"),
                   in_matched = exact(modes, "matched");
        for (int k = 0; k < truth->taps(); ++k) {
            const double by_own = off(own, k), change = off(fewer, k);
            const bool counts = by_own > apart(*own_fewer, *own, k, from);
            std::printf("%s,%llu,%d,%d,%s,%d,%s,%.4g,%.4g,%.3g,%.4g,%.4g,%.4g\n", kind,
                        static_cast<unsigned long long>(c.seed), below, modes, d.name, times,
                        truth->names[static_cast<std::size_t>(k)].c_str(), off(o, k), off(m, k),
                        counts ? std::max(change, by_own) : change, off(in_own, k),
                        off(in_matched, k), off(twice, k));
        }
    };
    for (const int modes : {below, below / 2})
        for (const Descriptor& d : schemes())
            if (const std::string name = d.name;
                name == "modal_two_point" || name == "modal_two_moment")
                for (const int times : {1, 4}) print_run(d, modes, times);
}
}  // namespace
}  // namespace jvari::test

int main(int argc, char** argv) {
    using namespace jvari::test;
    if (argc != 4)
        return std::fprintf(stderr, "usage: harm_figures string|bar|wide COUNT SEED\n"), 2;
    const std::string kind = argv[1];
    const std::uint64_t count = std::strtoull(argv[2], nullptr, 10),
                        first = std::strtoull(argv[3], nullptr, 10);
    std::printf(
        "kind,seed,below,modes,scheme,times,tap,own,matched,uncertain,exact_own,exact_matched,"
        "own_twice\n");
    for (std::uint64_t seed = first; seed < first + count; ++seed) {
        std::fflush(stdout);
        const pid_t child = fork();
        if (child == 0) {
            const rlimit time{seconds_allowed, seconds_allowed + 5};
            setrlimit(RLIMIT_CPU, &time);
            print_figures(matching_case(seed, kind == "bar"    ? Matching::bar
                                              : kind == "wide" ? Matching::wide
                                                               : Matching::string),
                          kind.c_str());
            std::fflush(stdout);
            _exit(0);
        }
        if (child < 0) return std::perror("fork"), 1;
        int status = 0;
        waitpid(child, &status, 0);
        if (status != 0) std::printf("# %s %llu: no answer\n", argv[1], (unsigned long long)seed);
    }
}
