// The settings that a scene needs within a tolerance: estimated by two runs, without a reference.
//
// A rung is a run at a rate with the most modes that it takes, and a finer run at twice the rate
// with 1.5 to 2 times the modes and twice the points of a profile. The difference between the two
// estimates the error of the first. The first rung within the tolerance is taken, and its modes are
// halved as long as that stays so. Six rules keep the estimate from being false:
//   margin      the difference counts 2.5 times
//   fall        it counts as a third of the difference of the rung before at least
//   rise        a rung whose modes cannot rise by 1.5 times is left out
//   compliance  matched where at least 0.4 of the modes that own takes can be matched, and always
//               of a rigid barrier; else own
//   silence     a tap that reads zero in either run is no answer
//   points      those of a profile are doubled in the finer run
// It stays an estimate (bench/README.md has its record). Two runs cannot see what both leave out,
// as the loss of a grid, so schemes without a record are refused.
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
    // within: "1%", or "" (advise); measure "": the waveform over 8 periods of the lowest string
    std::string within{}, measure{}, tap{}, scheme{};
    std::optional<double> tap_rate{};  // [Hz]; 44100 where absent. Rates are multiples of it
    std::vector<SchemeOption> options{};
};

struct Advice {
    Target target;
    std::string tap;
    double window = 0;                   // [s] that is judged
    bool periods = false;                // the window is eight periods
    const Descriptor* scheme = nullptr;  // nullptr: no rung was run
    Settings settings, finer;            // those advised, and those of the finer run
    // counted: by the rule of the fall, the estimate
    double difference = nan, counted = nan, margin = 0;
    bool within = false;  // else the settings are the nearest that were tried
    std::string ended;    // why there are no further rungs, or none at all
    double seconds = 0;   // of processor, of all runs
};

// Whether scheme, rate and modes are to be chosen, or were named. Throws UsageError where both, and
// for a measure or a tap without a tolerance.
bool asks_for_advice(const AdviceRequest&, bool names_rate, int modes);
// The last one counts. Where no tolerance is asked for it is 1 % of the waveform; a second advice,
// 3 dB in third octaves, follows where that cannot be had. Throws UsageError, BadScene, Refusal
// where no scheme with a record represents the scene.
std::vector<Advice> advise(const Scene&, const AdviceRequest&, const Catalogue&,
                           const store::Listener&);
// "modal_two_point compliance=matched, 80 modes, 88200 Hz: ..." and why, one line
std::string text_of(const Advice&);
// settings and estimate alone
std::string short_text(const Advice&);
nlohmann::ordered_json json_of(const Advice&);

}  // namespace jvari::bench::compare
