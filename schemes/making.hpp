// Checks and values for `make`, and errors for a scheme that breaks the contract in scheme.hpp.
#pragma once

#include <string>

#include "schemes/scheme.hpp"

namespace jvari {

struct Modes;

// sample_rate/tap_rate; Refusal unless a whole number from 1 to 2^31 - 1
int steps_per_row(const Settings&);
// settings.modes, or every mode below min(20 kHz, sample_rate/2)
int modes_for(const String&, const Settings&);
// Largest mode count on any string; by default at most the size of each table with measured modes.
int modes_for(const Scene&, const Settings&);
// Modes for one string; Refusal if there are none, or more than most_modes
Modes modes_of(const String&, const Settings&);

// Queries to a descriptor. margin_of returns the least margin that the scheme's limit leaves on any
// string, or NaN if the limit does not apply.
bool represents(const Descriptor&, const Scene&);
bool declares(const Descriptor&, const std::string& option_name);
Features approximated(const Descriptor&);
double margin_of(const Descriptor&, const Scene&, const Settings&);

// Value for a declared option, or its fallback. A choice is one among its words:
// choice_option(settings, levels) == "3".
std::string option(const Settings&, const Option&);
std::string choice_option(const Settings&, const Option&);
double number_option(const Settings&, const Option&);
// for a fallback that depends on scene and settings
double number_option(const Settings&, const Option&, double fallback);

// Reports an option that the scheme does not declare, or one given more than once.
struct BadOption : Refusal {
    using Refusal::Refusal;
};

// Reports a scheme that breaks this contract: it makes nothing, throws something without a message,
// or reports an impossible value.
struct BadScheme : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Runs `act`, a scheme's function. An exception that is not a std::exception becomes a BadScheme
// that says which action failed.
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
