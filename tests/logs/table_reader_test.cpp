// SPDX-License-Identifier: BSD-3-Clause
#include "own/tables/table_reader.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "input_error.hpp"
#include "temporary_folder.hpp"

namespace helixnav::logs {
namespace {

using testing::input_error_of;
using Table = std::vector<std::vector<std::string>>;

class TableReaderTest : public ::testing::Test {
 protected:
  Table read(const std::string& text) const {
    TableReader reader(folder_.write("a.csv", text));
    Table table{reader.header()};
    std::vector<Cell> cells;
    while (reader.next(cells)) {
      table.emplace_back();
      for (const Cell& cell : cells) table.back().emplace_back(cell.text);
    }
    return table;
  }
  std::string error(const std::string& text) const {
    return input_error_of([&] { read(text); });
  }
  testing::TemporaryFolder folder_;
};

TEST_F(TableReaderTest, TakesCommasSemicolonsAndTabsByTheHeader) {
  const Table expected{{"a", "b"}, {"1", "2"}};
  EXPECT_EQ(read("a,b\n1,2\n"), expected);
  EXPECT_EQ(read("a;b\n1;2\n"), expected);
  EXPECT_EQ(read("a\tb\n1\t2\n"), expected);
}

TEST_F(TableReaderTest, PassesOverByteOrderMarkCarriageReturnsCommentsAndEmptyLines) {
  const Table expected{{"a", "b"}, {"1", "2"}, {"3", "4"}};
  EXPECT_EQ(read("\xEF\xBB\xBF"
                 "a,b\r\n1,2\r\n\r\n# nothing\r\n3,4"),
            expected);
}

TEST_F(TableReaderTest, TakesQuotedCellsWithSeparatorsAndDoubledQuotes) {
  const Table expected{{"a,b", "c"}, {"x \"y\"", "2"}, {"", ""}};
  EXPECT_EQ(read("\"a,b\",c\n\"x \"\"y\"\"\" , 2\n\"\",\n"), expected);
}

TEST_F(TableReaderTest, NamesThePlaceOfARowWithTooManyOrTooFewCells) {
  EXPECT_NE(error("a,b\n1,2\n1,2,3\n").find("a.csv:3:5: expected 2 cells as in the first line, found 3"),
            std::string::npos);
  EXPECT_NE(error("a,b\n1\n").find("a.csv:2:2: expected 2 cells"), std::string::npos);
}

TEST_F(TableReaderTest, RefusesNothingNumbersForAHeaderAndOpenQuotes) {
  EXPECT_NE(error("").find("a.csv:1:1: expected a line that names the columns"), std::string::npos);
  EXPECT_NE(error("\n# only this\n").find("found nothing"), std::string::npos);
  EXPECT_NE(error("1,2\n3,4\n").find("a.csv:1:1: expected a line that names the columns, found numbers"),
            std::string::npos);
  EXPECT_NE(error("a,b\n1,\"2\n").find("a.csv:2:3: the quote that opens here is not closed"), std::string::npos);
  EXPECT_NE(error("a,b\n\"1\"2,3\n").find("a.csv:2:4: expected a separator"), std::string::npos);
}

TEST_F(TableReaderTest, ReadsRowsAcrossItsBlocksUnharmed) {
  std::string text = "number,text\n";
  constexpr int rows = 200'000;  // 3 MB: several blocks
  for (int i = 0; i < rows; ++i) text += std::to_string(i) + ",\"row " + std::to_string(i) + "\"\n";
  TableReader reader(folder_.write("long.csv", text));
  std::vector<Cell> cells;
  int count = 0;
  for (; reader.next(cells); ++count) {
    ASSERT_EQ(cells[0].text, std::to_string(count));
    ASSERT_EQ(cells[1].text, "row " + std::to_string(count));
  }
  EXPECT_EQ(count, rows);
  EXPECT_EQ(reader.line_number(), static_cast<std::size_t>(rows) + 1);
}

}  // namespace
}  // namespace helixnav::logs
