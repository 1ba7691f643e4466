// Certificates as they are computed, and as people meet them: the files, the cache, the figures
// that stand beside the errors of compare and suite.
#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/store/encoding.hpp"
#include "bench/study/cells.hpp"
#include "bench/study/certificate.hpp"
#include "bench/study/certificate_library.hpp"
#include "reference/oversampled.hpp"
#include "reference/references.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/making.hpp"
#include "tests/c3.hpp"
#include "tests/command_line.hpp"

namespace jvari::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using namespace bench::study;

// of the first cell and its headline's nut tap
double certificate_in(const Json& compared, const char* measure) {
    const Json& cell = compared.at("cells").at(0);
    return cell.at("errors")
        .at(cell.at("headline_nut").get<std::string>())
        .at(measure)
        .at("certificate");
}

Certificate certified(const Scene& scene, const CertifySettings& settings) {
    return certify(scene, certificate_plan(scene, settings));
}

Scene short_scene(const std::string& name, double duration) {
    Scene scene = read_scene(name);
    scene.duration = duration;
    return scene;
}

// ---- As they are computed: which references run, which are compared, what is doubled

Scene release(double duration) {
    Scene scene = c3_release();
    scene.duration = duration;
    return scene;
}

const Certificate::Options matched_alone{{"compliance", "matched"}};

TEST(Certificate, ShowsThatTheReferencesAgree) {
    const Certificate c = certified(release(6e-3), {40, 44100});
    ASSERT_EQ(c.entries.size(), 6u);
    EXPECT_EQ(c.entries[0].reference, "exact_contact");
    EXPECT_EQ(c.entries[2].reference, "sundials");
    EXPECT_EQ(c.entries[3].options, matched_alone);
    EXPECT_EQ(c.entries[5].doubled, "modes");
    EXPECT_EQ(c.entries[5].options, matched_alone);
    // 3 of own compliance, 1 matched; the last two with the defaults of their own reference alone
    ASSERT_EQ(c.pairs.size(), 6u);
    for (std::size_t k = 0; k < 4; ++k) {
        const bool first = is_matched(c.entries[c.pairs[k].first].options),
                   second = is_matched(c.entries[c.pairs[k].second].options);
        EXPECT_EQ(first, second) << k;
    }
    for (const auto& [pair, with] : {std::pair(4, 0), std::pair(5, 3)}) {
        EXPECT_EQ(c.pairs[pair].first, 5);
        EXPECT_EQ(c.pairs[pair].second, with);
    }
    for (const auto& e : c.entries) {
        EXPECT_EQ(e.status.outcome, Outcome::ok);
        EXPECT_GT(e.wall_seconds, 0);
        EXPECT_NEAR(e.reached, 6e-3, 1e-4);
    }
    for (const auto& pair : c.pairs) {
        if (pair.first >= 5) continue;
        // nut
        EXPECT_LT(pair.taps[0].relative_l2.back(), 1e-9) << pair.first << " " << pair.second;
        // bridge
        EXPECT_LT(pair.taps[2].relative_l2.back(), 1e-6) << pair.first << " " << pair.second;
        EXPECT_NEAR(pair.taps[0].until[2], 6e-3, 1e-4);
    }
    EXPECT_GT(c.floor[0].relative_l2.back(), 1e-13);
    EXPECT_LT(c.floor[0].relative_l2.back(), 1e-10);
}

// 60 modes are far from the string: what all references of 60 modes agree about to 1e-9 is wrong by
// more than 1e-2.
TEST(Certificate, SaysWhatTwiceTheModesAndTwiceThePointsChange) {
    const Scene scene = release(10e-3);
    const Certificate c = certified(scene, {60, 44100});
    const Certificate::Pair &from_own = c.pairs[c.pairs.size() - 2], &doubled = c.pairs.back();
    ASSERT_EQ(c.entries[doubled.first].doubled, "modes");
    const auto trace_of = [&scene](int modes, const Certificate::Options& options) {
        return run(exact_contact, scene, {0, 44100, modes, options}).trace;
    };
    const Trace own = trace_of(60, {}), model = trace_of(60, matched_alone),
                twice = trace_of(120, matched_alone), string = trace_of(600, matched_alone);
    for (int k = 0; k < model.taps(); ++k) {
        const double further = (and_further_ones - 1) * doubled.taps[k].relative_l2.back();
        for (const auto& [trace, pair] :
             {std::pair(&own, &from_own), std::pair(&model, &doubled)}) {
            const double changed = pair->taps[k].relative_l2.back();
            EXPECT_DOUBLE_EQ(changed,
                             relative_difference(twice.column(k), trace->column(k), 44100, 1));
            EXPECT_LT(relative_difference(string.column(k), trace->column(k), 44100, 1),
                      changed + further);  // of the norm of what is trusted
        }
    }
    EXPECT_GT(from_own.taps[0].relative_l2.back(), 1e-2);
    EXPECT_LT(doubled.taps[2].relative_l2.back(), 0.1 * from_own.taps[2].relative_l2.back());

    Scene profile = scene;
    profile.duration = 2e-3;
    profile.strings[0].barriers = {ProfileBarrier{ParabolaCurve{0.05}, 0, 0.02, {1e10}, 1, 0}};
    profile.strings[0].thread.reset();
    const Certificate p = certified(profile, {20, 44100});
    ASSERT_EQ(p.entries.back().doubled, "points");
    EXPECT_EQ(p.entries.back().options, (Certificate::Options{{"nodes", "64"}}));
    const auto nut = [&profile](const char* nodes) {
        return run(exact_contact, profile, {0, 44100, 20, {{"nodes", nodes}}}).trace;
    };
    const Trace points = nut("32"), more = nut("64");
    EXPECT_DOUBLE_EQ(p.pairs.back().taps[0].relative_l2.back(),
                     relative_difference(more.column(0), points.column(0), 44100, 1));
    EXPECT_GT(p.pairs.back().taps[0].relative_l2.back(), 0);
}

