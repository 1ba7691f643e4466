// What a reader of a scene is told before it is run: what its strings are, and what looks wrong.
#pragma once

#include <string>

#include "analysis/judgement.hpp"
#include "bench/compare/bound.hpp"
#include "bench/store/system/listener.hpp"
#include "scenes/scene.hpp"
#include "schemes/scheme.hpp"

namespace jvari::bench::compare {

// "f1 = 82.4 Hz (E2), tension 74.3 N, inharmonicity 1.2e-04"; or "..., 40 measured modes"
std::string tuning_text(const String&);

// Where a scene has barriers and its run never touched one: that, and what to look at. ""
// elsewhere, and where the run does not say.
std::string untouched_text(const Scene&, const Figures& run);

// Warns of values that look like another unit than SI, and of a string that
// nothing sets in motion before the scene ends: no start, no pluck, no barrier that presses it, no
// other string through a moving body.
void note_scene(const Scene&, const store::Listener&);
// The part of it on tables: modes that a file lacks, a first mode that is out of tune, the state of
// another scene, a force much longer than the run.
void note_tables(const Scene&, const store::Listener&);

// Finite differences take their nodes from the rate, whatever modes are asked for.
bool has_own_grid(const Descriptor&);
std::string grid_text(const Descriptor&, const std::string& modes);
// Before a run: modes that its scheme leaves aside, or that a start has beyond them.
void note_modes(const Descriptor&, const Scene&, const Settings&, const store::Listener&);

// Says of a force file whose rows are closer than a step of the lowest sample rate [Hz] that each
// step pushes by the mean. 0: no rate.
void note_force_files(const Scene&, double sample_rate, const store::Listener&);

// ---- Why no cell is as accurate as asked, and what to do: a few sentences where a table would say
// "none".
//
// They name the closest cell and what stands in the way: the motion's sensitivity, the reference,
// the modes left out, or the rate. Of the rate there are three cases: too few rates to extrapolate,
// errors that do not fall, and a rate that would do or is out of reach. The last sentence says what
// can be judged instead.

// `rows`: of one scene, timed and trusted; `measure`: a relative L2; `most`: what none of them is
// within.
std::string why_none(const study::Cells&, const study::Rows&, std::size_t measure, double most);

std::string percent(double share);  // "0.43 %", "97 %"
// "1.3 %", "\u2264 20 %" where the reference's uncertainty counts, "2.1 dB"
std::string quoted(const Bound&, std::size_t measure);
std::string time_text(double seconds);  // "8 ms", "280 ms", "1.2 s"

}  // namespace jvari::bench::compare
