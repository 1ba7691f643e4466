// Checks and values for a scheme's `make`, and what a scheme that breaks the contract of scheme.hpp
// is told.
#pragma once

#include <string>

#include "schemes/scheme.hpp"

namespace jvari {

struct Modes;

// sample_rate/tap_rate; Refusal unless a whole number from 1 to 2^31 - 1
int steps_per_row(const Settings&);
// settings.modes, or every mode below min(20 kHz, sample_rate/2)
int modes_for(const String&, const Settings&);
// the most that one of its strings has, unasked no more than each table of measured modes
int modes_for(const Scene&, const Settings&);
// those; Refusal where there is none, or more than most_modes
Modes modes_of(const String&, const Settings&);

// What a descriptor says. margin_of: the least margin that the scheme's limit leaves on a string of
// the scene; NaN where it has nothing to say.
bool represents(const Descriptor&, const Scene&);
bool declares(const Descriptor&, const std::string& option_name);
Features approximated(const Descriptor&);
double margin_of(const Descriptor&, const Scene&, const Settings&);

// The value of a declared option, or its fallback. A choice is one of its words:
// choice_option(settings, levels) == "3".
std::string option(const Settings&, const Option&);
std::string choice_option(const Settings&, const Option&);
double number_option(const Settings&, const Option&);
// where it depends on scene and settings
double number_option(const Settings&, const Option&, double fallback);

// An option that the scheme does not declare, or that is given more than once.
struct BadOption : Refusal {
    using Refusal::Refusal;
};

// A scheme that breaks this contract: makes nothing, throws what says nothing, reports what cannot
// be.
struct BadScheme : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Runs `act`, which is a scheme's own; an exception that is no std::exception becomes a BadScheme
// that says what the scheme was doing.
template <class Act>
auto with_context(const char* doing, Act act) {
    try {
        return act();
    } catch (const std::exception&) { throw; } catch (...) {
        throw BadScheme(
            std::string("the scheme throws something that is no std::exception while it ") + doing);
    }
}

}  // namespace jvari
