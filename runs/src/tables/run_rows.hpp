// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "helixnav/core/time.hpp"
#include "run_tables.hpp"

namespace helixnav::runs {

/// One line of a table. Every accessor throws InputError (file:line, column, what was expected) for any other
/// content.
class RunRow {
 public:
  RunRow(const std::string& path, const RunTable& table, int line, std::vector<std::string_view>& cells)
      : path_(path), table_(table), line_(line), cells_(cells) {}

  std::string_view text(std::size_t column) const { return cells_[column]; }
  double number(std::size_t column) const;
  double finite(std::size_t column) const;
  std::int64_t integer(std::size_t column) const;
  std::int64_t integer_in(std::size_t column, std::int64_t low, std::int64_t high) const;
  core::Nanoseconds seconds(std::size_t column) const;

  [[noreturn]] void refuse(std::size_t column, const std::string& expected) const;

 private:
  const std::string& path_;
  const RunTable& table_;
  int line_;
  std::vector<std::string_view>& cells_;
};

/// Whether the first line of the file is the header of the table; InputError for a missing file.
bool begins_with(const std::string& path, const RunTable& table);

/// Calls `read_row` with every line below the header. A last line without a line end is dropped, even if it is the
/// header. InputError for a missing file, another header, another number of cells.
void for_each_row(const std::string& path, const RunTable& table, const std::function<void(const RunRow&)>& read_row);

}  // namespace helixnav::runs
