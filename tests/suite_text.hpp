// Suites as text: the message that reading one gives, and what one spreads out to.
#pragma once

#include <string>
#include <vector>

#include "bench/compare/catalogue.hpp"
#include "bench/study/cells.hpp"
#include "bench/study/run.hpp"
#include "bench/suite/suite.hpp"
#include "scenes/scene_file.hpp"

namespace jvari::test {

inline std::string refusal_of(const std::string& text) {
    try {
        bench::suite::parse_suite(text, "a.toml");
    } catch (const SceneFileError& e) { return e.what(); }
    return "read";
}

struct Read {
    bench::suite::Suite suite;
};
// the jobs of a suite, which point into it; nothing that runs is kept
struct Planned : Read, bench::study::Plan {
    explicit Planned(const std::string& text,
                     const bench::compare::Catalogue& schemes = bench::compare::Catalogue())
        : Read{bench::suite::parse_suite(text, "a.toml")},
          Plan(bench::suite::plan_of(suite.sets, schemes, {})) {}
    Planned(const Planned&) = delete;
    Planned& operator=(const Planned&) = delete;

    bench::study::Study run(int processes = 1) const {
        return bench::study::run(*this, "", false, processes, bench::store::Listener());
    }
};

}  // namespace jvari::test
