// A scene's problem as JSON, for scripts: the arrays of schemes/open/jvari_scheme.h under the same
// names, and the reference trace with what it is known to. docs/own-scheme/README.md has shape,
// unit and equation of each.
#pragma once

#include <string>

#include "bench/compare/compare.hpp"
#include "bench/study/truth.hpp"

namespace jvari::bench::judge {

struct Exported {
    Scene scene;
    Settings settings;
};
// Of request.rates.front(), its modes and its tap rate. Throws UsageError, Refusal, BadScene.
Exported exported(const compare::CompareRequest&);

study::Truth reference_of(const compare::CompareRequest&, const Exported&,
                          const compare::Catalogue&, const store::Listener&);

std::string problem_json(const Exported&, const study::Truth*);  // nullptr: without a reference

}  // namespace jvari::bench::judge
