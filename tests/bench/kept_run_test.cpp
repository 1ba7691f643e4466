// Runs of references that are kept: what is read back is what was run, and nothing else is
// believed.
#include "bench/study/reference.hpp"

#include <cmath>

#include "bench/compare/catalogue.hpp"
#include "bench/store/encoding.hpp"
#include "reference/references.hpp"
#include "scenes/scene_file.hpp"
#include "tests/command_line.hpp"

namespace jvari::test {
namespace {

namespace fs = std::filesystem;

const Settings kept_settings{0, 44100, 20, {{"tolerance", "1e-8"}}};

Scene released() { return bench::compare::load_scene("tanpura_c3_release", {}, 5e-3); }

jvari::Run a_run(double seconds = 1) {
    jvari::Run r = bench::study::run_heard(exact_contact, released(), kept_settings, {});
    r.wall_seconds = seconds;
    return r;
}

TEST(KeptRun, IsTheRunToTheLastBit) {
    const Scratch scratch;
    jvari::Run before = a_run();
    before.status = {Outcome::not_converged, 12};
    before.facts.push_back({"nothing", std::nan(""), "m"});
    bench::study::write_run(scratch / "a.run", "key", before);
    const auto after = bench::study::read_run(scratch / "a.run", "key");
    ASSERT_TRUE(after);
    EXPECT_EQ(after->trace.tap, before.trace.tap);
    EXPECT_EQ(after->trace.names, before.trace.names);
    EXPECT_EQ(after->trace.heard(0).size(), before.trace.column(0).size());
    EXPECT_EQ(after->trace.rows, before.trace.rows);
    EXPECT_EQ(after->trace.stride, before.trace.stride);
    EXPECT_EQ(after->trace.tap_rate, before.trace.tap_rate);
    EXPECT_EQ(after->status.outcome, Outcome::not_converged);
    EXPECT_EQ(after->status.step, 12);
    EXPECT_EQ(after->dofs, before.dofs);
    EXPECT_EQ(after->steps, before.steps);
    ASSERT_EQ(after->facts.size(), before.facts.size());
    EXPECT_EQ(after->facts[0].name, before.facts[0].name);
    EXPECT_EQ(after->facts[0].value, before.facts[0].value);
    EXPECT_TRUE(std::isnan(after->facts.back().value));
}

TEST(KeptRun, IsNotBelievedWhereItIsBrokenAlteredOrOfAnother) {
    const Scratch scratch;
    const fs::path path = scratch / "a.run";
    bench::study::write_run(path, "key", a_run());
    const std::string whole = content(path.string());
    EXPECT_FALSE(bench::study::read_run(path, "another"));
    EXPECT_FALSE(bench::study::read_run(scratch / "none.run", "key"));
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{7}, std::size_t{16}, whole.size() / 2, whole.size() - 1}) {
        overwrite(path, whole.substr(0, size));
        EXPECT_FALSE(bench::study::read_run(path, "key")) << size;
    }
    for (std::size_t k = 0; k < 9; ++k) {  // a number is 9 bytes long
        std::string altered = whole;
        altered[whole.size() / 2 + k] ^= 1;
        overwrite(path, altered);
        EXPECT_FALSE(bench::study::read_run(path, "key"));
    }
    overwrite(path, whole);
    EXPECT_TRUE(bench::study::read_run(path, "key"));
}

TEST(KeptRun, IsNotBelievedWhereItsChecksumIsRightAndItsContentIsNot) {
    const Scratch scratch;
    const fs::path path = scratch / "a.run";
    bench::study::write_run(path, "key", a_run());
    const std::string right = content(path.string()).substr(32);
    const auto believed = [&](const std::string& text) {
        overwrite(path, bench::store::hash_of(text) + text);
        return bench::study::read_run(path, "key").has_value();
    };
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string text = right;
        return text.replace(text.find(from), from.size(), to);
    };
    EXPECT_TRUE(believed(right));
    EXPECT_FALSE(believed(with("\"ok\"", "\"no such outcome\"")));
    EXPECT_FALSE(believed(with("\"ok\"", "77")));
    EXPECT_FALSE(believed(with("\"rows\":", "\"rows\":1")));
    EXPECT_FALSE(believed(right + "12345678"));
    EXPECT_FALSE(believed(with("\"ok\"", std::string(200000, '[') + std::string(200000, ']'))));
    EXPECT_FALSE(believed(std::string(200000, '[') + "\n"));
    EXPECT_FALSE(believed(std::string(200000, '\x81')));
}

