// A statement of a paper, and what of a suite's tables it is held against: [[claim]] of a suite file. claims.hpp computes the verdict.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/store/keys.hpp"
#include "bench/suite/reduce.hpp"

namespace jvari::bench::suite {

using Where = std::vector<std::pair<std::string, std::string>>;  // column, value; "": the rows whose field is empty

struct Pick {                                // one number from the rows of a table that carry certain values
    std::string table, column, along;        // along: the column that orders the rows and that from and to are of
    double from = -HUGE_VAL, to = HUGE_VAL;  // of `along`
    const Take* take = takes().data();
    Where where, own;  // own: of another number, what it says itself, whatever `each` says
};

struct Claim {
    std::string says, place;                    // the statement, and where it stands
    std::optional<Pick> measured;               // none: nothing is measured, and `open` says why
    std::optional<Pick> against, minus, over;   // other rows: row by row, then of the numbers, then the ratio
    std::vector<Where> each{{}};                // held for each of these rows
    double least = -HUGE_VAL, most = HUGE_VAL;  // of the number, if the claim holds
    double uncertainty = 0;                     // of the number, beside what the tables know of theirs
    std::string unit, open, note;               // open: why it cannot be told, whatever is measured
};

store::Kind<std::vector<Claim>> claims();

}  // namespace jvari::bench::suite
