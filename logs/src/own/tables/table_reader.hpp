// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "helixnav/core/errors.hpp"

namespace helixnav::logs {

/// One cell of a table, with the column in its line where it starts, from 1.
struct Cell {
  std::string_view text;
  std::size_t column = 1;
};

/// Lines of a file of any length, read in blocks: "\n" or "\r\n" ends one, a UTF-8 byte order mark before the first is
/// skipped.
class LineReader {
 public:
  /// Throws core::InputError when the file cannot be read.
  explicit LineReader(const std::filesystem::path& path);

  /// False at the end. `line` is valid until the next call.
  bool next(std::string_view& line);

  std::size_t line_number() const { return number_; }  ///< of the last line, from 1

 private:
  bool fill();

  std::ifstream file_;
  std::string buffer_;
  std::size_t begin_ = 0;
  std::size_t number_ = 0;
};

/// A table with a header, row by row: cells separated by commas, semicolons or tabs, whichever the header has most of,
/// and quoted if they contain one. Empty lines and lines that begin with # are skipped. A row has as many cells as the
/// header, else core::InputError. Memory does not grow with the file. Test: logs/table_reader_test.cpp.
class TableReader {
 public:
  /// Reads the header. Throws core::InputError for a file that cannot be read, is empty or begins with numbers.
  explicit TableReader(const std::filesystem::path& path);

  const std::vector<std::string>& header() const { return header_; }
  const std::vector<std::size_t>& header_columns() const { return header_columns_; }
  std::size_t header_line() const { return header_line_; }

  /// False at the end. `cells` are valid until the next call.
  bool next(std::vector<Cell>& cells);

  std::size_t line_number() const { return lines_.line_number(); }

 private:
  bool next_line(std::string_view& line);
  void split(std::string_view line, std::vector<Cell>& cells);
  std::string_view quoted_cell(std::string_view line, std::size_t& at);

  std::string path_;
  LineReader lines_;
  char separator_ = ',';
  std::vector<std::string> header_;
  std::vector<std::size_t> header_columns_;
  std::size_t header_line_ = 0;
  std::vector<std::string> unquoted_;  ///< cells whose text differs from the file
};

/// A core::InputError that knows its place.
class PlacedInputError : public core::InputError {
 public:
  PlacedInputError(const std::string& path, std::size_t line, std::size_t column, const std::string& message)
      : core::InputError(path + ":" + std::to_string(line) + ":" + std::to_string(column) + ": " + message),
        column_(column),
        message_(message) {}

  std::size_t column() const { return column_; }
  const std::string& message() const { return message_; }  ///< without the place

 private:
  std::size_t column_;
  std::string message_;
};

/// "path:line:column: message" as a PlacedInputError.
[[noreturn]] void fail_at(const std::string& path, std::size_t line, std::size_t column, const std::string& message);

}  // namespace helixnav::logs