TEST(KeptRun, OfSizesThatCannotBeIsNotBelievedWhateverItsChecksum) {
    const Scratch scratch;
    const auto believed = [&](const std::string& dofs, const std::string& stride,
                              const std::string& rows, const std::string& columns = "8") {
        const std::string content =
            R"({"key":"key","outcome":"ok","failed_step":0,"dofs":)" + dofs +
            R"(,"steps":0,"wall_seconds":1,"facts":[],"worst_block":0,"tap_rate":44100,"stride":)" +
            stride + R"(,"rows":)" + rows +
            R"(,"names":["a","b","c","d","e","f","g","h"],"columns":)" + columns + "}\n";
        overwrite(scratch / "a.run", bench::store::hash_of(content) + content);
        return bench::study::read_run(scratch / "a.run", "key").has_value();
    };
    EXPECT_TRUE(believed("4", "9", "0"));
    EXPECT_TRUE(believed("4", "9", "0", "16"));  // read twice
    for (const char* columns : {"0", "9", "-8", "24", "9223372036854775807"})
        EXPECT_FALSE(believed("4", "9", "0", columns));
    // a run has its first row at least
    EXPECT_FALSE(believed("4", "0", "0"));
    // 2^61: eight columns of as many doubles are 0 bytes
    EXPECT_FALSE(believed("4", "2305843009213693952", "2305843009213693952"));
    // 64 GB of rows that were never made
    EXPECT_FALSE(believed("4", "1000000000", "0"));
    EXPECT_FALSE(believed("1e300", "9", "0"));
    EXPECT_FALSE(believed("2147483648", "9", "0"));
    EXPECT_FALSE(believed("4", "9", "18446744073709551615"));
}

TEST(KeptRun, IsMadeOnceAndAgainWhereTheFileIsBroken) {
    const Scratch scratch;
    const fs::path folder = scratch / "runs";
    int count = 0;
    const auto make = [&count] { return ++count, a_run(); };
    const jvari::Run first = bench::study::kept_run(folder, "key", make),
                     second = bench::study::kept_run(folder, "key", make);
    EXPECT_EQ(count, 1);
    EXPECT_EQ(first.trace.tap, second.trace.tap);
    overwrite(folder / "key.run", "half");
    bench::study::kept_run(folder, "key", make);
    EXPECT_EQ(count, 2);
    bench::study::kept_run(folder, "key", make);
    EXPECT_EQ(count, 2);
    bench::study::kept_run({}, "key", make);
    EXPECT_EQ(count, 3);
}

TEST(KeptRun, OfLessThanHalfASecondIsNotKeptAndAFolderThatCannotBeIsNoError) {
    const Scratch scratch;
    const fs::path folder = scratch / "runs";
    bench::study::kept_run(folder, "key", [] { return a_run(0.1); });
    EXPECT_FALSE(fs::exists(folder / "key.run"));
    overwrite(folder, "a file");
    EXPECT_GT(bench::study::kept_run(folder, "key", [] { return a_run(); }).trace.rows, 0);
}

TEST(KeptRun, HasAKeyOfEverythingThatItsNumbersDependOn) {
    const Scene scene = released();
    const std::string key = bench::study::run_key(exact_contact, scene, kept_settings);
    EXPECT_EQ(bench::study::run_key(exact_contact, released(), kept_settings), key);
    EXPECT_NE(bench::study::run_key(sundials, scene, kept_settings), key);
    Scene longer = scene;
    longer.duration *= 2;
    EXPECT_NE(bench::study::run_key(exact_contact, longer, kept_settings), key);
    Settings other = kept_settings;
    other.modes = 21;
    EXPECT_NE(bench::study::run_key(exact_contact, scene, other), key);
    other = kept_settings;
    other.tap_rate = 48000;
    EXPECT_NE(bench::study::run_key(exact_contact, scene, other), key);
    other = kept_settings;
    other.options[0].second = "1e-9";
    EXPECT_NE(bench::study::run_key(exact_contact, scene, other), key);
}

}  // namespace
}  // namespace jvari::test
