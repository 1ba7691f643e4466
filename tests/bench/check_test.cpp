// jvari check: what it says and writes. That it finds each broken promise by its name is asked by
// tests/contract_plugins/check.sh.
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "tests/command_line.hpp"

namespace jvari::test {
namespace {

using Json = nlohmann::ordered_json;

int count(const std::string& text, const std::string& word) {
    int n = 0;
    for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++n;
    return n;
}

TEST(Check, ASchemeOfTheTreeKeepsWhatItPromises) {
    const Scratch scratch;
    const Ended o = jvari(scratch, "check modal_two_point --json --quiet");
    EXPECT_EQ(o.code, 0) << o.out << o.err;
    const Json j = Json::parse(o.out);
    EXPECT_EQ(j["status"], "kept");
    int kept = 0, allocations = 0, claims = 0;
    for (const Json& a : j["schemes"][0]["answers"]) {
        kept += a["answer"] == "kept";
        allocations += a["answer"] == "kept" && a["promise"] == "AllocatesNothingWhileStepping";
        claims += a["answer"] == "kept" && (a["promise"] == "ConvergesToTheReference" ||
                                            a["promise"] == "StaysSoundOverAMap" ||
                                            a["promise"] == "PartialsAreWhereItsOwnRelationSays");
    }
    EXPECT_GT(kept, 100);
    EXPECT_GT(allocations, 5);
    EXPECT_EQ(claims, 3);
}

TEST(Check, ExcusesAKnownBreachByNameAndSaysSo) {
    const Scratch scratch;
    const Ended o = jvari(scratch, "check modal_generalised_alpha");
    EXPECT_EQ(o.code, 0) << o.out << o.err;
    EXPECT_TRUE(std::regex_search(
        o.out, std::regex("excused    CarriesNoMoreStateThanTheSceneNeeds .*acceleration")))
        << o.out;
    EXPECT_TRUE(says(o.out,
                     "keeps what it promises, but for what it is known to break: "
                     "CarriesNoMoreStateThanTheSceneNeeds"));
}

TEST(Check, ItsLastLineCountsAndSaysWhyAPromiseWasNotAsked) {
    const Scratch scratch;
    const std::string words =
        "check modal_explicit_penalty --only NeverPulls,"
        "KeepsItsEnergyLedgerInSum,StaysSoundOverAMap";
    const Ended o = jvari(scratch, words);
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_TRUE(o.out.ends_with(
        "\n  keeps what it promises\n  1 kept, 2 not asked: it promises no balance\n"))
        << o.out;
    EXPECT_EQ(Json::parse(jvari(scratch, words + " --json").out)["schemes"][0]["not_asked"],
              Json({"KeepsItsEnergyLedgerInSum", "StaysSoundOverAMap"}));
}

TEST(Check, AsksTheNamedPromisesOnTheNamedScenesAlone) {
    const Scratch scratch;
    const auto answers = [&](const std::string& options) {
        std::set<std::string> all;
        const Ended o = jvari(scratch, "check --json " + options + " modal_two_point");
        const Json report = Json::parse(o.out);
        for (const Json& a : report["schemes"][0]["answers"])
            all.insert(a["promise"].get<std::string>() + " " + a["scene"].get<std::string>());
        return all;
    };
    EXPECT_EQ(answers("--only NeverPulls,ItRunsAScene --scene tanpura_c3,free_string"),
              (std::set<std::string>{"NeverPulls tanpura_c3", "NeverPulls free_string"}));
    EXPECT_EQ(answers("--only ItRunsAScene"), std::set<std::string>{"ItRunsAScene "});
    EXPECT_GT(answers("--scene free_string").size(), 10u);
    EXPECT_TRUE(
        says(jvari(scratch, "check modal_two_point --only NeverPulls --scene rest").out,
             "\n  nothing could be asked of it\n  1 not asked: the string touches nothing"));
    EXPECT_TRUE(ends(jvari(scratch, "check modal_two_point --only NeverPull"), 2,
                     "did you mean \"NeverPulls\"?"));
    EXPECT_TRUE(ends(jvari(scratch, "check modal_two_point --scene free_strin"), 2,
                     "did you mean \"free_string\"?"));
    EXPECT_TRUE(
        ends(jvari(scratch, "check modal_two_point --scene free_string --only ItRunsAScene"), 2,
             "found no promise of these that is examined on these scenes"));
}

TEST(Check, WritesWhatContinuousIntegrationReads) {
    const Scratch scratch;
    const Ended o =
        jvari(scratch, "check gives_nan --plugin " JVARI_FAULTS " --json --quiet --junit " +
                           (scratch / "check.xml"));
    EXPECT_EQ(o.code, 4) << o.err;
    const Json scheme = Json::parse(o.out)["schemes"][0];
    EXPECT_EQ(scheme["broken"], Json({"GivesNumbersToTheLastRow"}));
    const std::string xml = content(scratch / "check.xml");
    std::smatch found;
    ASSERT_TRUE(std::regex_search(xml, found,
                                  std::regex("<testsuite name=\"gives_nan\" tests=\"(\\d+)\" "
                                             "failures=\"(\\d+)\" skipped=\"(\\d+)\"")))
        << xml.substr(0, 500);
    EXPECT_EQ(std::stoul(found[1]), scheme["answers"].size());
    EXPECT_EQ(count(xml, "<testcase "), std::stoi(found[1]));
    EXPECT_EQ(count(xml, "<failure "), std::stoi(found[2]));
    EXPECT_EQ(count(xml, "<skipped "), std::stoi(found[3]));
    EXPECT_GT(std::stoi(found[2]), 0);
}

TEST(Check, WantsASchemeThatThereIs) {
    const Scratch scratch;
    EXPECT_EQ(jvari(scratch, "check").code, 2);
    const Ended o = jvari(scratch, "check modal_two_pont");
    EXPECT_TRUE(ends(o, 2, "modal_two_point"));
    EXPECT_EQ(jvari(scratch, "check --plugin " + (scratch / "none.so")).code, 2);
    EXPECT_EQ(jvari(scratch, "check modal_two_point --junit /nowhere/check.xml").code, 2);
}

}  // namespace
}  // namespace jvari::test
