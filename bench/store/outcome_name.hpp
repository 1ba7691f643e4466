// An outcome by its name, as files hold it.
#pragma once

#include <stdexcept>
#include <string>

#include "schemes/scheme.hpp"

namespace jvari::bench::store {

inline Outcome outcome_named(const std::string& name) {  // throws std::runtime_error where there is none
    for (const Outcome o : {Outcome::ok, Outcome::diverged, Outcome::not_converged})
        if (name == name_of(o)) return o;
    throw std::runtime_error("unknown status " + name);
}

}  // namespace jvari::bench::store
