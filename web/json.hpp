// JSON texts for the page.
#pragma once

#include <span>
#include <string>

#include "analysis/cheapest.hpp"
#include "scenes/scene.hpp"
#include "schemes/run.hpp"

namespace jvari::web {

// schemes and references with their options
std::string list_text();
// parts of the scene to draw and to move
std::string scene_text(const Scene&);
// modes, contacts, thread, pluck and taps as arrays
std::string problem_text(const Scene&, const Settings&);
// outcome, judgement, cost on this machine, facts
std::string run_text(const Run&, const Scene&, int modes, Balance promised);
std::string choice_text(const Choice&);  // by places
// A run beside another: [centre in Hz, difference in dB] of the third octaves within 60 dB of the
// loudest, the same of the whole, the root mean square over bands, the ratio of the decay rates
// minus 1, cents, and the difference with the part that stretching leaves of it.
std::string sounds_text(std::span<const double> run, std::span<const double> reference,
                        double rate);

}  // namespace jvari::web
