// Splits an interval into parts with a smooth pluck force: before the pluck, between two rows in
// its file or from start to end, and after the pluck.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "scenes/scene.hpp"

namespace jvari {

class PluckParts {
public:
    explicit PluckParts(const std::optional<Pluck>& pluck) {
        if (!pluck) return;
        start_ = pluck->start;
        knots_ = {0, pluck->duration};
        if (!pluck->time.empty()) knots_.clear();
        for (const double t : pluck->time) knots_.push_back(t - start_);
    }
    // Calls part(from, to, plucked) for each part of the interval that begins at `now` [s] and runs
    // from 0 to `length`; in seconds it lasts `unit` times longer. Returns false if any call does.
    template <class Part>
    bool each(double now, double length, double unit, Part part) const {
        double from = 0;
        auto k = std::upper_bound(knots_.begin(), knots_.end(), now - start_);
        for (; from < length; ++k) {
            const bool plucked = k != knots_.begin() && k != knots_.end();
            const double to =
                k == knots_.end() ? length : std::clamp((start_ - now + *k) / unit, 0.0, length);
            if (to > from && !part(from, to, plucked)) return false;
            from = to;
            if (k == knots_.end()) break;
        }
        return true;
    }

private:
    double start_ = 0;
    std::vector<double> knots_;  // after the start [s]
};

}  // namespace jvari