TEST(Certificate, EndsARunAtItsTimeLimitAndSaysSo) {
    const Scene scene = short_scene("tanpura_c3_release", 0.01);
    const auto reason = [&scene](double seconds) -> std::string {
        try {
            certify(scene, certificate_plan(scene, {20, 44100}), {}, {}, seconds);
        } catch (const Refusal& refusal) { return refusal.what(); }
        return "";
    };
    EXPECT_EQ(reason(HUGE_VAL), "");
    EXPECT_TRUE(says(reason(1e-9), "it takes longer than 1e-09 s"));
}

TEST(Certificate, OfASceneThatNoReferenceRepresentsIsTheStandInsOwnEstimate) {
    Scene scene = read_scene("sitar_c5_two_planes", {});
    scene.duration = 1e-3;
    ASSERT_EQ(best_reference(scene), nullptr);
    const Certificate c = certified(scene, {38, 44100});
    ASSERT_EQ(c.entries.size(), 1u);
    EXPECT_EQ(c.entries[0].sample_rate, 64 * 44100.0);
    EXPECT_EQ(c.entries[0].reference.find("oversampled "), 0u);
    EXPECT_EQ(c.entries[0].estimate.size(), scene.taps.size());
    EXPECT_TRUE(c.pairs.empty());
    EXPECT_EQ(c.floor.size(), scene.taps.size());
}

TEST(Certificate, OfALinearSceneRestsOnTheClosedForm) {
    Scene scene = c3_free();
    scene.strings.front().start = ModeShape{2, 1e-3};
    scene.duration = 20e-3;
    const Certificate c = certified(scene, {30, 44100});
    EXPECT_EQ(c.entries.front().reference, "exact_linear");
    EXPECT_EQ(c.entries.size(), 5u);
    for (const auto& pair : c.pairs)  // one mode swings: twice as many change nothing
        for (const Agreement& tap : pair.taps) EXPECT_LT(tap.relative_l2.back(), 1e-12);
}

// ---- The file

TEST(CertificateFile, ReadsBackToWhatItWasWrittenFrom) {
    // with pairs, and with an estimate
    for (const char* scene : {"tanpura_c3_release", "sitar_c5_two_planes"}) {
        const Scratch scratch;
        const Certificate kept = certified(short_scene(scene, 1e-3), {20, 44100});
        const fs::path path = scratch / "a.json";
        overwrite(path, json_of(kept));
        overwrite(cost_path(path), cost_json_of(kept));
        auto back = read_certificate(path);
        ASSERT_TRUE(back);
        EXPECT_EQ(json_of(*back), json_of(kept));
        EXPECT_TRUE(std::isnan(back->entries[0].wall_seconds));
        read_costs(path, *back);
        const Certificate &is = *back, &was = kept;
        ASSERT_EQ(is.entries.size(), was.entries.size());
        for (std::size_t i = 0; i < was.entries.size(); ++i) {
            EXPECT_EQ(is.entries[i].wall_seconds, was.entries[i].wall_seconds);
            ASSERT_EQ(is.entries[i].estimate.size(), was.entries[i].estimate.size());
            for (std::size_t k = 0; k < was.entries[i].estimate.size(); ++k)
                EXPECT_EQ(is.entries[i].estimate[k].back(), was.entries[i].estimate[k].back());
        }
        ASSERT_EQ(is.pairs.size(), was.pairs.size());
        EXPECT_EQ(was.pairs.empty(), !was.entries[0].estimate.empty());
        for (std::size_t i = 0; i < was.pairs.size(); ++i)
            EXPECT_EQ(is.pairs[i].taps[2].until, was.pairs[i].taps[2].until);
    }
}

