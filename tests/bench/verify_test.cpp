// jvari verify: a record comes back to the last digit by the program that made it, within its uncertainty by another, or is said not to.
#include <gtest/gtest.h>

#include <regex>

#include "bench/store/fresh_file.hpp"
#include "tests/command_line.hpp"

namespace jvari::test {
namespace {

class Verify : public testing::Test {
protected:
    static void SetUpTestSuite() {
        made = std::make_unique<Scratch>();
        const auto ran =
            jvari(*made,
                  "compare tanpura_c3_release --duration 0.01 --rates 44100,88200 --modes 40 --schemes modal_two_point --repeats 1 --out " +
                      (*made / "record"));
        ASSERT_EQ(ran.code, 0) << ran.err;
        std::filesystem::remove_all(*made / "record/cells");
    }
    static void TearDownTestSuite() { made.reset(); }

    void SetUp() override { std::filesystem::copy(*made / "record", record(), std::filesystem::copy_options::recursive); }
    std::string record() const { return scratch / "record"; }
    void change(const std::string& file, const std::string& from, const std::string& to) {
        const std::string path = record() + "/" + file, text = content(path);
        const std::string changed = std::regex_replace(text, std::regex(from), to, std::regex_constants::format_first_only);
        ASSERT_NE(changed, text) << from;
        bench::store::write_fresh(path, changed);
    }
    Outcome verified() { return jvari(scratch, "verify " + record()); }

    static std::unique_ptr<Scratch> made;
    Scratch scratch;
};
std::unique_ptr<Scratch> Verify::made;

TEST_F(Verify, ARecordOfThisProgramComesBackToTheLastDigit) {
    const auto ran = verified();
    EXPECT_TRUE(ends(ran, 0, "0 within their uncertainty, 0 did not"));
    EXPECT_TRUE(says(ran.err, "by the same program"));
}

TEST_F(Verify, ALastDigitIsLostOnTheSameProgramAndRoundingOnAnother) {
    change("cells.csv", "(,0\\.0\\d{9,})[0-35-9](,)", "$014$02");  // the last digit of an error
    const auto same = verified();
    EXPECT_EQ(same.code, 4) << same.out;
    change("manifest.json", "\"sources\": \"..", "\"sources\": \"zz");
    const auto other = verified();
    EXPECT_TRUE(ends(other, 0, "1 within their uncertainty, 0 did not"));
    EXPECT_TRUE(says(other.err, "by another program"));
}

TEST_F(Verify, AnotherErrorDoesNotComeBackAndIsNamed) {
    change("cells.csv", ",0\\.0(\\d{9,})", ",0.9$1");
    const auto ran = verified();
    EXPECT_EQ(ran.code, 4) << ran.out;
    EXPECT_TRUE(says(ran.out, "1 did not"));
    EXPECT_TRUE(says(ran.out, "error_l2"));
}

TEST_F(Verify, AnotherReferenceIsSaidFirst) {
    change("cells.csv", "exact_contact", "sundials");
    const auto ran = verified();
    EXPECT_EQ(ran.code, 4);
    EXPECT_TRUE(ran.out.starts_with("the references differ in 1 of ")) << ran.out;
}

TEST_F(Verify, ACommandThatIsNoStudyIsRefused) {
    change("manifest.json", "\"command\": \"jvari compare", "\"command\": \"jvari trim");
    EXPECT_TRUE(ends(verified(), 2, "expected jvari suite or compare"));
}

}  // namespace
}  // namespace jvari::test
