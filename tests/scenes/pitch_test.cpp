// What a string is tuned to.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/pitch.hpp"

namespace jvari {

TEST(Tuning, TheNoteOfAPitchIsTheNearestWithItsCents) {
    EXPECT_EQ(note_of(440), "A4");
    EXPECT_EQ(note_of(82.4069), "E2");
    EXPECT_EQ(note_of(440 * std::exp2(30 / 1200.0)), "A4 +30 cents");
    EXPECT_EQ(note_of(440 * std::exp2(-49 / 1200.0)), "A4 -49 cents");
    EXPECT_EQ(note_of(440 * std::exp2(51 / 1200.0)), "A#4 -49 cents");
    EXPECT_EQ(note_of(0), "");
    for (const char* note : {"C-1", "F#2", "C3", "B9"})
        EXPECT_EQ(note_of(*frequency_of_note(note)), note);
}

TEST(Tuning, APitchIsWhatTheTensionForItGivesAndInharmonicityRaisesThePartials) {
    String s;
    s.length = 1;
    s.linear_density = 4.83e-4;
    s.bending_stiffness = 6.03e-5;
    s.tension = tension_for(s, 130.8);
    EXPECT_NEAR(pitch_of(s), 130.8, 1e-9);
    // f_n = n f_0 sqrt(1 + B n^2) with f_0 = sqrt(T/mu)/(2 L): the first partial by it
    const double f0 = 0.5 * std::sqrt(s.tension / s.linear_density);
    EXPECT_NEAR(pitch_of(s), f0 * std::sqrt(1 + inharmonicity(s)), 1e-9);
}

}  // namespace jvari