TEST(CertificateFile, KeepsTheTwoKindsOfNumbersApartAndRepeatsToTheLastDigit) {
    const Scene scene = short_scene("free_string", 5e-3);
    const Certificate first = certified(scene, {10, 44100}), second = certified(scene, {10, 44100});
    EXPECT_EQ(json_of(first), json_of(second));
    for (const char* clock : {"wall", "date", "cpu", "commit"}) {
        EXPECT_FALSE(says(json_of(first), clock)) << clock;
        EXPECT_TRUE(says(cost_json_of(first), clock)) << clock;
    }
    EXPECT_FALSE(says(cost_json_of(first), "l2"));
}

TEST(CertificateFile, HasAKeyOfAllThatItDependsOnAndAHashOfTheSceneWhateverItsDuration) {
    const Scene scene = short_scene("free_string", 5e-3);
    const CertifySettings settings{10, 44100};
    const Certificate kept = certificate_plan(scene, settings);
    const auto differs = [&](const Scene& s, const CertifySettings& c) {
        return certificate_plan(s, c).key() != kept.key();
    };
    EXPECT_FALSE(differs(scene, settings));
    EXPECT_TRUE(differs(short_scene("free_string", 6e-3), settings));
    EXPECT_TRUE(differs(scene, {11, 44100}));
    EXPECT_TRUE(differs(scene, {10, 88200}));
    Scene tighter = scene;
    tighter.strings[0].tension *= 1.01;
    EXPECT_TRUE(differs(tighter, settings));
    EXPECT_NE(timeless_hash(tighter), timeless_hash(scene));
    EXPECT_EQ(timeless_hash(short_scene("free_string", 6e-3)), kept.scene_hash);
    EXPECT_EQ(certified(scene, settings).key(), kept.key());
    const auto by = [&kept](const bench::store::Machine& machine) {
        Certificate c = kept;
        c.program = bench::store::run_identity(machine);
        return c.key();
    };
    bench::store::Machine other = bench::store::machine();
    EXPECT_EQ(by(other), kept.key());
    other.commit = other.version = "another";  // a word of the documentation, say
    EXPECT_EQ(by(other), kept.key());
    for (std::string bench::store::Machine::*what :
         {&bench::store::Machine::run_sources, &bench::store::Machine::compiler,
          &bench::store::Machine::flags, &bench::store::Machine::vectors}) {
        bench::store::Machine changed = bench::store::machine();
        changed.*what += "x";
        EXPECT_NE(by(changed), kept.key());
    }
}

TEST(CertificateFile, ThatIsBrokenAlteredOrOfAnotherFormatIsNotBelieved) {
    const Scratch scratch;
    const fs::path path = scratch / "a.json";
    const std::string text = json_of(certified(short_scene("free_string", 5e-3), {10, 44100}));
    EXPECT_FALSE(read_certificate(path));
    const auto refused = [&](const std::string& content) {
        overwrite(path, content);
        return !read_certificate(path);
    };
    EXPECT_FALSE(refused(text));
    EXPECT_TRUE(refused(text.substr(0, text.size() / 2)));
    EXPECT_TRUE(refused(""));
    EXPECT_TRUE(refused("[1, 2]"));
    std::string altered = text;
    altered.replace(text.find("\"modes\": 10"), 11, "\"modes\": 11");
    EXPECT_TRUE(refused(altered));  // the checksum

    const auto with_checksum = [&](const char* pointer, const Json& value) {
        Json j = Json::parse(text);
        j.erase("checksum");
        j[Json::json_pointer(pointer)] = value;
        return bench::store::sealed(j.dump());
    };
    EXPECT_FALSE(refused(with_checksum("/of/scene", "another")));
    EXPECT_TRUE(refused(with_checksum("/of/format", 3)));
    EXPECT_FALSE(refused(with_checksum("/of/program", "jvari 0.0.0")));
    EXPECT_FALSE(read_certificate(path)->of_this_program());
    EXPECT_FALSE(refused(text));
    EXPECT_TRUE(read_certificate(path)->of_this_program());
    EXPECT_TRUE(refused(with_checksum("/outcomes", Json::array())));
    EXPECT_TRUE(refused(with_checksum("/of/runs", Json::array())));
    EXPECT_TRUE(refused(with_checksum("/noise_floor", Json::object())));
    EXPECT_TRUE(refused(with_checksum("/of/taps", {"nut", "elsewhere"})));

    const std::string deep = "{\"x\": " + std::string(300000, '[') + std::string(300000, ']');
    EXPECT_TRUE(refused(deep + ", \"checksum\": \"0\"}"));
    EXPECT_TRUE(refused(bench::store::sealed(deep + "}")));
    EXPECT_TRUE(refused(std::string(300000, '[')));
}

// ---- The verb

