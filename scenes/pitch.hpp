// Pitch in place of tension: what a player tunes a string to.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "scenes/scene.hpp"

namespace jvari {

// Of a note in scientific pitch notation and equal temperament, A4 = 440 Hz: "C3", "F#2", "Bb4", from C-1 to B9. Nothing for another text.
std::optional<double> frequency_of_note(std::string_view note);  // [Hz]

// The tension at which the string's first mode, undamped and with its bending stiffness, has this frequency:
// T = mu (2 L f)^2 - EI (pi/L)^2. Not positive where the stiffness alone makes the string as fast.
double tension_for(const String&, double hertz);  // [N]
double slack_pitch(const String&);                // of the bending stiffness alone [Hz]

double pitch_of(const String&);       // of its first mode, undamped [Hz]
double inharmonicity(const String&);  // B = pi^2 EI/(T L^2), where f_n = n f_0 sqrt(1 + B n^2); infinite without tension
std::string note_of(double hertz);    // the nearest note, with what it is off: "E2", "C3 -14 cents"; "" beyond C-1 to B9

}  // namespace jvari
