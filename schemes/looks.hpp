// Chooses the rows at which a run's energy is evaluated: one in `rows_between_looks`, and the last
// two. Evaluating the energy costs about the same time that many steps cost. While a pluck supplies
// energy, some `samples` rows measure the supplied energy, and each stands for the rows up to the
// next sample. The rows follow from the scene alone, so that the verdict on a run depends neither
// on the caller's energy probe nor on the block size.
#pragma once

#include <algorithm>
#include <vector>

#include "scenes/scene.hpp"

namespace jvari {

constexpr long rows_between_looks = 256;

struct Look {
    bool now;    // at this row
    long until;  // first later row for which the answer may differ
};

class Looks {
public:
    Looks(const Scene& scene, double tap_rate, long rows) : rows_(rows) {
        const auto row = [&](double seconds) {
            return static_cast<long>(
                std::clamp(seconds * tap_rate, 0.0, static_cast<double>(rows)));
        };
        // a row reports the energy supplied since the previous row
        for (const String& s : scene.strings)
            if (s.pluck)
                plucks_.push_back({row(s.pluck->start) - 1,
                                   std::min(row(s.pluck->start + s.pluck->duration) + 3, rows)});
        std::sort(plucks_.begin(), plucks_.end(),
                  [](const Pluck& a, const Pluck& b) { return a.from < b.from; });
        for (std::size_t k = 1; k < plucks_.size();)
            if (plucks_[k].from > plucks_[k - 1].to) ++k;
            else
                plucks_[k - 1].to = std::max(plucks_[k - 1].to, plucks_[k].to),
                            plucks_.erase(plucks_.begin() + static_cast<long>(k));
    }
    Look at(long row) const {
        if (row == 0) return {true, 1};
        if (row + 2 >= rows_) return {true, rows_};
        const long until = std::min(next_pluck(row), rows_ - 2);
        if (const Pluck* p = pluck_at(row)) {
            if (p->each() == 1) return {true, p->to};
            const long after = (row - p->from) % p->each();
            // Two rows, because the first one does not know the energy supplied before it.
            if (after < 2) return {true, std::min(row - after + 2, p->to)};
            return {false, std::min({row - after + p->each(), p->to, until})};
        }
        if (row % rows_between_looks == 0) return {true, row + 1};
        return {false, std::min(row - row % rows_between_looks + rows_between_looks, until)};
    }
    // Number of rows for which this row reports the supplied energy. 0: not even for itself, and
    // its energy is not judged.
    long stands_for(long row) const {
        const Pluck* p = pluck_at(row);
        return !p || p->each() == 1 || row + 1 == rows_ ? 1
               : (row - p->from) % p->each() == 1       ? p->each()
                                                        : 0;
    }
    // Rows that report all the supplied energy, and each row's energy from `since` on.
    Look back_at(long row, long since) const {
        if (row >= since) return {true, rows_};
        if (row == 0) return {true, 1};
        if (const Pluck* p = pluck_at(row)) return {true, std::min(p->to, since)};
        return {false, std::min(next_pluck(row), since)};
    }

private:
    static constexpr long samples = 64;
    struct Pluck {  // range of rows, without its last
        long from, to;
        long each() const { return to - from < 4 * samples ? 1 : (to - from) / samples; }
    };
    const Pluck* pluck_at(long row) const {
        for (const Pluck& p : plucks_)
            if (row >= p.from && row < p.to) return &p;
        return nullptr;
    }
    long next_pluck(long row) const {
        for (const Pluck& p : plucks_)
            if (p.from > row) return p.from;
        return rows_;
    }

    long rows_;
    std::vector<Pluck> plucks_;  // one after the other
};

}  // namespace jvari
