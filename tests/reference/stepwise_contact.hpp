// exact_contact by another algorithm: what its numbers and its speed are held against. Option window: a factor on every window, at most 1.
#pragma once

#include "schemes/scheme.hpp"

namespace jvari {

extern const Descriptor stepwise_contact;

}  // namespace jvari
