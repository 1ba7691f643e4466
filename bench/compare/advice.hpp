// Advice: the settings that a scene needs within a tolerance, estimated by two runs, without a
// reference.
//
// A rung is a pair of runs. The first run has a rate and the most modes possible at this rate. The
// finer run has twice the rate, 1.5 to 2 times the modes and twice the points for a profile. The
// difference between the two estimates the error in the first run. The advice takes the first rung
// within the tolerance, and halves the modes while the estimate stays within. Six rules prevent
// estimates that are too small:
//   margin      the difference counts 2.5 times
//   fall        the difference counts at least a third of the difference on the rung before
//   rise        a rung is left out if its modes cannot rise by a factor of 1.5
//   compliance  matched if at least 0.4 of the modes possible with own can be matched, and always
//               for a rigid barrier; else own
//   silence     a tap that reads zero in either run gives no answer
//   points      the finer run has twice the points for a profile
// The result is still an estimate (bench/README.md has its record). Two runs cannot show an error
// that both share, such as the numerical loss in a grid, so schemes without a record are refused.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/compare/catalogue.hpp"
#include "bench/compare/target.hpp"
#include "schemes/trace.hpp"

namespace jvari::bench::compare {

struct AdviceRequest {
    // within: "1%", or "" (advise). measure "": the waveform over 8 periods of the lowest string
    std::string within{}, measure{}, tap{}, scheme{};
    std::optional<double> tap_rate{};  // [Hz], default 44100; rates are multiples of tap_rate
    std::vector<SchemeOption> options{};
};

struct Advice {
    Target target;
    std::string tap;
    double window = 0;                   // judged window [s]
    bool periods = false;                // true: the window is eight periods
    const Descriptor* scheme = nullptr;  // nullptr: no rung was run
    Settings settings, finer;            // advised settings, and settings of the finer run
    // counted: the estimate, after the rule `fall`
    double difference = nan, counted = nan, margin = 0;
    bool within = false;  // false: the settings are the nearest that were tried
    std::string ended;    // reason why no further rungs, or none at all, were run
    double seconds = 0;   // processor time of all runs and of making their schemes
    // The longest window over which the waveform's estimated error is at most 10 %, by the same two
    // runs [s]; NaN: the whole one. A second advice, for third octaves, has that of the first.
    double known_for = nan;
};

// True if scheme, rate and modes are to be chosen, false if they are named. Throws UsageError if
// the request does both, or if a measure or a tap comes without a tolerance.
bool asks_for_advice(const AdviceRequest&, bool names_rate, int modes);
// Returns one or two advices; the last counts. The default tolerance is 1 % on the waveform; if 1 %
// is out of reach, a second advice for 3 dB in third octaves follows. Throws UsageError, BadScene,
// and Refusal if no scheme with a record represents the scene.
std::vector<Advice> advise(const Scene&, const AdviceRequest&, const Catalogue&,
                           const store::Listener&);
// True if the settings are to be run: they are within the tolerance, or the nearest where the
// request's `within` names none.
bool is_to_run(const Advice&, const std::string& within);
// Settings with the reason, in a line: "modal_two_point compliance=matched, 80 modes, 88200 Hz:
// ..."
std::string text_of(const Advice&);
// settings and estimate only
std::string short_text(const Advice&);
nlohmann::ordered_json json_of(const Advice&);

}  // namespace jvari::bench::compare