struct Verb {  // jvari certify of a small scene, its file in a folder of its own
    Scratch scratch;
    std::string file = scratch / "c.json";
    Json run(const std::string& more = "", int code = 0) {
        last = jvari(scratch, "certify free_string --modes 10 --json --out " + file +
                                  " --duration " + duration + " " + more);
        EXPECT_EQ(last.code, code) << last.err;
        return Json::parse(last.out);
    }
    // one figure, and the checksum with it: only a file that is read and not made again still has
    // it
    void alter() {
        Json j = Json::parse(content(file));
        j.erase("checksum");
        j["pairs"][0]["taps"]["nut"]["relative_l2"]["whole"] = 0.125;
        overwrite(file, bench::store::sealed(j.dump()));
    }
    void alter(const char* pointer, const char* value) {
        Json j = Json::parse(content(file));
        j.erase("checksum");
        j[Json::json_pointer(pointer)] = value;
        overwrite(file, bench::store::sealed(j.dump()));
    }
    bool altered() const {
        return Json::parse(content(file))["pairs"][0]["taps"]["nut"]["relative_l2"]["whole"] ==
               0.125;
    }
    std::string duration = "0.02";
    Ended last{};
};

TEST(CertifyCommand, RunsTheReferencesOnceAndThenReadsTheFile) {
    Verb verb;
    const Json first = verb.run();
    EXPECT_EQ(first["cached"], false);
    EXPECT_EQ(first["status"], "ok");
    EXPECT_EQ(first["certificate"], Json::parse(content(verb.file)));
    EXPECT_EQ(first["wall_seconds"].size(), 5u);
    EXPECT_EQ(verb.scratch.files(), 2);
    verb.alter();
    const Json second = verb.run();
    EXPECT_EQ(second["cached"], true);
    EXPECT_TRUE(verb.altered());
    EXPECT_EQ(second["wall_seconds"], first["wall_seconds"]);
    EXPECT_EQ(second["certificate"]["pairs"][0]["taps"]["nut"]["relative_l2"]["whole"], 0.125);
}

TEST(CertifyCommand, MakesABrokenOrForeignFileAgainAndSaysSo) {
    Verb verb;
    const Json first = verb.run();
    fs::resize_file(verb.file, 200);
    EXPECT_EQ(verb.run()["cached"], false);
    EXPECT_TRUE(says(verb.last.err, "made again"));
    EXPECT_EQ(Json::parse(content(verb.file)), first["certificate"]);
    for (const char* other : {"--tap-rate 22050", "--set string.0.tension=34"}) {
        EXPECT_EQ(verb.run(other)["cached"], false) << other;
        EXPECT_TRUE(says(verb.last.err, "another scene or setting"));
        EXPECT_EQ(verb.run(other)["cached"], true) << other;
    }
    EXPECT_EQ(verb.run("--tap-rate 22050")["cached"], false);
    verb.alter("/of/program", "jvari 0.0.0");
    EXPECT_EQ(verb.run("--tap-rate 22050")["cached"], false);
    EXPECT_TRUE(says(verb.last.err, "another program"));
    fs::remove(cost_path(verb.file));
    // read, without its costs
    EXPECT_TRUE(verb.run("--tap-rate 22050")["wall_seconds"][0].is_null());
}

TEST(CertifyCommand, KeepsACertificateThatIsLonger) {
    Verb verb;
    verb.run();
    const std::string kept = content(verb.file);
    verb.duration = "0.01";
    verb.run("", 2);
    EXPECT_TRUE(says(verb.last.err, "covers more of this scene"));
    EXPECT_EQ(content(verb.file), kept);
    verb.duration = "0.03";
    EXPECT_EQ(verb.run()["cached"], false);  // longer: says something that the other does not
}

TEST(CertifyCommand, WritesToTheFolderOfCertificatesAndLeavesTheScenesOwnToItWhereSetChangesIt) {
    const Scratch scratch;
    const std::string there = "cd " + scratch.path.string() + " &&";
    for (const char* set : {"", " --set string.0.tension=34"})
        EXPECT_EQ(jvari(scratch,
                        std::string("certify free_string --modes 5 --duration 0.005") + set, there)
                      .code,
                  0);
    int certificates = 0;
    for (const auto& entry : fs::directory_iterator(scratch.path / "results/certificates"))
        certificates += entry.path().string().find(".cost.json") == std::string::npos;
    EXPECT_EQ(certificates, 2);
    EXPECT_TRUE(fs::exists(scratch.path / "results/certificates/free_string.json"));
    // and compare finds it there, as far as it reaches
    const Json json = Json::parse(jvari(scratch,
                                        "compare free_string --modes 5 --schemes modal_two_point "
                                        "--rates 44100 --duration 0.005 --repeats 1 --json",
                                        there)
                                      .out);
    EXPECT_EQ(json["manifest"]["reference"]["certificate"]["file"], "free_string.json");
    EXPECT_GT(certificate_in(json, "error_l2_whole"), 0);
}

