// Rows to CSV and back, and numbers to text and back.
#include "bench/store/records.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "bench/store/json.hpp"

namespace jvari {
namespace {

TEST(Records, WhatCsvWritesItReadsBackWhateverTheFieldsHold) {
    bench::store::Table t;
    t.columns = {"plain", "a, comma", "a \"quotation\""};
    t.rows = {{"", "two\nlines", "\"\""}, {"x", ",", "\r\n"}, {"\u00e9", " space ", ""}};
    const bench::store::Table back = bench::store::read_csv(bench::store::csv(t));
    EXPECT_EQ(back.columns, t.columns);
    EXPECT_EQ(back.rows, t.rows);
}

TEST(Records, NoTextIsAFormulaToASpreadsheetAndNumbersStayNumbers) {
    const bench::store::Table t{{"=a", "b"},
                                {{"=1+1", "-thread"},
                                 {"@x", "+"},
                                 {"'=1", "'"},
                                 {-0.5, -HUGE_VAL},
                                 {"-1e-05", "=a,\"b\""}}};
    EXPECT_EQ(csv(t),
              "'=a,b\n'=1+1,'-thread\n'@x,'+\n''=1,''\n-0.5,-inf\n\"-1e-05\",\"'=a,\"\"b\"\"\"\n");
    const bench::store::Table back = bench::store::read_csv(bench::store::csv(t));
    EXPECT_EQ(back.columns, t.columns);
    EXPECT_EQ(back.rows, t.rows);
}

TEST(Records, NumbersReadBackAsTheSameDouble) {
    for (double x : {0.0, 0.1, 1.0 / 3, 1e-320, 6.02214076e23, -0.1, 2822400.0,
                     std::numeric_limits<double>::max()})
        EXPECT_EQ(bench::store::number_of(bench::store::text_of(x)), x);
    EXPECT_EQ(bench::store::text_of(std::nan("")), "");
    EXPECT_TRUE(std::isnan(bench::store::number_of("")));
    EXPECT_TRUE(std::isnan(bench::store::number_of("1.5 m")));
    EXPECT_TRUE(std::isinf(bench::store::number_of(bench::store::text_of(HUGE_VAL))));
}

TEST(Records, AFieldHasItsOwnTypeInJsonWhateverItsTextLooksLike) {
    const auto written = bench::store::Field::as_written;
    const bench::store::Table t{
        {"tap", "modes", "error", "front", "key", "word", "none", "endless", "empty"},
        {{"7", 133, 0.25, true, written("1e+05"), written("own"), nan, HUGE_VAL, ""}}};
    EXPECT_EQ(bench::store::compact(bench::store::rows_json(t)),
              R"([{"tap":"7","modes":133,"error":0.25,"front":true,"key":100000,"word":"own",)"
              R"("none":null,"endless":null,"empty":""}])");
    EXPECT_EQ(
        csv(t),
        "tap,modes,error,front,key,word,none,endless,empty\n\"7\",133,0.25,1,1e+05,own,,inf,\n");
    // types survive the file, but for truth values and empty texts
    EXPECT_EQ(bench::store::compact(table_json(bench::store::read_csv(csv(t))).at("rows")),
              R"([["7",133,0.25,1,100000,"own",null,[1],null]])");
}

TEST(Records, ARowOfTheWrongLengthIsAnErrorWithItsLine) {
    try {
        bench::store::read_csv("a,b\n1,2\n3\n");
        FAIL();
    } catch (const std::runtime_error& e) {
        EXPECT_STREQ(e.what(), "line 3: found 1 fields, expected 2");
    }
    EXPECT_THROW(bench::store::read_csv("a\n\"b\n"), std::runtime_error);
}

TEST(Records, APartOfATableKeepsTheOrderAskedFor) {
    const bench::store::Table t{{"a", "b", "c"}, {{"1", "2", "3"}}};
    const bench::store::Table part = t.only({"c", "absent", "a"});
    EXPECT_EQ(part.columns, (std::vector<std::string>{"c", "a"}));
    EXPECT_EQ(part.rows[0], (std::vector<bench::store::Field>{"3", "1"}));
}

// Of nothing as the definition of XXH3 in 128 bits has it; and that a change of one bit changes it.
TEST(Checksum, IsXxh3) {
    EXPECT_EQ(bench::store::hash_of(""), "99aa06d3014798d86001c324468d497f");
    EXPECT_EQ(bench::store::hash_of("a").size(), 32u);
    EXPECT_NE(bench::store::hash_of("a"), bench::store::hash_of("`"));
}

TEST(Checksum, WhatWasSealedComesBackAndNothingElseDoes) {
    const std::string object = "{\n \"a\": [1, \"}\"]\n}", file = bench::store::sealed(object);
    EXPECT_EQ(bench::store::unsealed(file), object);
    EXPECT_TRUE(file.ends_with("\"\n}\n")) << file;
    for (std::size_t k = 0; k < file.size(); ++k) {
        std::string altered = file;
        altered[k] ^= 1;
        EXPECT_THROW(bench::store::unsealed(altered), std::runtime_error) << k;
        EXPECT_THROW(bench::store::unsealed(file.substr(0, k)), std::runtime_error) << k;
    }
}

TEST(Checksum, NestingIsCountedOutsideOfTexts) {
    const auto deep = [](std::size_t n, const std::string& within) {
        return std::string(n, '[') + within + std::string(n, ']');
    };
    EXPECT_NO_THROW(bench::store::parsed(deep(32, "\"[[[[\\\"[[[[\"")));
    EXPECT_NO_THROW(bench::store::parsed("[" + deep(31, "") + "," + deep(31, "") + "]"));
    EXPECT_THROW(bench::store::parsed(deep(33, "")), std::runtime_error);
    EXPECT_THROW(bench::store::parsed(deep(32, "\"\\\\\", []")), std::runtime_error);
    EXPECT_THROW(bench::store::parsed(std::string(300000, '[')), std::runtime_error);
}

}  // namespace
}  // namespace jvari
