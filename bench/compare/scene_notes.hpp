// Notes on a scene before a run: facts about its strings, and suspicious values.
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

// Warning with advice for a scene whose barriers the run never touched. "" if there are no
// barriers, or contact, or no information about contact in the run.
std::string untouched_text(const Scene&, const Figures& run);

// Warns of values that look like another unit than SI. Warns of a string without excitation before
// the scene ends: no start, no pluck, no barrier that presses, no other string through a moving
// body.
void note_scene(const Scene&, const store::Listener&);
// Notes on tables: modes missing from a file, a first mode out of tune, the state of another scene,
// a force much longer than the run.
void note_tables(const Scene&, const store::Listener&);

// True for finite differences: the nodes follow from the rate, whatever modes are requested.
bool has_own_grid(const Descriptor&);
std::string grid_text(const Descriptor&, const std::string& modes);
// Notes before a run: modes that the scheme leaves out, or modes in the start beyond the scheme's.
void note_modes(const Descriptor&, const Scene&, const Settings&, const store::Listener&);

// Says where the windows of errors begin: under a force that lasts, after a blow, and after a pluck
// shorter than a period, which may be meant as one.
void note_windows(const Scene&, const store::Listener&);

// Throws UsageError if this sample rate [Hz] does not carry the lowest string's first mode.
void refuse_slow_rate(const Scene&, double rate);

// Notes force files with rows closer than a step at the lowest sample rate [Hz]: each step pushes
// with the mean. 0: no rate.
void note_force_files(const Scene&, double sample_rate, const store::Listener&);

// ---- Reasons why no cell is as accurate as requested, and advice: a few sentences in place of
// "none" in a table.
//
// The sentences name the closest cell and the obstacle: the motion's sensitivity, the reference,
// the modes left out, or the rate. For the rate there are three cases: too few rates to
// extrapolate, errors that do not fall, and a sufficient rate, within reach or not. The last
// sentence names a target that can be judged instead.

// `rows`: timed and trusted rows on one scene; `measure`: a relative L2; `most`: the accuracy that
// no row reaches.
std::string why_none(const study::Cells&, const study::Rows&, std::size_t measure, double most);

std::string percent(double share);  // "0.43 %", "97 %"
// Text of a bound: "1.3 %", "\u2264 20 %" if the reference's uncertainty counts, "2.1 dB".
std::string quoted(const Bound&, std::size_t measure);
std::string time_text(double seconds);  // "8 ms", "280 ms", "1.2 s"

}  // namespace jvari::bench::compare
