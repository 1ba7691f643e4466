// Rows to CSV and back, and numbers to text and back.
#include "bench/store/records.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace jvari {
namespace {

TEST(Records, WhatCsvWritesItReadsBackWhateverTheFieldsHold) {
    Table t;
    t.columns = {"plain", "a, comma", "a \"quotation\""};
    t.rows = {{"", "two\nlines", "\"\""}, {"x", ",", "\r\n"}, {"\u00e9", " space ", ""}};
    const Table back = read_csv(csv(t));
    EXPECT_EQ(back.columns, t.columns);
    EXPECT_EQ(back.rows, t.rows);
}

TEST(Records, NumbersReadBackAsTheSameDouble) {
    for (double x : {0.0, 0.1, 1.0 / 3, 1e-320, 6.02214076e23, -0.1, 2822400.0, std::numeric_limits<double>::max()})
        EXPECT_EQ(number_of(text_of(x)), x);
    EXPECT_EQ(text_of(std::nan("")), "");
    EXPECT_TRUE(std::isnan(number_of("")));
    EXPECT_TRUE(std::isnan(number_of("1.5 m")));
    EXPECT_TRUE(std::isinf(number_of(text_of(HUGE_VAL))));
}

TEST(Records, ARowOfTheWrongLengthIsAnErrorWithItsLine) {
    try {
        read_csv("a,b\n1,2\n3\n");
        FAIL();
    } catch (const std::runtime_error& e) {
        EXPECT_STREQ(e.what(), "line 3: found 1 fields, expected 2");
    }
    EXPECT_THROW(read_csv("a\n\"b\n"), std::runtime_error);
}

TEST(Records, APartOfATableKeepsTheOrderAskedFor) {
    const Table t{{"a", "b", "c"}, {{"1", "2", "3"}}};
    const Table part = t.only({"c", "absent", "a"});
    EXPECT_EQ(part.columns, (std::vector<std::string>{"c", "a"}));
    EXPECT_EQ(part.rows[0], (std::vector<std::string>{"3", "1"}));
}

}  // namespace
}  // namespace jvari
