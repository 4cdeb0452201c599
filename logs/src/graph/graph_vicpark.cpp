// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "helixnav/logs/graph_files.hpp"
#include "mat_file.hpp"
#include "plausible.hpp"

namespace helixnav::logs {
namespace {

constexpr const char* variable = "VicPark_clean_data";

/// Rows of the matrix, sorted by the pose they refer to.
class VicParkReader {
 public:
  explicit VicParkReader(const std::filesystem::path& path) : file_(path), rows_(file_.matrix(variable)) {
    if (rows_.columns != 12)
      file_.fail(std::string(variable) + ": expected 12 columns, found " + std::to_string(rows_.columns));
    recording_.name = path.filename().string();
    recording_.labels_are_given = true;
  }

  core::Recording read() {
    for (std::size_t row = 0; row < rows_.rows; ++row) {
      if (rows_(row, 0) == 1.0) {
        read_motion(row);
      } else if (rows_(row, 0) == 0.0) {
        read_observation(row);
      } else {
        fail(row, "expected 0 (observation) or 1 (motion) in column 1");
      }
    }
    if (motions_.empty() || motions_.rbegin()->first != static_cast<std::int64_t>(motions_.size())) {
      file_.fail(std::string(variable) + ": the motions do not join poses 0, 1, 2 … in one chain");
    }
    assemble();
    return std::move(recording_);
  }

 private:
  struct Seen {
    core::Observation observation;
    core::Label label;
  };

  [[noreturn]] void fail(std::size_t row, const std::string& what) const {
    file_.fail(std::string(variable) + ", row " + std::to_string(row + 1) + ": " + what);
  }

  std::int64_t whole(std::size_t row, std::size_t column, const char* what) const {
    const double value = rows_(row, column);
    if (!(value >= 0.0 && value < 1e9) || value != std::floor(value)) {
      fail(row, std::string("expected ") + what + " in column " + std::to_string(column + 1));
    }
    return static_cast<std::int64_t>(value);
  }

  double within(std::size_t row, std::size_t column, double most) const {
    const double value = rows_(row, column);
    if (std::abs(value) > most) {
      fail(row, "expected at most " + std::to_string(most) + " in column " + std::to_string(column + 1) + ", found " +
                    std::to_string(value));
    }
    return value;
  }

  void read_motion(std::size_t row) {
    const std::int64_t to = whole(row, 2, "the number of a pose");
    if (to != whole(row, 1, "the number of a pose") + 1) fail(row, "expected a motion from one pose to the next");
    core::Odometry odometry;
    odometry.t_ns = core::nanoseconds_from_seconds(static_cast<double>(to));
    odometry.T_before_after =
        core::Pose2(within(row, 3, most_motion_m), within(row, 4, most_motion_m), within(row, 5, most_turn_rad));
    std::size_t column = 6;
    for (int r = 0; r < 3; ++r) {
      for (int c = r; c < 3; ++c) odometry.covariance(r, c) = odometry.covariance(c, r) = rows_(row, column++);
    }
    if (const auto fault = fault_of_covariance(odometry.covariance)) fail(row, "the covariance " + *fault);
    if (!motions_.emplace(to, odometry).second) fail(row, "a second motion to pose " + std::to_string(to));
  }

  void read_observation(std::size_t row) {
    const std::int64_t pose = whole(row, 1, "the number of a pose");
    const core::Label label = whole(row, 2, "the number of a landmark");
    Eigen::Matrix2d C;
    C << rows_(row, 5), rows_(row, 6), rows_(row, 6), rows_(row, 7);
    if (const auto fault = fault_of_covariance(C)) fail(row, "the covariance " + *fault);
    std::vector<Seen>& seen = seen_[pose];
    if (seen.size() >= most_observations) {
      fail(row, "more than " + std::to_string(most_observations) + " observations in one scan");
    }
    const Eigen::Vector2d point_m(within(row, 3, most_distance_m), within(row, 4, most_distance_m));
    seen.push_back({core::make_cartesian(point_m, C), label});
  }

  void assemble() {
    if (seen_.rbegin() != seen_.rend() && motions_.count(std::max<std::int64_t>(1, seen_.rbegin()->first)) == 0) {
      file_.fail(std::string(variable) + ": an observation from pose " + std::to_string(seen_.rbegin()->first) +
                 ", which no motion leads to");
    }
    add_scan(0);
    for (const auto& [pose, odometry] : motions_) {
      recording_.events.emplace_back(odometry);
      add_scan(pose);
    }
  }

  void add_scan(std::int64_t pose) {
    core::Scan scan;
    scan.t_ns = core::nanoseconds_from_seconds(static_cast<double>(pose));
    scan.field_of_view.max_range_m = 0.0;  // the file leaves out detections that its authors did not associate
    std::vector<core::Label> labels;
    for (const Seen& seen : seen_[pose]) {
      scan.observations.push_back(seen.observation);
      labels.push_back(seen.label);
    }
    recording_.events.emplace_back(std::move(scan));
    recording_.labels.push_back(std::move(labels));
  }

  MatFile file_;
  MatMatrix rows_;
  core::Recording recording_;
  std::map<std::int64_t, core::Odometry> motions_;  ///< by the pose that they lead to
  std::map<std::int64_t, std::vector<Seen>> seen_;
};

}  // namespace

core::Recording read_vicpark_clean(const std::filesystem::path& path) { return VicParkReader(path).read(); }

}  // namespace helixnav::logs
