// Helpers for tests of references: the distance between two columns, and a fact by its name.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <string>

#include "schemes/run.hpp"

namespace jvari {

inline double relative_l2(std::span<const double> got, std::span<const double> want) {
    double difference = 0, norm = 0;
    for (std::size_t n = 0; n < want.size(); ++n) {
        difference += (got[n] - want[n]) * (got[n] - want[n]);
        norm += want[n] * want[n];
    }
    return std::sqrt(difference / norm);
}

inline double fact(const Run& r, const std::string& name) {
    for (const Fact& f : r.facts)
        if (f.name == name) return f.value;
    ADD_FAILURE() << "no fact " << name;
    return 0;
}

}  // namespace jvari