TEST(CertifyCommand, RefusesWhatItCannotDoAsTheOtherVerbsDo) {
    const Scratch scratch;
    const std::pair<const char*, const char*> cases[] = {
        {"certify", "scene"},
        {"certify free_strin", "did you mean \"free_string\""},
        {"certify free_string --modes 0", "whole number from 1 to 9999999"},
        {"certify free_string --tap-rate x", "number > 0"},
        {"certify free_string --duration 1e9", "memory"},
        {"certify free_string --out a.txt", ".json"},
        {"certify free_string --out a.cost.json", ".json"},
        {"certify free_string --out nowhere/a.json", "no folder"},
        {"certify free_string --set tension", "KEY.PATH=VALUE"},
    };
    for (const auto& [arguments, expected] : cases) {
        EXPECT_TRUE(ends(jvari(scratch, arguments), 2, expected)) << arguments;
    }
    EXPECT_TRUE(says(jvari(scratch, "certify --help").out, "Example: jvari certify"));
    const Ended nobody =
        jvari(scratch,
              "certify sitar_c5_two_planes --set string.0.damping.law=polynomial --set "
              "string.0.damping.sigma0=1 --set string.0.damping.sigma1=0.01 --out " +
                  (scratch / "a.json"));
    EXPECT_EQ(nobody.code, 3) << nobody.err;
    EXPECT_EQ(scratch.files(), 0);
}

// ---- The figures

Agreement all(double x) {
    Agreement a;
    for (std::size_t w = 0; w < a.relative_l2.size(); ++w)
        a.relative_l2[w] = x * static_cast<double>(w + 1);
    return a;
}

// one tap, 0.1 s; pair (i, j) differs by 10^-(i + 3 j) times 1, 2, 3 ... in the windows
Certificate by_hand() {
    Certificate c;
    c.taps = {"nut"};
    c.duration = 0.1;
    const auto entry = [&c](const char* name, Certificate::Options options, double rate = 0) {
        c.entries.push_back({name, std::move(options), rate, {}, 0.1, 0, {}, {}, {}});
    };
    entry("one", {});
    entry("one", {{"window", "0.5"}});
    entry("two", {{"rtol", "1e-12"}});
    entry("two", {});
    entry("oversampled three", {}, 1e6);
    for (int i = 0; i < 5; ++i)
        for (int j = 0; j < i; ++j) c.pairs.push_back({i, j, {all(std::pow(10, -i - 3 * j))}});
    return c;
}

TEST(Trust, IsTheLargestDifferenceFromAnyOtherReference) {  // one pair alone can agree by chance
    Certificate kept = by_hand();
    const Trust one = trust_of(kept, "one", {}, 0.1);
    EXPECT_EQ(one.against, "one window=0.5");
    EXPECT_DOUBLE_EQ(one.in_model(0, 0), 1e-1);      // entries 1 and 0, 10 ms
    EXPECT_DOUBLE_EQ(one.in_model(0, 1), 3 * 1e-1);  // 50 ms is the third window
    EXPECT_DOUBLE_EQ(one.in_model(0, 2), 7 * 1e-1);  // the whole
    const Trust two = trust_of(kept, "two", {}, 0.1);
    EXPECT_EQ(two.against, "one");
    EXPECT_DOUBLE_EQ(two.in_model(0, 0), 1e-3);  // entries 3 and 0
    for (auto& p : kept.pairs)
        // from itself at another tolerance
        if (p.first == 3 && p.second == 2) p.taps[0] = all(0.02);
    EXPECT_DOUBLE_EQ(trust_of(kept, "two", {}, 0.1).in_model(0, 0), 0.02);
    const Trust coarse = trust_of(kept, "one", {{"window", "0.5"}}, 0.1);
    EXPECT_DOUBLE_EQ(coarse.in_model(0, 0), 1e-1);
    EXPECT_FALSE(trust_of(kept, "two", {{"rtol", "1e-3"}}, 0.1).any());
    EXPECT_FALSE(trust_of(kept, "four", {}, 0.1).any());
}

TEST(Trust, OfTheSceneHasWhatDoublingModesAndPointsChanges) {
    Certificate kept = by_hand();
    Certificate& c = kept;
    const auto all = [](double figure) {
        Agreement a;
        a.relative_l2.fill(figure);
        return a;
    };
    const double in_model = trust_of(kept, "two", {}, 0.1).of_scene(0, 0);
    for (const auto& [what, figure] : {std::pair{"modes", 2e-2}, std::pair{"points", 3e-3}}) {
        c.entries.push_back({"one", {}, 0, {}, 0.1, 0, {}, {}, what});
        c.pairs.push_back({static_cast<int>(c.entries.size()) - 1, 0, {all(figure)}});
    }
    for (const char* name : {"one", "two"}) {  // they share the model, whichever was doubled
        const Trust t = trust_of(kept, name, {}, 0.1);
        EXPECT_EQ(t.doubled, "modes and points");
        EXPECT_DOUBLE_EQ(t.of_scene(0, 0), t.in_model(0, 0) + and_further_ones * (2e-2 + 3e-3))
            << name;
    }
    const Trust two = trust_of(kept, "two", {}, 0.1);
    EXPECT_EQ(two.against, "one");
    // what is of another model says nothing of the solution of this one
    EXPECT_DOUBLE_EQ(two.in_model(0, 0), in_model);
    c.entries.back().reached = 0.02;  // it failed there: of more nothing is known
    EXPECT_TRUE(std::isnan(trust_of(kept, "one", {}, 0.1).of_scene(0, 2)));
    EXPECT_FALSE(std::isnan(trust_of(kept, "one", {}, 0.1).of_scene(0, 0)));
}

