// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <string>

#include "own/tables/own_columns.hpp"
#include "own/tables/own_tables.hpp"
#include "plausible.hpp"

namespace helixnav::logs {
namespace {

constexpr double most_detection_m = 1e6;

OwnDetection::Kind kind_of(const Row& row) {
  using namespace detection_columns;
  const bool polar = row.has(range) || row.has(bearing);
  const bool point = row.has(x) || row.has(y);
  if (polar && point) {
    row.fail(x, "a point and a range or bearing in one row; expected one of the two, and empty cells for the other");
  }
  if (point && !row.has(x)) row.fail(x, "expected x and y, found only y");
  if (point && !row.has(y)) row.fail(y, "expected x and y, found only x");
  if (point) return OwnDetection::Kind::cartesian;
  if (row.has(range) && row.has(bearing)) return OwnDetection::Kind::range_bearing;
  if (row.has(range)) return OwnDetection::Kind::range;
  return row.has(bearing) ? OwnDetection::Kind::bearing : OwnDetection::Kind::nothing;
}

double variance(const Row& row, std::size_t column) {
  if (!row.has(column)) return 0.0;
  row.positive(column);
  const double sigma = row.number_between(column, std::sqrt(least_variance), std::sqrt(most_variance));
  return sigma * sigma;
}

/// Both or neither. Of range and bearing one may have no column: then the sensor's value is used.
void read_two_variances(const Row& row, std::size_t first, std::size_t second, OwnDetection& detection) {
  const bool is_point = detection.kind == OwnDetection::Kind::cartesian;
  const bool has_both_columns = row.columns().has(first) && row.columns().has(second);
  if (row.has(first) != row.has(second) && (is_point || has_both_columns)) {
    row.fail(row.has(first) ? second : first,
             "expected both " + row.columns().name_of(first) + " and " + row.columns().name_of(second) + ", found one");
  }
  detection.R = {variance(row, first), 0.0, variance(row, second)};
}

void read_covariance(const Row& row, OwnDetection& detection) {
  using namespace detection_columns;
  detection.R = {row.positive(cov_xx), row.number(cov_xy), row.positive(cov_yy)};
  if (detection.R[0] * detection.R[2] <= detection.R[1] * detection.R[1]) {
    row.fail(cov_xx, "this covariance is not positive definite");
  }
}

void read_appearance(const Row& row, OwnDetection& detection) {
  using namespace detection_columns;
  constexpr double least_m = 1e-6;
  constexpr double most_m = 1e4;
  if (row.has(class_name)) {
    if (row.text(class_name).size() > core::ClassName::most_bytes) {
      row.fail(class_name, "expected a class of at most " + std::to_string(core::ClassName::most_bytes) +
                               " bytes; a short name of it will do");
    }
    if (row.text(class_name).find('\0') != std::string::npos) row.fail(class_name, "a zero byte in class");
    detection.class_name = core::ClassName(row.text(class_name));
  }
  if (!row.has(size)) return;
  row.positive(size);
  detection.size_m = row.number_between(size, least_m, most_m);
  if (!row.has(sigma_size)) return;
  row.positive(sigma_size);
  detection.sigma_size_m = row.number_between(sigma_size, least_m, most_m);
}

void read_value(const Row& row, OwnDetection& detection) {
  using namespace detection_columns;
  switch (detection.kind) {
    case OwnDetection::Kind::range_bearing:
      row.positive(range);
      detection.z = {row.number_between(range, 0.0, most_detection_m), row.angle(bearing)};
      return read_two_variances(row, sigma_range, sigma_bearing, detection);
    case OwnDetection::Kind::range:
      row.positive(range);
      detection.z = {row.number_between(range, 0.0, most_detection_m), 0.0};
      detection.R = {variance(row, sigma_range), 0.0, 0.0};
      return;
    case OwnDetection::Kind::bearing:
      detection.z = {row.angle(bearing), 0.0};
      detection.R = {variance(row, sigma_bearing), 0.0, 0.0};
      return;
    case OwnDetection::Kind::cartesian:
      detection.z = {row.number_between(x, -most_detection_m, most_detection_m),
                     row.number_between(y, -most_detection_m, most_detection_m)};
      if (row.has(cov_xx)) return read_covariance(row, detection);
      return read_two_variances(row, sigma_x, sigma_y, detection);
    case OwnDetection::Kind::nothing:
      return;
  }
}

}  // namespace

void OwnTables::begin_detections(const TableColumns& columns) {
  using namespace detection_columns;
  columns.require(t);
  if (columns.has(x) != columns.has(y)) columns.require(columns.has(x) ? y : x);
  if (columns.has(cov_xx)) {
    columns.require(cov_xy);
    columns.require(cov_yy);
  }
  const bool says_anything = columns.has(range) || columns.has(bearing) || columns.has(x);
  if (says_anything || rows_alone_) return;
  columns.fail_header(
      "no detections in these columns: expected range_m and bearing_rad (or bearing_deg), one of the two, "
      "or x_m and y_m");
}

void OwnTables::add_detection(const Row& row) {
  using namespace detection_columns;
  OwnDetection detection;
  detection.t_ns = times_[1].take(row, t);
  detection.kind = kind_of(row);
  read_value(row, detection);
  constexpr std::int64_t most_sensors = 255;
  const std::int64_t of_sensor = sensors_.of(row.has(sensor) ? row.text(sensor) : std::string_view());
  if (of_sensor >= most_sensors) row.fail(sensor, "more than 255 sensors");
  detection.sensor = static_cast<std::uint8_t>(of_sensor);
  if (row.has(id) && row.text(id) != "-1") detection.label = ids_.of(row.text(id));
  read_appearance(row, detection);
  log_.detections.push_back(detection);
}

}  // namespace helixnav::logs
