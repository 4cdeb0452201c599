// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "columns.hpp"
#include "helixnav/logs/own_log.hpp"

namespace helixnav::logs {

/// Times of one table: rows out of order by at most a second are counted, others refused.
class RowTimes {
 public:
  core::Nanoseconds take(const Row& row, std::size_t column);
  std::size_t out_of_order() const { return out_of_order_; }
  double latest_s() const { return core::seconds(latest_ns_); }

 private:
  core::Nanoseconds latest_ns_ = std::numeric_limits<core::Nanoseconds>::min();
  std::size_t out_of_order_ = 0;
};

/// Words, numbered in the order in which they appear.
class WordNumbers {
 public:
  std::int64_t of(std::string_view word);
  const std::vector<std::string>& words() const { return words_; }

 private:
  std::map<std::string, std::int64_t, std::less<>> numbers_;
  std::vector<std::string> words_;
};

/// The number that an identity is, from 0 and below 2⁵³; nothing for a name.
std::optional<std::int64_t> whole_number(const std::string& word);

/// The tables of a log as they are filled. Each reads the rows of one kind: begin() once its columns are known (again,
/// if they change, as in JSON Lines), add() for each row. finish() sorts, numbers identities and reports what was done.
class OwnTables {
 public:
  enum class Table { odometry, detections, fixes, truth_poses, truth_landmarks, lost };
  static constexpr std::array all{Table::odometry,    Table::detections,      Table::fixes,
                                  Table::truth_poses, Table::truth_landmarks, Table::lost};
  static constexpr std::size_t table_count = all.size();
  static std::string_view name_of(Table table);
  static const std::vector<ColumnKind>& columns_of(Table table);

  /// `rows_alone`: each row names its own columns, and a row may contain only a time.
  explicit OwnTables(bool rows_alone) : rows_alone_(rows_alone) {}

  /// Throws core::InputError for columns that do not form such a table.
  void begin(Table table, const TableColumns& columns);
  void add(Table table, const Row& row);
  OwnLog finish(std::string name);

  /// What was added since the last call, in order of arrival and without a name, for input that comes line by line:
  /// sensors and identities (by id_names) are numbered within it alone, and the order of times is checked within it,
  /// too.
  OwnLog take_rows();

 private:
  void begin_odometry(const TableColumns& columns);
  void begin_detections(const TableColumns& columns);
  void add_odometry(const Row& row);
  void add_detection(const Row& row);
  void add_fix(const Row& row);
  void add_true_pose(const Row& row);
  void add_true_landmark(const Row& row);
  void remark(const std::string& text);
  void sort_all();
  void drop_repeated_detections();
  void drop_repeated_increments();
  void number_identities();

  bool rows_alone_;
  OwnLog log_;
  bool odometry_known_ = false;
  RowTimes times_[table_count];
  WordNumbers ids_, sensors_;
};

}  // namespace helixnav::logs
