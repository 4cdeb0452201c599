// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/pose_landmark_text.hpp"

#include <cstdint>
#include <string_view>
#include <unordered_map>

#include <Eigen/Cholesky>

#include "input_files.hpp"
#include "plausible.hpp"
#include "text_cursor.hpp"

namespace helixnav::logs {
namespace {

core::Nanoseconds time_of_pose(std::size_t pose) { return static_cast<core::Nanoseconds>(pose) * 1'000'000'000; }

core::Scan scan_of_pose(std::size_t pose) {
  core::Scan scan;
  scan.t_ns = time_of_pose(pose);
  return scan;
}

class Reader {
 public:
  Reader(std::string_view text, const std::filesystem::path& path, NoiseColumns columns)
      : cursor_(text, path.string()), columns_(columns) {}

  core::Recording read() {
    while (!cursor_.at_end()) {
      const std::string_view keyword = cursor_.word();
      if (keyword == "ODOMETRY") {
        read_odometry();
      } else if (keyword == "LANDMARK") {
        read_landmark();
      } else if (!keyword.empty() && keyword.front() != '#') {
        cursor_.fail("expected ODOMETRY or LANDMARK, found '" + std::string(keyword.substr(0, 24)) + "'");
      } else {
        cursor_.skip_line();
      }
    }
    if (odometry_.empty()) {
      cursor_.fail("expected at least one ODOMETRY line, found none");
    }
    return recording();
  }

 private:
  void read_odometry() {
    const std::int64_t from = read_name(cursor_, "the number of a pose");
    const std::int64_t to = read_name(cursor_, "the number of the next pose");
    if (scans_.empty()) {
      open_pose(from);
    }
    if (pose_of_number_.count(from) == 0 || pose_of_number_.at(from) + 1 != scans_.size()) {
      cursor_.fail("expected odometry that goes on from the latest pose, found one from " + std::to_string(from));
    }
    if (pose_of_number_.count(to) != 0) {
      cursor_.fail("expected the number of a new pose, found " + std::to_string(to) + " again");
    }
    open_pose(to);
    core::Odometry& odometry = odometry_.emplace_back();
    odometry.t_ns = scans_.back().t_ns;
    const double dx_m = cursor_.number_between(-most_motion_m, most_motion_m, "dx [m]");
    const double dy_m = cursor_.number_between(-most_motion_m, most_motion_m, "dy [m]");
    const double turn_rad = cursor_.number_between(-most_turn_rad, most_turn_rad, "dheading [rad]");
    odometry.T_before_after = core::Pose2(dx_m, dy_m, turn_rad);
    odometry.covariance = read_noise<3>();
    cursor_.end_line("from, to, dx, dy, dheading and 6 of noise");
  }

  void read_landmark() {
    const std::int64_t pose = read_name(cursor_, "the number of a pose");
    const std::int64_t landmark = read_name(cursor_, "the number of a landmark, 0 or more");
    if (landmark < 0) {
      cursor_.fail("expected a landmark number of 0 or more, found " + std::to_string(landmark));
    }
    if (scans_.empty()) {
      open_pose(pose);
    }
    const auto found = pose_of_number_.find(pose);
    if (found == pose_of_number_.end()) {
      cursor_.fail("expected the number of a pose that odometry reached before, found " + std::to_string(pose));
    }
    check_count(cursor_, labels_[found->second].size());
    const double x_m = cursor_.number_between(-most_distance_m, most_distance_m, "x [m]");
    const double y_m = cursor_.number_between(-most_distance_m, most_distance_m, "y [m]");
    scans_[found->second].observations.push_back(core::make_cartesian({x_m, y_m}, read_noise<2>()));
    labels_[found->second].push_back(landmark);
    cursor_.end_line("pose, landmark, x, y and 3 of noise");
  }

  void open_pose(std::int64_t number) {
    pose_of_number_[number] = scans_.size();
    scans_.push_back(scan_of_pose(scans_.size()));
    labels_.emplace_back();
  }

  template <int n>
  Eigen::Matrix<double, n, n> read_noise() {
    using Matrix = Eigen::Matrix<double, n, n>;
    Matrix upper = Matrix::Zero();
    for (int row = 0; row < n; ++row) {
      for (int column = row; column < n; ++column) {
        upper(row, column) = cursor_.number("a noise column");
      }
    }
    if (columns_ == NoiseColumns::recognise) {
      columns_ = upper(0, 0) > 1.0 ? NoiseColumns::square_root_information : NoiseColumns::covariance;
    }
    Matrix covariance = upper.template selfadjointView<Eigen::Upper>();
    if (columns_ == NoiseColumns::square_root_information) {
      const Matrix inverse = upper.template triangularView<Eigen::Upper>().solve(Matrix::Identity());
      covariance = inverse * inverse.transpose();
    }
    if (!covariance.allFinite() || covariance.llt().info() != Eigen::Success) {
      cursor_.fail("expected noise that is positive definite");
    }
    if (const auto fault = fault_of_covariance(covariance)) cursor_.fail("the covariance of this noise " + *fault);
    return covariance;
  }

  core::Recording recording() {
    core::Recording recording;
    recording.labels_are_given = true;
    for (std::size_t pose = 0; pose < scans_.size(); ++pose) {
      if (pose > 0) {
        recording.events.emplace_back(odometry_[pose - 1]);
      }
      recording.events.emplace_back(std::move(scans_[pose]));
    }
    recording.labels = std::move(labels_);
    return recording;
  }

  TextCursor cursor_;
  NoiseColumns columns_;
  std::unordered_map<std::int64_t, std::size_t> pose_of_number_;
  std::vector<core::Odometry> odometry_;  ///< [pose − 1]
  std::vector<core::Scan> scans_;         ///< [pose]
  std::vector<std::vector<core::Label>> labels_;
};

}  // namespace

core::Recording read_pose_landmark_text(const std::filesystem::path& path, NoiseColumns columns) {
  const std::string text = read_file(path);
  core::Recording recording = Reader(text, path, columns).read();
  recording.name = path.stem().string();
  return recording;
}

}  // namespace helixnav::logs
