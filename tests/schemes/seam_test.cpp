// What the seam declares of every scheme and reference is what they do: options, facts,
// approximated features.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "reference/references.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/making.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"
#include "tests/runs.hpp"

namespace jvari {
namespace {

constexpr double row_rate = 44100;

const std::vector<Scene>& library() {  // and what it lacks
    static const std::vector<Scene> scenes = [] {
        std::vector<Scene> all;
        for (const std::string& name : library_scenes()) {
            all.push_back(read_scene(name));
            all.back().duration = 20 / row_rate;
        }
        // each string that is not stiff once with stiffness, which the library's sitars lack
        for (std::size_t i = all.size(); i-- > 0;)
            if (Scene s = all[i]; s.strings.front().bending_stiffness == 0) {
                s.name += " with bending stiffness";
                s.strings.front().bending_stiffness = 1e-6;
                all.push_back(std::move(s));
            }
        all.push_back(read_scene("two_point_bridge", {"string.0.barrier.0.exponent=1",
                                                      "string.0.barrier.0.stiffness=rigid"}));
        all.back().duration = 20 / row_rate;
        return all;
    }();
    return scenes;
}

Settings settings_for(OptionValues options) {
    return {4 * row_rate, row_rate, 40, std::move(options)};
}

// The options that tests run by default: few points for a profile, since what is declared does not
// depend on how many.
OptionValues quick(const Descriptor& d) {
    return declares(d, "nodes") ? OptionValues{{"nodes", "6"}} : OptionValues{};
}

// Every combination of the words that the scheme's options take.
std::vector<OptionValues> combinations(const Descriptor& d) {
    std::vector<OptionValues> all{quick(d)};
    for (const Option& o : d.options) {
        std::vector<OptionValues> longer;
        for (const OptionValues& chosen : all)
            for (const char* word : o.words()) {
                longer.push_back(chosen);
                longer.back().emplace_back(o.name, word);
            }
        if (!longer.empty()) all = std::move(longer);
    }
    return all;
}

// What a run comes to, to the last bit, or why there is none.
std::pair<std::vector<double>, std::string> result_of(const Descriptor& d, const Scene& scene,
                                                      const OptionValues& options) {
    try {
        return {run(d, scene, settings_for(options)).trace.tap, ""};
    } catch (const Refusal& refusal) { return {{}, refusal.what()}; }
}

TEST(Options, TheDeclaredDefaultIsWhatTheSchemeDoesUntold) {
    for (const Descriptor* d : all_descriptors())
        for (const Option& o : d->options) {
            // 32 points on every profile are too slow here
            if (!*o.fallback || std::string(o.name) == "nodes") continue;
            const auto scene = std::find_if(library().begin(), library().end(),
                                            [d](const Scene& s) { return represents(*d, s); });
            ASSERT_NE(scene, library().end()) << d->name;
            EXPECT_EQ(result_of(*d, *scene, {{o.name, o.fallback}}), result_of(*d, *scene, {}))
                << d->name << " " << o.name;
        }
}

TEST(Options, EveryDeclaredOneIsAcceptedWithEachOfItsWords) {
    for (const Descriptor* d : all_descriptors())
        for (const Option& o : d->options) {
            EXPECT_TRUE(*o.meaning) << d->name << " " << o.name;
            std::vector<std::string> values(o.words().begin(), o.words().end());
            if (values.empty()) values.emplace_back(*o.fallback ? o.fallback : "7");
            for (const std::string& value : values)
                for (const Scene& scene : library()) {
                    if (!represents(*d, scene) || std::string(o.name) == "nodes") continue;
                    const std::string reason = result_of(*d, scene, {{o.name, value}}).second;
                    EXPECT_EQ(reason.find("unknown option"), std::string::npos)
                        << d->name << ": " << reason;
                    EXPECT_EQ(reason.find("expected one of"), std::string::npos)
                        << d->name << ": " << reason;
                    EXPECT_EQ(reason.find("expected a number"), std::string::npos)
                        << d->name << ": " << reason;
                    break;
                }
        }
}

TEST(Options, OneThatIsUndeclaredOrGivenTwiceIsRefusedBeforeTheSchemeIsAsked) {
    static bool called;
    called = false;
    Descriptor careless = schemes()[0];
    careless.make = [](const Descriptor&, const Scene&,
                       const Settings&) -> std::unique_ptr<Scheme> {
        called = true;
        return nullptr;
    };
    const auto scene =
        std::find_if(library().begin(), library().end(),
                     [&careless](const Scene& s) { return represents(careless, s); });
    ASSERT_NE(scene, library().end());
    EXPECT_THROW(make_scheme(careless, *scene, settings_for({{"no_such_option", "1"}})), BadOption);
    EXPECT_FALSE(called);
    constexpr static Option word{"word", "a", "for the test", {"a", "b"}};
    careless.options = {&word, 1};
    EXPECT_THROW(make_scheme(careless, *scene, settings_for({{"word", "c"}})), Refusal);
    for (const char* second : {"a", "b"})
        EXPECT_THROW(make_scheme(careless, *scene, settings_for({{"word", "a"}, {"word", second}})),
                     BadOption);
    EXPECT_FALSE(called);
    // asked, it makes nothing
    EXPECT_THROW(make_scheme(careless, *scene, settings_for({{"word", "b"}})), BadScheme);
    EXPECT_TRUE(called);
}

TEST(Facts, EveryOneReportedOnAnySceneIsInTheTableAndEveryApproximatedFeatureIsReported) {
    std::map<std::string, std::string> unit;
    for (const FactName& f : facts::table)
        EXPECT_TRUE(unit.emplace(f.name, f.unit).second) << f.name << " twice";
    // scheme, fact of an approximation
    std::set<std::pair<std::string, std::string>> met, declared;
    for (const Descriptor* d : all_descriptors()) {
        for (const Approximation& a : d->approximates) {
            declared.emplace(d->name, a.fact.name);
            EXPECT_TRUE(d->represents.has(a.feature))
                << d->name << " approximates what it does not take: " << name_of(a.feature);
        }
        for (const Scene& scene : library()) {
            if (!represents(*d, scene)) continue;
            for (const OptionValues& options : combinations(*d)) {
                std::unique_ptr<Scheme> scheme;
                try {
                    scheme = make_scheme(*d, scene, settings_for(options));
                } catch (const Refusal&) { continue; }
                std::set<std::string> names;
                for (const Fact& f : scheme->facts()) {
                    std::string name = f.name;
                    // of one of several strings
                    if (name.starts_with("string.")) name = name.substr(name.find('.', 7) + 1);
                    names.insert(name);
                    ASSERT_TRUE(unit.contains(name))
                        << d->name << " on " << scene.name << ": " << name;
                    EXPECT_EQ(f.unit, unit[name]) << name;
                }
                Features owed;
                for (const Approximation& a : d->approximates)
                    if (needed_by(scene).has(a.feature)) owed = owed | a.feature;
                Features reported;
                for (const Approximation& a : d->approximates)
                    if (names.contains(a.fact.name))
                        reported = reported | a.feature, met.emplace(d->name, a.fact.name);
                EXPECT_TRUE((owed - reported).empty())
                    << d->name << " on " << scene.name << " says nothing of "
                    << names_of(owed - reported);
            }
        }
    }
    EXPECT_EQ(met, declared);  // no scene of the library: nothing would be tested
}

TEST(Limits, AreGivenWithAName) {
    for (const Descriptor* d : all_descriptors())
        EXPECT_EQ(d->limit.name == nullptr, d->limit.margin == nullptr) << d->name;
}

}  // namespace
}  // namespace jvari
