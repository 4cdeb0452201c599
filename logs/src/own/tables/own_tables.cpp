// SPDX-License-Identifier: BSD-3-Clause
#include "own_tables.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <numeric>
#include <tuple>

#include "helixnav/core/errors.hpp"
#include "own_columns.hpp"

namespace helixnav::logs {
namespace {

std::string counted(std::size_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

template <class Entry>
void stable_sort_by_time(std::vector<Entry>& entries) {
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.t_ns < b.t_ns; });
}

/// Covariances go with their rows.
void sort_odometry(OwnLog& log) {
  std::vector<std::size_t> order(log.odometry.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return log.odometry[a].t_ns < log.odometry[b].t_ns; });
  std::vector<OwnOdometry> rows;
  std::vector<Eigen::Matrix3d> covariances;
  for (const std::size_t i : order) {
    rows.push_back(log.odometry[i]);
    if (!log.odometry_covariances.empty()) covariances.push_back(log.odometry_covariances[i]);
  }
  log.odometry = std::move(rows);
  log.odometry_covariances = std::move(covariances);
}

/// Which rows of a scan, from `begin` to `end`, repeat an earlier one. By sorting: a scan may have thousands of rows.
void mark_repeated(const std::vector<OwnDetection>& rows, std::size_t begin, std::size_t end,
                   std::vector<std::size_t>& order, std::vector<bool>& repeated) {
  const auto said = [&](std::size_t i) { return std::tie(rows[i].kind, rows[i].z, rows[i].label); };
  order.resize(end - begin);
  std::iota(order.begin(), order.end(), begin);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return said(a) < said(b); });
  for (std::size_t k = 1; k < order.size(); ++k) repeated[order[k]] = said(order[k]) == said(order[k - 1]);
}

}  // namespace

std::optional<std::int64_t> whole_number(const std::string& word) {
  std::int64_t value = 0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  constexpr std::int64_t most = std::int64_t{1} << 53;
  const bool whole = error == std::errc{} && stop == word.data() + word.size() && value >= 0 && value < most;
  return whole ? std::optional(value) : std::nullopt;
}

core::Nanoseconds RowTimes::take(const Row& row, std::size_t column) {
  constexpr core::Nanoseconds tolerated_ns = 1'000'000'000;
  const core::Nanoseconds t_ns = row.time(column);
  if (latest_ns_ != std::numeric_limits<core::Nanoseconds>::min() && t_ns < latest_ns_) {
    if (latest_ns_ - t_ns > tolerated_ns) {
      char text[160];
      std::snprintf(text, sizeof text, "the time goes back by %.6g s, to %.9g s; rows are sorted within 1 s only",
                    core::seconds(latest_ns_ - t_ns), core::seconds(t_ns));
      row.fail(column, text);
    }
    ++out_of_order_;
  }
  latest_ns_ = std::max(latest_ns_, t_ns);
  return t_ns;
}

std::int64_t WordNumbers::of(std::string_view word) {
  const auto known = numbers_.find(word);
  if (known != numbers_.end()) return known->second;
  const auto number = static_cast<std::int64_t>(words_.size());
  words_.emplace_back(word);
  numbers_.emplace(words_.back(), number);
  return number;
}

void OwnTables::begin(Table table, const TableColumns& columns) {
  for (const std::string& name : columns.unused()) remark(columns.path() + ": column " + name + " is not used");
  switch (table) {
    case Table::odometry:
      return begin_odometry(columns);
    case Table::detections:
      return begin_detections(columns);
    case Table::fixes:
    case Table::truth_poses:
      for (const std::size_t column : {fix_columns::t, fix_columns::x, fix_columns::y}) columns.require(column);
      return;
    case Table::truth_landmarks:
      for (const std::size_t column : {true_landmark_columns::x, true_landmark_columns::y}) columns.require(column);
      return;
    case Table::lost:
      columns.require(lost_columns::t);
  }
}

void OwnTables::remark(const std::string& text) {
  if (std::find(log_.remarks.begin(), log_.remarks.end(), text) == log_.remarks.end()) log_.remarks.push_back(text);
}

void OwnTables::add(Table table, const Row& row) {
  switch (table) {
    case Table::odometry:
      return add_odometry(row);
    case Table::detections:
      return add_detection(row);
    case Table::fixes:
      return add_fix(row);
    case Table::truth_poses:
      return add_true_pose(row);
    case Table::truth_landmarks:
      return add_true_landmark(row);
    case Table::lost:
      log_.lost_ns.push_back(times_[5].take(row, lost_columns::t));
  }
}

constexpr double most_place_m = 1e8;

void OwnTables::add_fix(const Row& row) {
  using namespace fix_columns;
  OwnFix fix;
  fix.t_ns = times_[2].take(row, t);
  fix.position_m = {row.number_between(x, -most_place_m, most_place_m),
                    row.number_between(y, -most_place_m, most_place_m)};
  if (row.has(sigma)) fix.sigma_m = row.positive(sigma);
  log_.fixes.push_back(fix);
}

