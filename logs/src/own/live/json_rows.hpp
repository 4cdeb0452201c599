// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "own/tables/columns.hpp"
#include "own/tables/own_tables.hpp"

namespace helixnav::logs {

/// Lines of JSON Lines as rows of OwnTables: {"odometry": {"t": 0.1, …}}, {"detections": [{…}, {…}]}, with the names of
/// files and columns. Throws PlacedInputError for anything else; rows before the bad one of a line are added.
class JsonRows {
 public:
  explicit JsonRows(std::string path) : path_(std::move(path)) {}

  /// Adds the rows of a line; blank lines have none.
  void read(std::string_view line, std::size_t number, OwnTables& tables);

  /// Whether a row of that table has been met.
  bool has(OwnTables::Table table) const { return states_[static_cast<std::size_t>(table)].columns != nullptr; }

  /// Whether the detections of the last line were in brackets, i.e. all those of a scan together.
  bool last_was_list() const { return list_; }

 private:
  struct State {
    std::vector<std::string> header;
    std::unique_ptr<TableColumns> columns;
  };
  struct Line;  // json_rows.cpp: knows JSON

  const TableColumns& columns_of(OwnTables::Table table, std::size_t number, OwnTables& tables);

  std::string path_;
  bool list_ = false;
  std::array<State, OwnTables::table_count> states_;
  std::vector<std::string> header_, texts_;
  std::vector<std::size_t> places_;
  std::vector<Cell> cells_;
};

}  // namespace helixnav::logs