TEST(Trust, OfTheSceneIsTheDifferenceFromTheMatchedOneOfTwiceTheModesAndWhatThatLeavesOut) {
    Certificate kept = by_hand();
    Certificate& c = kept;
    const Certificate::Options matched{{"compliance", "matched"}};
    c.entries.push_back({"one", matched, 0, {}, 0.1, 0, {}, {}, {}});
    c.entries.push_back({"one", matched, 0, {}, 0.1, 0, {}, {}, "modes"});
    c.pairs.push_back({6, 0, {all(2e-2)}});
    c.pairs.push_back({6, 5, {all(1e-3)}});
    const auto left_out = [&kept](const char* name, const Certificate::Options& options) {
        return trust_of(kept, name, options, 0.1).left_out.at(0)[0];
    };
    for (const char* name : {"one", "two"})
        EXPECT_DOUBLE_EQ(left_out(name, {}), 2e-2 + (matched_and_further_ones - 1) * 1e-3) << name;
    EXPECT_DOUBLE_EQ(left_out("one", matched), matched_and_further_ones * 1e-3);
    // no other run is matched
    EXPECT_TRUE(std::isnan(trust_of(kept, "one", matched, 0.1).in_model(0, 0)));
    c.entries.push_back({"one", {{"window", "0.5"}, matched.front()}, 0, {}, 0.1, 0, {}, {}, {}});
    c.pairs.push_back({7, 5, {all(1e-6)}});  // and own compliance is known to 0.1 only
    EXPECT_DOUBLE_EQ(trust_of(kept, "one", matched, 0.1).in_model(0, 0), 1e-1);
    c.pairs.back().taps[0] = all(0.2);
    EXPECT_DOUBLE_EQ(trust_of(kept, "one", matched, 0.1).in_model(0, 0), 0.2);
}

TEST(Trust, OfAReferenceThatStandsAloneIsItsLargestDifferenceFromItself) {
    Certificate kept = by_hand();
    for (auto& e : kept.entries)
        if (e.sample_rate == 0) e.reference = "two";
    kept.entries[0].options = {{"method", "adams"}};
    const Trust t = trust_of(kept, "two", {}, 0.1);
    // of 1e-3, 1e-6, 1e-9; the oversampled scheme is left aside
    EXPECT_DOUBLE_EQ(t.in_model(0, 0), 1e-3);
    EXPECT_EQ(t.against, "two method=adams");
}

TEST(Trust, ReachesAsFarAsTheCertificateAndTakesTheShortestWindowThatHolds) {
    Certificate kept = by_hand();
    const auto at = [&kept](double until, std::size_t window) {
        return trust_of(kept, "one", {}, until).of_scene(0, window);
    };
    EXPECT_DOUBLE_EQ(at(0.015, 2), 2e-1);   // the window of 20 ms
    EXPECT_TRUE(std::isnan(at(0.015, 1)));  // there are no 50 ms to compare
    EXPECT_DOUBLE_EQ(at(0.06, 2), 4e-1);    // 100 ms
    EXPECT_TRUE(std::isnan(at(0.2, 2)));    // longer than the certificate
    EXPECT_DOUBLE_EQ(at(0.2, 1), 3e-1);     // which still covers its first 50 ms
    kept.entries[1].reached = 0.03;         // the other reference failed there
    EXPECT_DOUBLE_EQ(at(0.1, 0), 1e-1);
    EXPECT_DOUBLE_EQ(at(0.1, 1), 3e-2);    // so this rests on entry 2
    EXPECT_DOUBLE_EQ(at(0.025, 2), 7e-1);  // what there is of entry 1: the whole of its 30 ms
}