void OwnTables::add_true_pose(const Row& row) {
  using namespace true_pose_columns;
  const core::Nanoseconds t_ns = times_[3].take(row, t);
  const Eigen::Vector2d position_m(row.number_between(x, -most_place_m, most_place_m),
                                   row.number_between(y, -most_place_m, most_place_m));
  if (row.columns().has(heading)) {
    log_.true_poses.push_back(
        {t_ns, core::Pose2(position_m.x(), position_m.y(), row.number_between(heading, -1e6, 1e6))});
  } else {
    log_.true_positions.push_back({t_ns, position_m});
  }
}

void OwnTables::add_true_landmark(const Row& row) {
  using namespace true_landmark_columns;
  core::TrueLandmark landmark;
  if (row.has(id)) landmark.label = ids_.of(row.text(id));
  landmark.point_m = {row.number_between(x, -most_place_m, most_place_m),
                      row.number_between(y, -most_place_m, most_place_m)};
  log_.true_landmarks.push_back(landmark);
}

void OwnTables::sort_all() {
  for (std::size_t table = 0; table < table_count; ++table) {
    const std::size_t count = times_[table].out_of_order();
    if (count == 0) continue;
    log_.remarks.push_back(std::string(name_of(static_cast<Table>(table))) + ": " + counted(count, "row") +
                           " out of order by less than a second, sorted");
  }
  if (times_[0].out_of_order() > 0) sort_odometry(log_);
  const auto earlier = [](const OwnDetection& a, const OwnDetection& b) {
    return std::tie(a.t_ns, a.sensor) < std::tie(b.t_ns, b.sensor);
  };
  if (!std::is_sorted(log_.detections.begin(), log_.detections.end(), earlier)) {
    std::stable_sort(log_.detections.begin(), log_.detections.end(), earlier);
  }
  std::sort(log_.lost_ns.begin(), log_.lost_ns.end());
  stable_sort_by_time(log_.fixes);
  stable_sort_by_time(log_.true_poses);
  stable_sort_by_time(log_.true_positions);
}

void OwnTables::drop_repeated_detections() {
  std::vector<OwnDetection>& rows = log_.detections;
  std::vector<bool> repeated(rows.size(), false);
  std::vector<std::size_t> order;
  for (std::size_t begin = 0, end = 0; begin < rows.size(); begin = end) {
    const auto is_same_scan = [&](const OwnDetection& row) {
      return row.t_ns == rows[begin].t_ns && row.sensor == rows[begin].sensor;
    };
    while (end < rows.size() && is_same_scan(rows[end])) ++end;
    mark_repeated(rows, begin, end, order, repeated);
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!repeated[i]) rows[kept++] = rows[i];
  }
  if (kept == rows.size()) return;
  log_.remarks.push_back("detections: " + counted(rows.size() - kept, "row") + " that repeat another, left out");
  rows.resize(kept);
}

/// An increment that was sent twice would be driven twice. Where times are so coarse that several increments share one, equal ones may
/// well be two.
void OwnTables::drop_repeated_increments() {
  std::vector<OwnOdometry>& rows = log_.odometry;
  if (log_.odometry_kind != OdometryKind::increments) return;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool shares_time = i > 0 && rows[i].t_ns == rows[i - 1].t_ns;
    if (shares_time && rows[i].value != rows[i - 1].value) return;
    if (!shares_time) kept.push_back(i);
  }
  if (kept.size() == rows.size()) return;
  log_.remarks.push_back("odometry: " + counted(rows.size() - kept.size(), "row") + " that repeat another, left out");
  for (std::size_t k = 0; k < kept.size(); ++k) {
    rows[k] = rows[kept[k]];
    if (!log_.odometry_covariances.empty()) log_.odometry_covariances[k] = log_.odometry_covariances[kept[k]];
  }
  rows.resize(kept.size());
  if (!log_.odometry_covariances.empty()) log_.odometry_covariances.resize(kept.size());
}

void OwnTables::number_identities() {
  std::vector<core::Label> label_of;
  for (const std::string& word : ids_.words()) {
    const std::optional<std::int64_t> number = whole_number(word);
    if (!number) break;
    label_of.push_back(*number);
  }
  log_.has_labels = !ids_.words().empty();
  if (label_of.size() != ids_.words().size()) {
    log_.id_names = ids_.words();
    return;
  }
  const auto renumber = [&](core::Label& label) {
    if (label >= 0) label = label_of[static_cast<std::size_t>(label)];
  };
  for (OwnDetection& detection : log_.detections) renumber(detection.label);
  for (core::TrueLandmark& landmark : log_.true_landmarks) renumber(landmark.label);
}

OwnLog OwnTables::take_rows() {
  OwnLog rows = std::move(log_);
  log_ = OwnLog();
  log_.odometry_kind = rows.odometry_kind;
  odometry_known_ = false;
  rows.sensor_names = sensors_.words();
  rows.id_names = ids_.words();
  sensors_ = WordNumbers();
  ids_ = WordNumbers();
  for (RowTimes& times : times_) times = RowTimes();
  return rows;
}

OwnLog OwnTables::finish(std::string name) {
  if (!log_.odometry_covariances.empty())
    log_.odometry_covariances.resize(log_.odometry.size(), Eigen::Matrix3d::Zero());
  sort_all();
  number_identities();
  drop_repeated_detections();
  drop_repeated_increments();
  log_.name = std::move(name);
  log_.sensor_names = sensors_.words();
  if (log_.sensor_names.empty()) log_.sensor_names.emplace_back();
  return std::move(log_);
}

}  // namespace helixnav::logs
