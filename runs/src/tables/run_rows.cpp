// SPDX-License-Identifier: BSD-3-Clause
#include "run_rows.hpp"

#include <cmath>

#include "helixnav/core/errors.hpp"
#include "helixnav/files/file.hpp"
#include "helixnav/files/number_text.hpp"

namespace helixnav::runs {

namespace {

void split(std::string_view line, char separator, std::vector<std::string_view>& cells) {
  cells.clear();
  for (std::size_t end = line.find(separator); end != std::string_view::npos; end = line.find(separator)) {
    cells.push_back(line.substr(0, end));
    line.remove_prefix(end + 1);
  }
  cells.push_back(line);
}

// The names of the columns; a comment sign before them is not one.
std::vector<std::string_view> columns_of(const RunTable& table) {
  std::string_view header = table.header;
  if (header.substr(0, 2) == "# ") header.remove_prefix(2);
  std::vector<std::string_view> columns;
  split(header, table.separator, columns);
  return columns;
}

std::string place(const std::string& path, int line) { return path + ':' + std::to_string(line) + ": "; }

std::string shortened(std::string_view text) {
  return text.size() <= 60 ? std::string(text) : std::string(text.substr(0, 57)) + "...";
}

}  // namespace

void RunRow::refuse(std::size_t column, const std::string& expected) const {
  throw core::InputError(place(path_, line_) + std::string(columns_of(table_)[column]) + " is \"" +
                         shortened(cells_[column]) + "\", expected " + expected);
}

double RunRow::number(std::size_t column) const {
  const auto value = files::parse_number(cells_[column]);
  if (!value) refuse(column, "a number");
  return *value;
}

double RunRow::finite(std::size_t column) const {
  const double value = number(column);
  if (!std::isfinite(value)) refuse(column, "a finite number");
  return value;
}

std::int64_t RunRow::integer(std::size_t column) const {
  const auto value = files::parse_integer(cells_[column]);
  if (!value) refuse(column, "a whole number");
  return *value;
}

std::int64_t RunRow::integer_in(std::size_t column, std::int64_t low, std::int64_t high) const {
  const std::int64_t value = integer(column);
  if (value < low || value > high) {
    refuse(column, "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
  }
  return value;
}

core::Nanoseconds RunRow::seconds(std::size_t column) const {
  const auto value = files::parse_seconds(cells_[column]);
  if (!value) refuse(column, "seconds");
  return *value;
}

bool begins_with(const std::string& path, const RunTable& table) {
  const std::string bytes = files::read_whole_file(path);
  std::string_view line = std::string_view(bytes).substr(0, bytes.find('\n'));
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line == table.header;
}

void for_each_row(const std::string& path, const RunTable& table, const std::function<void(const RunRow&)>& read_row) {
  const std::string bytes = files::read_whole_file(path);
  const std::size_t columns = columns_of(table).size();
  std::vector<std::string_view> cells;
  int line_number = 0;
  std::string_view rest = bytes;
  for (std::size_t end = rest.find('\n'); end != std::string_view::npos; end = rest.find('\n')) {
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    ++line_number;
    if (line_number == 1) {
      if (line == table.header) continue;
      throw core::InputError(place(path, 1) + "header is \"" + shortened(line) + "\", expected \"" +
                             std::string(table.header) + '"');
    }
    split(line, table.separator, cells);
    if (cells.size() != columns) {
      throw core::InputError(place(path, line_number) + std::to_string(cells.size()) + " columns, expected " +
                             std::to_string(columns));
    }
    read_row(RunRow(path, table, line_number, cells));
  }
}

}  // namespace helixnav::runs