// else: results/certificates/make
TEST(CommittedCertificates, ThereIsOneForEverySceneOfTheLibraryWithAllThatRepresentsIt) {
    for (const std::string& name : library_scenes()) {
        const Scene scene = read_scene(name);
        const auto kept =
            read_certificate(fs::path(JVARI_COMMITTED_CERTIFICATES) / (name + ".json"));
        ASSERT_TRUE(kept) << name;
        EXPECT_EQ(kept->scene_hash, timeless_hash(scene)) << name;
        EXPECT_EQ(kept->modes, modes_for(scene, {})) << name;
        for (const auto& planned : certificate_plan(scene).entries)
            EXPECT_TRUE(std::any_of(kept->entries.begin(), kept->entries.end(),
                                    [&](const auto& e) {
                                        return e.reference == planned.reference &&
                                               e.options == planned.options &&
                                               e.doubled == planned.doubled;
                                    }))
                << name << ": " << planned.reference;
        if (const Descriptor* reference = best_reference(scene)) {
            const double until = kept->from + 10e-3;
            EXPECT_GT(trust_of(*kept, reference->name, {}, until).of_scene(0, 0), 0) << name;
        } else {
            EXPECT_EQ(kept->entries.back().reference.rfind("oversampled ", 0), 0u) << name;
        }
    }
}

// ---- Beside the errors

struct Shelf : Scratch {  // a library of certificates with one in it
    std::string environment = "JVARI_CERTIFICATES=" + path.string();
    void put(Certificate kept, double figure) {
        for (auto& p : kept.pairs)
            for (Agreement& tap : p.taps)
                tap.relative_l2.fill(kept.entries[p.first].doubled.empty() ? figure : 0);
        overwrite(path / (kept.scene + ".json"), json_of(kept));
    }
};

const std::string small_compare =
    "compare free_string --modes 10 --schemes modal_two_point --rates 44100,88200 --duration 0.06 "
    "--repeats 1 ";

TEST(ComparedWithACertificate, AnErrorIsShownAsNoMoreThanItAndTheCertificateTogether) {
    Shelf shelf;
    const Certificate kept = certified(short_scene("free_string", 0.07), {133, 44100});
    shelf.put(kept, 0.25);
    const std::string out = shelf / "out";
    const Ended o = jvari(shelf, small_compare + "--out " + out, shelf.environment);
    ASSERT_EQ(o.code, 0) << o.err;
    const bench::study::Cells cells = bench::study::read_cells(bench::store::Folder(out), true);
    const auto figure = [](const bench::study::TabledCell& c, const char* measure,
                           const char* tap = "") {
        return c.figure(bench::study::measure(measure), tap);
    };
    // and to what doubling the modes changed
    const bench::study::Figure headline = figure(cells[0], "error_l2_50ms");
    EXPECT_TRUE(says(o.out, fmt::format("\u2264{:.2e}", headline.value + headline.certificate)));
    EXPECT_TRUE(
        says(o.out, "within 10 %    cannot be decided: the reference is known to 25 % only"));
    EXPECT_TRUE(says(o.out,
                     "in the first line of the table, by exact_contact and by doubling its modes "
                     "(free_string.json)"));
    EXPECT_FALSE(says(o.err, "jvari certify"));
    for (const bench::study::TabledCell& c : cells) {
        for (const char* measure : {"error_l2_10ms", "error_l2_50ms", "error_l2_whole"})
            for (const char* tap : {"", "nut", "y03"})
                EXPECT_NEAR(figure(c, measure, tap).certificate, 0.255, 0.005) << measure << tap;
        EXPECT_LT(figure(c, "error_l2_50ms").value, 0.25);  // as it was measured
    }
    const Json certificate =
        Json::parse(content(out + "/manifest.json"))["reference"]["certificate"];
    EXPECT_EQ(certificate["file"], "free_string.json");
    EXPECT_EQ(certificate["key"], kept.key());
    EXPECT_NEAR(certificate["figures"]["certificate_l2_50ms_y03"].get<double>(), 0.255, 0.005);

    shelf.put(kept, 1e-9);
    const Ended fine = jvari(shelf, small_compare, shelf.environment);
    EXPECT_FALSE(says(fine.out, "\u2264"));
}

TEST(ComparedWithACertificate, ItMustBeOfThatSceneAndThisTapRateWhateverTheModesOfTheCells) {
    Shelf shelf;
    const auto missing = [&shelf](const std::string& arguments) {
        const Ended o = jvari(shelf, arguments + " --json", shelf.environment);
        const Json json = Json::parse(o.out);
        const bool none = json["manifest"]["reference"]["certificate"].contains("missing");
        EXPECT_EQ(none, certificate_in(json, "error_l2_10ms") < 0.25);
        EXPECT_FALSE(says(o.err, "is unknown"));  // doubling tells
        return none;
    };
    EXPECT_TRUE(missing(small_compare));
    shelf.put(certified(short_scene("free_string", 0.07), {133, 44100}), 0.25);
    EXPECT_FALSE(missing(small_compare));
    EXPECT_TRUE(missing(small_compare + "--set string.0.tension=34"));
    EXPECT_TRUE(missing(small_compare + "--tap-rate 22050"));
    EXPECT_FALSE(
        missing("compare free_string --modes 11 --schemes modal_two_point --rates 44100 --duration "
                "0.06 --repeats 1"));
    const auto undoubled = [&shelf](const std::string& more) {
        return jvari(shelf, small_compare + "--reference-modes cell" + more, shelf.environment);
    };
    const Ended unknown = undoubled("");  // of ten modes there is no certificate
    EXPECT_TRUE(says(unknown.err, "the uncertainty of exact_linear is unknown"));
    EXPECT_TRUE(says(unknown.err, "jvari certify free_string --"));
    EXPECT_TRUE(says(unknown.out,
                     "within 10 %    cannot be decided: the uncertainty of the reference is "
                     "unknown; measured against it, the cheapest is"));
    fs::resize_file(shelf.path / "free_string.json", 300);
    EXPECT_TRUE(missing(small_compare));
}

