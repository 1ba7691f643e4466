// Whatever bytes come, a suite is read or refused with SceneFileError or UsageError; what is read
// can be spread out to its points.
#include "bench/suite/suite.hpp"
#include "bench/store/usage.hpp"
#include "fuzz.hpp"
#include "scenes/scene_file.hpp"

using namespace jvari;
using namespace jvari::test;

namespace {
double points_in(const bench::suite::CellSet& set) {
    double n = static_cast<double>(set.scenes.size() * set.modes.size());
    for (const bench::suite::SweptKey& k : set.sweep) n *= static_cast<double>(k.values.size());
    for (const bench::suite::VariedOption& o : set.varied)
        n *= static_cast<double>(o.values.size());
    return n;
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const bench::suite::Suite suite =
            bench::suite::parse_suite(test::text_of(data, size), "no_such_directory/suite.toml");
        ++inputs_read;
        for (const auto* sets : {&suite.sets, &suite.maps}) {
            double points = 0;
            for (const bench::suite::CellSet& set : *sets) points += points_in(set);
            // a valid suite may ask for more than there is memory
            if (points < 1000) bench::suite::points_of(*sets);
        }
    } catch (const SceneFileError&) {
    } catch (const bench::store::UsageError&) {}
    return 0;
}
