// Converts between a string's pitch and its tension.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "scenes/scene.hpp"

namespace jvari {

// The frequency of a note in equal temperament: "C3", "F#2", "Bb4", from C-1 to B9, perhaps with a
// deviation: "A2 -14c", "C3 +1.5 cents". Nothing for any other text.
std::optional<double> frequency_of_note(std::string_view note, double a4 = 440);  // [Hz]

// Tension at which the first mode, without damping and with bending stiffness, has this frequency:
// T = mu (2 L f)^2 - EI (pi/L)^2. The result is not positive if the stiffness alone gives that
// frequency or a higher one.
double tension_for(const String&, double hertz);  // [N]
double slack_pitch(const String&);                // for a string without tension [Hz]

// First-mode frequency without damping [Hz]: the first function uses length, tension, linear
// density and bending stiffness; the second uses measured modes if the string has them.
double tuned_pitch(const String&);
double pitch_of(const String&);
double lowest_pitch(const Scene&);  // of all strings [Hz]
// sqrt(T mu) [kg/s]; for a bar mu 2 L f_1
double wave_impedance(const String&);
// B = pi^2 EI/(T L^2) in f_n = n f_0 sqrt(1 + B n^2); infinite without tension
double inharmonicity(const String&);
// the nearest note and the deviation: "E2", "C3 -14 cents"; "" outside C-1 to B9
std::string note_of(double hertz);

}  // namespace jvari
