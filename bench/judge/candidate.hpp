// Traces of one scheme that another program ran, one for each of its sample rates, judged as
// `compare` judges schemes of its own.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bench/compare/compare.hpp"

namespace jvari::bench::judge {

struct Candidate {
    std::string name = "mine";                              // in tables and pictures
    std::map<double, std::shared_ptr<const Trace>> traces;  // by sample rate [Hz]
    // computing time per second of sound, as reported; none: not known
    std::map<double, double> costs;
    // of its files: what its results depend on
    std::string contents;
};

// The rows that traces are compared on [Hz], and how many they are: 44100 where it divides all
// rates, else the lowest.
struct Rows {
    double rate;
    long count;
};
Rows rows_for(const compare::CompareRequest&, const Scene&);

// The request's schemes run beside the candidate, at its rates. Throws as compare does; UsageError
// for a name that is taken.
compare::Comparison judge(Candidate, compare::CompareRequest,
                          const std::vector<std::string>& plugins, const store::Listener&,
                          study::Kept&);

bool is_candidate(const study::Cell&);  // a cell of the trace that is judged
// in words: of each rate, against what ran beside it, and the observed order
std::string verdict_of(const compare::Comparison&);

}  // namespace jvari::bench::judge
