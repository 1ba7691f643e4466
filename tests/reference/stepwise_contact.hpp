// exact_contact by another algorithm, to compare numbers and speed with. The option window is a factor on every window, at most 1.
#pragma once

#include "schemes/scheme.hpp"

namespace jvari {

extern const Descriptor stepwise_contact;

}  // namespace jvari
