// Plugins that break the contract, for the tests of the command line: one table of schemes that
// throw, make nothing or report what cannot be, and, by JVARI_BAD_TABLE in the environment of the
// program, tables that are none.
#include <cstdlib>
#include <stdexcept>

#include "schemes/plugin.hpp"

namespace {
using namespace jvari;

enum class Fault {
    none,
    throws_in_facts,
    throws_a_number_in_facts,
    unknown_outcome,
    step_before_the_start
};

template <Fault fault>
class Bad final : public Scheme {
public:
    void reset() noexcept override {}
    Status advance(const Block& out) noexcept override {
        for (int k = 0; k < out.taps; ++k)
            for (int row = 0; row < out.rows; ++row) out.tap[row + k * out.stride] = 1;
        for (int k = 0; k < 3 && out.energy; ++k)
            for (int row = 0; row < out.rows; ++row) out.energy[row + k * out.stride] = k == 0;
        if (fault == Fault::unknown_outcome) return {static_cast<Outcome>(77), 0};
        if (fault == Fault::step_before_the_start) return {Outcome::diverged, -1000000};
        return {};
    }
    int dofs() const override { return 1; }
    std::vector<Fact> facts() const override {
        if (fault == Fault::throws_in_facts) throw std::runtime_error("no facts today");
        if (fault == Fault::throws_a_number_in_facts) throw 42;
        return {};
    }
};

template <Fault fault>
std::unique_ptr<Scheme> make(const Descriptor&, const Scene&, const Settings&) {
    return std::make_unique<Bad<fault>>();
}

constexpr Features all = Features(Feature::bending_stiffness) | Feature::damping |
                         Feature::frequency_dependent_damping | Feature::initial_shape;
constexpr auto stepped = Clock::stepped;

const Descriptor table[] = {
    {"bad_throws", "a test", all, Balance::none, stepped,
     [](const Descriptor&, const Scene&, const Settings&) -> std::unique_ptr<Scheme> {
         throw std::runtime_error("not made today");
     }},
    {"bad_throws_a_number", "a test", all, Balance::none, stepped,
     [](const Descriptor&, const Scene&, const Settings&) -> std::unique_ptr<Scheme> { throw 42; }},
    {"bad_makes_nothing", "a test", all, Balance::none, stepped,
     [](const Descriptor&, const Scene&, const Settings&) -> std::unique_ptr<Scheme> {
         return nullptr;
     }},
    {"bad_facts", "a test", all, Balance::none, stepped, make<Fault::throws_in_facts>},
    {"bad_facts_of_a_number", "a test", all, Balance::none, stepped,
     make<Fault::throws_a_number_in_facts>},
    {"bad_outcome", "a test", all, Balance::none, stepped, make<Fault::unknown_outcome>},
    {"bad_step", "a test", all, Balance::none, stepped, make<Fault::step_before_the_start>},
};
const Descriptor nameless[] = {{nullptr, "a test", all, Balance::none, stepped, make<Fault::none>}};
const Descriptor sourceless[] = {
    {"bad_sourceless", nullptr, all, Balance::none, stepped, make<Fault::none>}};
const Descriptor makeless[] = {{"bad_makeless", "a test", all, Balance::none, stepped, nullptr}};
}  // namespace

JVARI_EXPORT const jvari_plugin* jvari_schemes(void) {
    const char* variable = std::getenv("JVARI_BAD_TABLE");
    const int kind = variable ? std::atoi(variable) : 0;
    static const jvari_plugin none = {
        sizeof none, JVARI_SCHEME_VERSION, nullptr, kind == 1 ? 3 : -1, "none", "none", 1};
    if (kind == 1 || kind == 2) return &none;
    const std::span<const Descriptor> all[] = {table, {}, {}, nameless, sourceless, makeless};
    static const plugin::Tables tables(all[kind], plugin::compiled_with().c_str(),
                                       plugin::optimised);
    return &tables.table();
}