TEST(ComparedWithAStandIn, TheTableSaysSoAndTheFiguresAreItsOwnEstimates) {
    const Scratch scratch;
    const std::string out = scratch / "out";
    const Ended o = jvari(
        scratch,
        "compare sitar_c5_two_planes --rates 44100,88200 --duration 0.02 --repeats 1 --out " + out);
    ASSERT_TRUE(ends(o, 0, "against oversampled sitar_waveguide at 352800 Hz"));
    EXPECT_TRUE(says(o.out, "no reference represents scene sitar_c5_two_planes"));
    EXPECT_TRUE(says(o.out, "Richardson's rule from 88200, 176400 and 352800 Hz"));
    const Json reference = Json::parse(content(out + "/manifest.json"))["reference"];
    EXPECT_EQ(reference["name"], "oversampled sitar_waveguide");
    EXPECT_TRUE(says(reference["note"].get<std::string>(), "stands in"));

    const Scene scene = short_scene("sitar_c5_two_planes", 0.02);
    const Oversampled own = oversampled(*stand_ins(scene).front(), scene, {88200, 44100, 0, {}}, 4);
    const bench::study::Cells cells = bench::study::read_cells(bench::store::Folder(out), true);
    for (std::size_t tap = 0; tap < scene.taps.size(); ++tap) {
        const auto figure = [&](const char* measure) {
            return cells[0].figure(bench::study::measure(measure), scene.taps[tap].name);
        };
        for (const char* measure : {"error_l2_10ms", "error_l2_whole", "error_l2_50ms"})
            EXPECT_TRUE(std::isnan(figure(measure).certificate))
                << "it bounds no error of the scene";
        EXPECT_EQ(figure("error_l2_10ms").certificate_in_model, own.estimates[tap].front());
        EXPECT_EQ(figure("error_l2_whole").certificate_in_model, own.estimates[tap].back());
        EXPECT_TRUE(std::isnan(figure("error_l2_50ms").certificate_in_model));
    }
    EXPECT_TRUE(says(o.out, "errors are against a string of as many modes, and no bounds"));
    EXPECT_FALSE(says(o.out, "\u2264")) << o.out;
}

TEST(ComparedWithAStandIn, ASchemeThatASuiteAsksForEstimatesItsOwnErrorToo) {
    const Scratch scratch;
    overwrite(scratch.path / "a.toml",
              suite_of("free_string", "modal_two_point", "88200",
                       "modes = 10\nduration = 0.06\nreference = 'modal_two_point'"));
    const Json json = Json::parse(jvari(scratch, "suite " + (scratch / "a.toml") + " --json").out);
    EXPECT_EQ(json["cells"][0]["reference"], "oversampled modal_two_point");
    EXPECT_TRUE(json["cells"][0]["errors"]["nut"]["error_l2_50ms"]["certificate"].is_null());
    EXPECT_GT(json["cells"][0]["errors"]["nut"]["error_l2_50ms"]["certificate_in_model"], 0);
}

TEST(SuiteWithACertificate, EveryCellHasTheFigures) {
    Shelf shelf;
    shelf.put(certified(short_scene("free_string", 0.02), {10, 44100}), 0.25);
    overwrite(shelf.path / "a.toml",
              suite_of("free_string,sitar_c5_two_planes", "modal_two_point,sitar_waveguide",
                       "44100", "modes = 10\nreference_modes = 'cell'\nduration = 0.02"));
    const std::string out = shelf / "out";
    const Ended o =
        jvari(shelf, "suite " + (shelf / "a.toml") + " --out " + out, shelf.environment);
    ASSERT_EQ(o.code, 0) << o.err;
    const bench::study::Cells cells = bench::study::read_cells(bench::store::Folder(out), true);
    ASSERT_EQ(cells.size(), 4u);
    const std::size_t whole = bench::study::measure("error_l2_whole");
    EXPECT_EQ(cells[0].figure(whole).certificate, 0.25);
    EXPECT_EQ(cells[3].reference, "oversampled sitar_waveguide");
    EXPECT_TRUE(std::isnan(cells[3].figure(whole).certificate));
}

}  // namespace
}  // namespace jvari::test
