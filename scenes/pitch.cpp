#include "scenes/pitch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "scenes/wording.hpp"

namespace jvari {

namespace {
// Reads "-14c", "+1.5 cents".
std::optional<double> cents_of(std::string_view text) {
    const auto unit = text.find('c');
    if (unit == text.npos || (text.front() != '+' && text.front() != '-')) return {};
    const std::string_view word = text.substr(unit);
    if (word != "c" && word != "cent" && word != "cents") return {};
    text = text.substr(0, unit);
    while (text.ends_with(' ')) text.remove_suffix(1);
    return number_of(text);
}
}  // namespace

std::optional<double> frequency_of_note(std::string_view note, double a4) {
    constexpr std::string_view letters = "CDEFGAB";
    constexpr int above_c[] = {0, 2, 4, 5, 7, 9, 11};  // [semitones]
    const auto take = [&note](char c) {
        const bool there = !note.empty() && note.front() == c;
        if (there) note.remove_prefix(1);
        return there;
    };
    const std::size_t letter = note.empty() ? letters.npos : letters.find(note.front());
    if (letter == letters.npos) return {};
    note.remove_prefix(1);
    int semitone = above_c[letter];
    if (take('#')) ++semitone;
    else if (take('b')) --semitone;
    const bool below_zero = take('-');
    if (note.empty() || note.front() < '0' || note.front() > '9') return {};
    const int octave = note.front() - '0';
    if (below_zero && octave != 1) return {};
    note.remove_prefix(1);
    std::optional<double> cents = 0;
    if (!note.empty()) {
        while (take(' ')) {}
        cents = cents_of(note);
    }
    if (!cents) return {};
    const int above_a4 = semitone - 9 + 12 * ((below_zero ? -1 : octave) - 4);
    return a4 * std::exp2(above_a4 / 12.0 + *cents / 1200);
}

double tension_for(const String& s, double hertz) {
    const double beta = std::numbers::pi / s.length, omega = 2 * std::numbers::pi * hertz;
    return s.linear_density * (omega / beta) * (omega / beta) - s.bending_stiffness * beta * beta;
}

double pitch_of(const String& s) {
    const auto* measured = std::get_if<TableDamping>(&s.damping);
    return measured && !measured->frequency_hz.empty() ? measured->frequency_hz.front()
                                                       : tuned_pitch(s);
}

double lowest_pitch(const Scene& scene) {
    double lowest = std::numeric_limits<double>::infinity();
    for (const String& s : scene.strings) lowest = std::min(lowest, pitch_of(s));
    return lowest;
}

double tuned_pitch(const String& s) {
    const double beta = std::numbers::pi / s.length;
    return beta / (2 * std::numbers::pi) *
           std::sqrt((s.tension + s.bending_stiffness * beta * beta) / s.linear_density);
}

double wave_impedance(const String& s) {
    return s.tension > 0 ? std::sqrt(s.tension * s.linear_density)
                         : s.linear_density * 2 * s.length * tuned_pitch(s);
}

double inharmonicity(const String& s) {
    const double beta = std::numbers::pi / s.length;
    return s.bending_stiffness * beta * beta / s.tension;
}

std::string note_of(double hertz) {
    constexpr const char* names[] = {"C",  "C#", "D",  "D#", "E",  "F",
                                     "F#", "G",  "G#", "A",  "A#", "B"};
    const double above_c_minus_1 = 69 + 12 * std::log2(hertz / 440);  // [semitones]
    if (!(above_c_minus_1 > -0.5 && above_c_minus_1 < 131.5)) return "";
    const int nearest = static_cast<int>(std::lround(above_c_minus_1)),
              cents = static_cast<int>(std::lround(100 * (above_c_minus_1 - nearest)));
    return names[nearest % 12] + std::to_string(nearest / 12 - 1) +
           (cents == 0 ? "" : (cents > 0 ? " +" : " ") + std::to_string(cents) + " cents");
}

double slack_pitch(const String& s) {
    const double beta = std::numbers::pi / s.length;
    return beta * beta / (2 * std::numbers::pi) * std::sqrt(s.bending_stiffness / s.linear_density);
}

}  // namespace jvari
