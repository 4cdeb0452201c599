// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "helixnav/core/time.hpp"
#include "table_reader.hpp"

namespace helixnav::logs {

/// What a column holds, which determines the units its name may end in.
enum class Measure { time, length, angle, speed, turn_rate, number, text };

/// A column that a table may have: "heading" of Measure::angle is recognised as heading, heading_rad, heading_deg,
/// "heading [deg]".
struct ColumnKind {
  std::string_view name;
  Measure measure = Measure::number;
  std::vector<std::string_view> other_names = {};
};

/// Which columns of a table are which.
class TableColumns {
 public:
  /// Throws core::InputError, with the place, for a column that occurs twice, and for an unknown one spelt nearly like
  /// a known one that is missing. Other unknown columns are `unused()`.
  TableColumns(std::string path, const std::vector<ColumnKind>& kinds, const std::vector<std::string>& header,
               const std::vector<std::size_t>& header_columns, std::size_t header_line);

  bool has(std::size_t kind) const { return found_[kind].cell != nowhere; }
  const std::vector<std::string>& unused() const { return unused_; }
  const std::string& path() const { return path_; }
  std::size_t header_line() const { return header_line_; }

  /// As in the header, else as one would write it.
  std::string name_of(std::size_t kind) const;

  /// "path:line:1: no column …": throws unless the column exists.
  void require(std::size_t kind) const;

  [[noreturn]] void fail_header(const std::string& message) const { fail_at(path_, header_line_, 1, message); }

  static constexpr std::size_t nowhere = static_cast<std::size_t>(-1);
  struct Found {
    std::size_t cell = nowhere;
    double factor = 1.0;  ///< times the number in the cell: s, m, rad, m/s, rad/s
    bool nanoseconds = false;
  };
  const Found& found(std::size_t kind) const { return found_[kind]; }

 private:
  void add(std::size_t cell, std::size_t column);
  [[noreturn]] void fail_twice(std::size_t kind, std::size_t cell, std::size_t column) const;
  void judge_unknown();

  struct Unknown {
    std::string name;
    std::size_t column;
  };
  std::string path_;
  const std::vector<ColumnKind>* kinds_;
  std::vector<std::string> header_;
  std::size_t header_line_;
  std::vector<Found> found_;
  std::vector<Unknown> unknown_;
  std::vector<std::string> unused_;
};

/// One row read by TableColumns. Valid as long as the table it is from.
class Row {
 public:
  Row(const TableColumns& columns, const std::vector<Cell>& cells, std::size_t line)
      : columns_(columns), cells_(cells), line_(line) {}

  /// The column exists and its cell is not empty.
  bool has(std::size_t kind) const { return columns_.has(kind) && !cell(kind).text.empty(); }

  /// Finite, in SI units; core::InputError with the place otherwise.
  double number(std::size_t kind) const;
  double number_between(std::size_t kind, double low, double high) const;
  double positive(std::size_t kind) const;
  /// A bearing, direction or turn within ±2π.
  double angle(std::size_t kind) const;
  std::string_view text(std::size_t kind) const { return cell(kind).text; }
  core::Nanoseconds time(std::size_t kind) const;

  [[noreturn]] void fail(std::size_t kind, const std::string& message) const;

  std::size_t line() const { return line_; }
  const TableColumns& columns() const { return columns_; }

 private:
  const Cell& cell(std::size_t kind) const { return cells_[columns_.found(kind).cell]; }

  const TableColumns& columns_;
  const std::vector<Cell>& cells_;
  std::size_t line_;
};

}  // namespace helixnav::logs
