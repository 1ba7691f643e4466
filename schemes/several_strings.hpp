// Several strings as one scheme. Strings act on each other only through a body; without one each is a scheme of its own, and what is heard
// of all of them is a sum.
#pragma once

#include <memory>

#include "schemes/scheme.hpp"

namespace jvari {

// One scheme per string of the scene, advanced together where their scheme knows how (Scheme::advance_all): taps of one string are that
// string's, forces of all strings and the energy columns are sums in the order of the strings. The outcome is that of the string that fails
// first; what fails names its string.
std::unique_ptr<Scheme> several_strings(const Descriptor&, const Scene&, const Settings&);

}  // namespace jvari
