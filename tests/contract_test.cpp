// What every scheme and reference owes the program: each test is one promise, asked on every scene that the scheme represents.
//
// JVARI_CONTRACT_PLUGINS=a.so:b.so asks it of the schemes of these plugins alone. What breaks a promise fails by its name:
// tests/contract_plugins has a scheme for each that breaks it and keeps all others. All promises stand in this one file, to be read as one
// list.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include "reference/references.hpp"
#include "scenes/modes.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"
#include "tests/allocations.hpp"
#include "tests/c3.hpp"
#include "tests/contract_scenes.hpp"

namespace jvari {

static void PrintTo(const Descriptor& d, std::ostream* out) {
    *out << d.name;
}

namespace {

std::vector<Descriptor> asked() {
    std::vector<Descriptor> all;
    const auto add = [&all](std::span<const Descriptor> table) { all.insert(all.end(), table.begin(), table.end()); };
    if (const char* plugins = std::getenv("JVARI_CONTRACT_PLUGINS")) {
        std::istringstream paths(plugins);
        for (std::string path; std::getline(paths, path, ':');)
            if (!path.empty()) add(load_plugin(path).schemes());
    } else {
        add(schemes());
        add(references());
    }
    return all;
}

bool represents(const Descriptor& d, const Scene& scene) {
    return (needed_by(scene) - d.represents).empty();
}

Settings settings_for(const Descriptor& d, const Scene& scene) {
    Settings s{4 * contract_tap_rate, contract_tap_rate, contract_modes, {}};
    if (d.clock == Clock::continuous && needed_by(scene).has(Feature::profile_barrier) && declares(d, "nodes"))
        s.options = {{"nodes", "6"}};  // points on the profile: what is owed does not depend on them
    return s;
}

struct Case {
    Descriptor scheme;
    Scene scene;
    Settings settings;
    friend void PrintTo(const Case& c, std::ostream* out) { *out << c.scheme.name << " on " << c.scene.name; }
};
Case case_of(const Descriptor& d, const Scene& scene) {
    return {d, scene, settings_for(d, scene)};
}

std::vector<Case> cases(bool represented) {
    std::vector<Case> chosen;
    for (const Descriptor& d : asked())
        for (const Scene& scene : contract_scenes())
            if (represents(d, scene) == represented) chosen.push_back(case_of(d, scene));
    return chosen;
}

// The scheme, or nothing where it refuses the scene for a reason of its own (a missing option, a grid).
std::unique_ptr<Scheme> make(const Case& c) {
    try {
        return make_scheme(c.scheme, c.scene, c.settings);
    } catch (const Refusal& refusal) {
        EXPECT_GT(std::string(refusal.what()).size(), 20u);
        return nullptr;
    } catch (const BadScene&) {  // one made here that cannot be
        return nullptr;
    }
}

class Refusals : public testing::TestWithParam<Case> {};

TEST_P(Refusals, NameWhatIsMissing) {
    const Case& c = GetParam();
    try {
        make_scheme(c.scheme, c.scene, c.settings);
        FAIL() << "not refused";
    } catch (const Refusal& refusal) {
        const std::string missing = names_of(needed_by(c.scene) - c.scheme.represents);
        EXPECT_NE(std::string(refusal.what()).find(missing), std::string::npos) << refusal.what();
    }
}

// ---- Of a scheme as a whole.

class Declared : public testing::TestWithParam<Descriptor> {};

// Settings at which a scheme may take a scene: as it is, then with each word of each of its options.
std::vector<Settings> ways(const Descriptor& d, const Scene& scene) {
    std::vector<Settings> all{settings_for(d, scene)};
    for (const Option& o : d.options)
        for (const char* word : o.words()) {
            all.push_back(all.front());
            all.back().options.emplace_back(o.name, word);
        }
    return all;
}

// Of these features those for which no scene and settings will do.
template <class Will>
Features without(Features asked_of, const Descriptor& d, Will will_do) {
    Features none;
    for (int k = 0; k < feature_count; ++k) {
        const auto feature = static_cast<Feature>(1u << k);
        if (!asked_of.has(feature)) continue;
        bool found = false;
        for (const Scene& scene : scenes_with(feature))
            for (const Settings& settings : ways(d, scene))
                found = found || (represents(d, scene) && make({d, scene, settings}) && will_do(Case{d, scene, settings}, feature));
        if (!found) none = none | feature;
    }
    return none;
}
Features always_refused(const Descriptor& d) {
    return without(d.represents, d, [](const Case&, Feature) { return true; });
}

TEST_P(Declared, ItRunsAScene) {
    EXPECT_EQ(names_of(always_refused(GetParam())), "") << "it declares these features and refuses every scene that needs them";
}

bool tells_apart(const Case& c, Feature feature, long rows) {
    Scene scene = c.scene;
    scene.duration = static_cast<double>(rows) / contract_tap_rate;
    const auto trace_of = [&c](const Scene& s) {
        try {
            return run(c.scheme, s, c.settings).trace;
        } catch (const std::runtime_error&) {  // refused, or no scene
            return Trace{};
        }
    };
    const Trace one = trace_of(scene);
    for (const Scene& changed : otherwise(scene, feature)) {
        const Trace other = trace_of(changed);
        for (int k = 0; k < std::min(one.taps(), other.taps()); ++k) {
            double largest = 0, difference = 0;
            for (long n = 0; n < std::min(one.rows, other.rows); ++n) {
                largest = std::max(largest, std::abs(one.column(k)[n]));
                difference = std::max(difference, std::abs(one.column(k)[n] - other.column(k)[n]));
            }
            if (difference > 1e-9 * largest) return true;
        }
    }
    return false;
}

TEST_P(Declared, ItHeedsEveryFeatureThatItDoesNotCallApproximated) {
    const Descriptor& d = GetParam();
    Features left = d.represents - approximated(d) - always_refused(d);  // what is always refused is another promise
    left =
        without(left, d, [](const Case& c, Feature f) { return tells_apart(c, f, contract_rows) || tells_apart(c, f, 5 * contract_rows); });
    EXPECT_EQ(names_of(left), "") << "what it does is the same whatever their values";
}

// ---- Of a scheme on a scene.

class Contract : public testing::TestWithParam<Case> {
protected:
    const Case& c = GetParam();
    std::unique_ptr<Scheme> scheme;
    void SetUp() override {
        scheme = make(c);
        if (!scheme) GTEST_SKIP();
    }
    jvari::Run fresh(const RunOptions& options) const {
        return run(*make_scheme(c.scheme, c.scene, c.settings), c.scene, c.settings, options);
    }
};

bool same_bits(const Trace& a, const Trace& b, long rows) {
    bool same = a.taps() == b.taps();
    for (int k = 0; same && k < a.taps(); ++k) same = std::memcmp(a.column(k).data(), b.column(k).data(), rows * sizeof(double)) == 0;
    return same;
}

TEST_P(Contract, AllocatesNothingWhileStepping) {
    const int taps = static_cast<int>(c.scene.taps.size());
    std::vector<double> tap(64 * taps), energy(64 * 3);
    scheme->reset();
    const Allocations allocations;
    scheme->advance({64, taps, 64, tap.data(), nullptr});
    scheme->advance({64, taps, 64, tap.data(), energy.data()});
    scheme->reset();
    EXPECT_EQ(allocations.count(), 0);
}

TEST_P(Contract, GivesNumbersToTheLastRow) {
    const jvari::Run r = fresh({.energy = c.scheme.balance != Balance::none});
    ASSERT_GT(r.trace.rows, 0);
    const auto touched = [](const String& s) { return !s.barriers.empty(); };
    if (c.scheme.balance == Balance::none && std::any_of(c.scene.strings.begin(), c.scene.strings.end(), touched))
        return;  // it may diverge
    EXPECT_EQ(r.status.outcome, Outcome::ok) << name_of(r.status.outcome) << " at step " << r.status.step;
    EXPECT_EQ(r.trace.rows, r.trace.stride);
}

TEST_P(Contract, GivesTheSameBitsWhateverTheBlockSize) {
    const jvari::Run first = fresh({.block_rows = 64});
    for (const int rows : {1, 7, 1000}) {
        const jvari::Run again = fresh({.block_rows = rows});
        EXPECT_EQ(again.trace.rows, first.trace.rows) << rows << " rows a block";
        EXPECT_TRUE(same_bits(first.trace, again.trace, std::min(first.trace.rows, again.trace.rows))) << rows << " rows a block";
    }
}

TEST_P(Contract, GivesTheSameBitsWithItsEnergyProbed) {
    const jvari::Run bare = fresh({}), probed = fresh({.energy = true});
    if (c.scheme.balance != Balance::none) {
        EXPECT_EQ(probed.trace.rows, bare.trace.rows);
    }
    EXPECT_TRUE(same_bits(bare.trace, probed.trace, std::min(bare.trace.rows, probed.trace.rows)));
}

TEST_P(Contract, StartsAnewAfterAReset) {
    const jvari::Run first = run(*scheme, c.scene, c.settings, {.energy = true}),
                     again = run(*scheme, c.scene, c.settings, {.energy = true});
    EXPECT_EQ(again.trace.rows, first.trace.rows);
    EXPECT_TRUE(same_bits(first.trace, again.trace, std::min(first.trace.rows, again.trace.rows)));
    EXPECT_EQ(std::memcmp(first.trace.energy.data(), again.trace.energy.data(), first.trace.energy.size() * sizeof(double)), 0);
}

struct Ledger {
    std::vector<double> residual, stored, dissipated;
    double scale = 1e-30;  // [J]
};
Ledger ledger_of(const Trace& t) {
    Ledger l;
    const auto stored = t.energy_column(0), supplied = t.energy_column(1), dissipated = t.energy_column(2);
    for (long n = 0; n < t.rows; ++n) {
        l.scale = std::max(l.scale, stored[n]);
        l.residual.push_back(n == 0 ? supplied[0] + dissipated[0] : stored[n] - stored[n - 1] - supplied[n] + dissipated[n]);
    }
    l.stored.assign(stored.begin(), stored.begin() + t.rows);
    l.dissipated.assign(dissipated.begin(), dissipated.begin() + t.rows);
    return l;
}
double row_bound(Balance b) {
    return b == Balance::exact ? 1e-11 : 1e-8;
}

TEST_P(Contract, KeepsItsEnergyLedgerInEveryRow) {
    if (c.scheme.balance == Balance::none) GTEST_SKIP();
    const Ledger l = ledger_of(fresh({.energy = true}).trace);
    double worst = 0;
    for (const double r : l.residual) worst = std::max(worst, std::abs(r));
    EXPECT_LE(worst, row_bound(c.scheme.balance) * l.scale);
}

TEST_P(Contract, KeepsItsEnergyLedgerInSum) {
    if (c.scheme.balance == Balance::none) GTEST_SKIP();
    const Ledger l = ledger_of(fresh({.energy = true}).trace);
    double sum = 0, worst = 0;
    for (const double r : l.residual) worst = std::max(worst, std::abs(sum += r));
    EXPECT_LE(worst, 10 * row_bound(c.scheme.balance) * l.scale);
}

TEST_P(Contract, StoresNoNegativeEnergyAndDissipates) {
    if (c.scheme.balance == Balance::none) GTEST_SKIP();
    const Ledger l = ledger_of(fresh({.energy = true}).trace);
    const double bound = row_bound(c.scheme.balance) * l.scale;
    EXPECT_GE(*std::min_element(l.stored.begin(), l.stored.end()), -bound);
    if (needed_by(c.scene).has(Feature::profile_barrier) && c.scheme.balance == Balance::to_tolerance)
        GTEST_SKIP();  // a rigid-profile rule may give energy; its scheme reports how much
    EXPECT_GE(*std::min_element(l.dissipated.begin(), l.dissipated.end()), -bound);
}

TEST_P(Contract, StartsFromTheScenesShape) {
    Scene scene = c.scene;
    scene.duration = 1 / contract_tap_rate;
    scene.taps.clear();
    std::vector<double> expected, scale;
    for (std::size_t k = 0; k < scene.strings.size(); ++k) {
        String s = scene.strings[k];
        s.damping = NoDamping{};
        const Modes all = modes_of(s, 2000);
        const auto shape = initial_displacement(all, s);
        for (const double x : {0.1, 0.25, 0.4, 0.5, 0.7, 0.9}) {
            scene.taps.push_back({"y" + std::to_string(scene.taps.size()), Quantity::displacement, static_cast<int>(k), x * s.length});
            const auto w = displacement_weights(all, x * s.length);
            double y = 0;
            for (std::size_t i = 0; i < w.size(); ++i) y += w[i] * shape[i];
            expected.push_back(y);
            scale.push_back(s.initial ? std::visit([](const auto& i) { return std::abs(i.amplitude); }, *s.initial) : 0);
        }
    }
    const jvari::Run r = run(*make_scheme(c.scheme, scene, c.settings), scene, c.settings);
    for (std::size_t k = 0; k < expected.size(); ++k) {
        EXPECT_NEAR(r.trace.column(static_cast<int>(k))[0], expected[k], 0.02 * scale[k]) << scene.taps[k].position << " m";
    }
}

TEST_P(Contract, StartsWithoutContactForces) {
    const jvari::Run r = fresh({});
    for (int k = 0; r.trace.rows > 0 && k < r.trace.taps(); ++k) {
        const Quantity q = c.scene.taps[k].quantity;
        const bool contact_force = q == Quantity::bridge_force || q == Quantity::thread_force || q == Quantity::driving_force;
        if (contact_force || !needed_by(c.scene).has(Feature::initial_shape)) {
            EXPECT_EQ(r.trace.column(k)[0], 0) << r.trace.names[k];
        }
    }
}

// Displacement and velocity of each mode, or of each node of a grid, whose spacing no wave passes within a step; then a value for each
// contact, and a few for a filter at an end. A second plane has as many again.
int most_state(const Case& c, bool sized_by_modes) {
    double most = 0;
    for (const String& s : c.scene.strings) {
        const double speed = std::sqrt(s.tension / s.linear_density);
        const double nodes = sized_by_modes ? contract_modes : std::ceil(s.length * c.settings.sample_rate / speed);
        double contacts = 0;
        for (const Barrier& b : s.barriers) {
            const auto* profile = std::get_if<ProfileBarrier>(&b);
            contacts += profile ? std::ceil(nodes * (profile->to - profile->from) / s.length) : 1;
        }
        constexpr int at_an_end = 6;
        most += (2 * nodes + contacts + at_an_end) * (s.polarisation ? 2 : 1);
    }
    return static_cast<int>(most);
}

TEST_P(Contract, CarriesNoMoreStateThanTheSceneNeeds) {
    EXPECT_GT(scheme->dofs(), 0);
    Case more = c;
    more.settings.modes = 2 * contract_modes;
    const auto larger = make(more);
    EXPECT_LE(scheme->dofs(), most_state(c, larger && larger->dofs() > scheme->dofs()));
    Case bare = c;  // without what it listens to, is struck by and rests on
    bare.scene.taps.resize(1);
    for (String& s : bare.scene.strings) {
        s.pluck.reset();
        s.thread.reset();
        s.barriers.clear();
        s.polarisation.reset();
    }
    std::erase_if(bare.scene.taps, [](const Tap& t) { return t.quantity != Quantity::displacement && t.quantity != Quantity::nut_force; });
    if (const auto other = make(bare)) {
        EXPECT_LE(other->dofs(), scheme->dofs());
    }
    Case quiet = c;
    quiet.scene.taps.resize(1);
    if (const auto other = make(quiet)) {
        EXPECT_EQ(other->dofs(), scheme->dofs());
    }
}

const auto name_of_case = [](const testing::TestParamInfo<Case>& c) {
    return std::string(c.param.scheme.name) + "__" + c.param.scene.name;
};
INSTANTIATE_TEST_SUITE_P(All, Refusals, testing::ValuesIn(cases(false)), name_of_case);
INSTANTIATE_TEST_SUITE_P(All, Contract, testing::ValuesIn(cases(true)), name_of_case);
INSTANTIATE_TEST_SUITE_P(All, Declared, testing::ValuesIn(asked()),
                         [](const testing::TestParamInfo<Descriptor>& d) { return std::string(d.param.name); });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Contract);

TEST(Allocations, AreCounted) {
    const Allocations allocations;
    const std::vector<Scene> scenes(1);
    EXPECT_GT(allocations.count(), 0);
}

}  // namespace
}  // namespace jvari
