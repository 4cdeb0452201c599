// SPDX-License-Identifier: BSD-3-Clause
#include "text_cursor.hpp"

#include <gtest/gtest.h>

#include "input_error.hpp"

namespace helixnav::logs {
namespace {

TEST(TextCursor, ReadsNumbersOfALineAcrossSpacesTabsAndCarriageReturns) {
  TextCursor cursor(" 1.5\t-2e3   +7\r\n4\n", "a.txt");
  EXPECT_EQ(cursor.number("x"), 1.5);
  EXPECT_EQ(cursor.number("x"), -2000.0);
  EXPECT_EQ(cursor.integer("x"), 7);
  EXPECT_TRUE(cursor.at_line_end());
  cursor.end_line("3 columns");
  EXPECT_EQ(cursor.line(), 2u);
  EXPECT_EQ(cursor.integer("x"), 4);
  EXPECT_TRUE(cursor.at_end());
}

TEST(TextCursor, KeepsAnEmptyFieldBetweenCommasApart) {
  TextCursor cursor("1,,3", "a.csv", ',');
  EXPECT_EQ(cursor.word(), "1");
  EXPECT_EQ(cursor.word(), "");
  EXPECT_EQ(cursor.word(), "3");
}

TEST(TextCursor, NamesFileLineFoundAndExpected) {
  TextCursor cursor("1\n 2 pig\n", "a.txt");
  cursor.skip_line();
  cursor.number("x");
  EXPECT_EQ(testing::input_error_of([&] { cursor.number("a speed [m/s]"); }),
            "a.txt:2: expected a speed [m/s], found 'pig'");
}

TEST(TextCursor, RefusesNanInfinityAndHalfNumbers) {
  for (const char* text : {"nan", "inf", "-inf", "1.5x", "1..2", "1e999", "--1"}) {
    TextCursor cursor(text, "a.txt");
    EXPECT_THROW(cursor.number("x"), core::InputError) << text;
  }
}

TEST(TextCursor, RefusesColumnsTooManyAndTooFew) {
  TextCursor many("1 2 3\n", "a.txt");
  many.number("x");
  EXPECT_EQ(testing::input_error_of([&] { many.end_line("1 column"); }), "a.txt:1: more columns than 1 column");
  TextCursor few("1\n2\n", "a.txt");
  few.number("x");
  EXPECT_EQ(testing::input_error_of([&] { few.number("y"); }), "a.txt:1: expected y, found the end of the line");
}

TEST(TextCursor, NamesTheByteWhereTheTextIsOneLine) {
  TextCursor cursor("12 13 \x01\xff", "laser.txt", ' ', TextCursor::Place::byte);
  cursor.integer("x");
  cursor.integer("x");
  EXPECT_EQ(testing::input_error_of([&] { cursor.integer_in_stream("a range [cm]"); }),
            "laser.txt: byte 6: expected a range [cm], found '?\?'");
}

}  // namespace
}  // namespace helixnav::logs
