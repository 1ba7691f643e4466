// Two folders of results: what changed from one to the other, number by number (rules.hpp) and by
// the clock (costs.hpp).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bench/diff/folder.hpp"
#include "bench/diff/rules.hpp"

namespace jvari::bench::diff {

struct Finding {
    Turn turn;
    std::string row;     // what names it: "tanpura_c3_release modal_two_point 44100 Hz"
    std::string column;  // "error_l2_50ms", "cost_s_per_s", "outcome"
    std::string before, after;
    // what the numbers do not say; of a cost: how many times, and of how many cells
    std::string detail;
};

struct Only {  // what one of the folders has alone
    std::vector<std::string> before, after;
};

struct Difference {
    // of what both have; those of a row stand together, headline columns first
    std::vector<Finding> findings;
    Only cells, columns, points, boundaries, modes;
    std::vector<std::pair<const char*, const Only*>> alone() const {  // each kind by its name
        return {{"cells", &cells},
                {"columns", &columns},
                {"modes", &modes},
                {"points", &points},
                {"boundaries", &boundaries}};
    }
    std::string references;          // that they are others, and how; "": they are the same
    std::vector<std::string> notes;  // what could not be compared, and why
    int cells_in_both = 0;
    int to_the_last_digit = 0;  // cells of these, all fields but costs
    int compared = 0;           // fields

    int count(Turn) const;
    int missing() const;  // cells, points and modes that are no longer there
    bool worse() const { return count(Turn::worse) > 0 || missing() > 0; }
    bool nothing() const;  // no finding, and nothing that one has alone
};

// Throws UsageError where no row is in both.
Difference difference(const Folder& before, const Folder& after);

// of each kind
std::string text_of(const Difference&, const Folder& before, const Folder& after,
                    std::size_t most_lines = 20);
std::string json_of(const Difference&, const Folder& before, const Folder& after);

}  // namespace jvari::bench::diff
