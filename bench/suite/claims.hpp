// Does what a paper says hold? The verdicts on a suite's claims, computed from the tables of a folder of its results.
#pragma once

#include <filesystem>

#include "bench/store/records.hpp"
#include "bench/suite/suite_file.hpp"

namespace jvari::bench::suite {

inline constexpr const char* claims_file = "claims.csv";

// Columns claim, place, verdict, measured, uncertainty, unit, expected, rests_on, note; a row for each claim.
//
// A claim holds if its number, give or take its uncertainty, lies within the limits for each set of rows, and does not hold if it lies
// outside for one. Where the uncertainty spans a limit, or is unknown, or a number is missing, it cannot be told. The row shows the number
// that is nearest to failing, and what its uncertainty rests on: the reference's certificate of an error, the quartiles of a cost, the 95 %
// interval of a slope, what the claim states. The number of a run's own rows is exact: a claim on it is about this run.
store::Table verdicts_on(const std::vector<Claim>&, const std::filesystem::path& folder);

// The claims on a folder: of the suite that is named in its manifest, from its own copy (suite.toml) or from the library. Throws
// UsageError.
std::vector<Claim> claims_on(const std::filesystem::path& folder);

std::string claims_summary(const store::Table& verdicts);  // "12 claims: 9 hold, 1 does not hold, ..."

}  // namespace jvari::bench::suite
