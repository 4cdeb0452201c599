// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "dlr_frame.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/odometry.hpp"
#include "helixnav/files/file.hpp"
#include "helixnav/files/number_text.hpp"
#include "helixnav/logs/dlr.hpp"
#include "observation_forms.hpp"

namespace helixnav::logs {
namespace {

class DlrWriter {
 public:
  explicit DlrWriter(const core::Recording& recording) : recording_(recording) {
    for (const core::SharedObservation& shared : recording.shared_observations) {
      shared_[{shared.scan, shared.observation}] = shared.labels;
    }
  }

  std::string write() {
    text_ = "# Robot axes: X left, Y backward. STEP image dX dY dPhi CXX CXY CYY CXPhi CYPhi CPhiPhi [m, rad]\n";
    for (const core::Event& event : recording_.events) {
      std::visit([this](const auto& e) { add(e); }, event);
    }
    return std::move(text_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw core::InputError(recording_.name + ": the DLR format cannot hold " + what + " (scan " +
                           std::to_string(scan_) + ")");
  }

  void number(double value) {
    text_ += ' ';
    files::append_number(text_, value == 0.0 ? 0.0 : value);  // no "-0"
  }

  void add(const core::Odometry& odometry) {
    motion_ = moved_ ? core::chain(motion_, odometry) : odometry;
    moved_ = true;
  }

  void add(const core::AbsoluteFix&) { fail("absolute fixes"); }
  void add(const core::Lost&) { fail("a vehicle that was carried"); }

  void add(const core::Scan& scan) {
    if (!moved_) fail("a scan without motion before it");
    add_step();
    for (std::size_t k = 0; k < scan.observations.size(); ++k) {
      const core::Observation& observation = scan.observations[k];
      if (observation.kind == core::ObservationKind::range) fail("ranges without bearings");
      if (observation.kind == core::ObservationKind::bearing) {
        add_line(observation, scan.T_robot_sensor);
      } else {
        add_circle(observation, scan.T_robot_sensor);
      }
      add_ids(k);
    }
    ++scan_;
  }

  void add_step() {
    const Eigen::Vector2d motion_m = to_dlr_axes(motion_.T_before_after.position_m());
    const Eigen::Matrix3d C = to_dlr_axes(motion_.covariance);
    text_ += "STEP step." + std::to_string(scan_);
    for (const double value : {motion_m.x(), motion_m.y(), motion_.T_before_after.heading_rad, C(0, 0), C(0, 1),
                               C(1, 1), C(0, 2), C(1, 2), C(2, 2)}) {
      number(value);
    }
    text_ += '\n';
    moved_ = false;
  }

  void add_circle(const core::Observation& observation, const core::Pose2& T_robot_sensor) {
    if (seen_line_) fail("circles and lines together");
    seen_circle_ = true;
    const PointInRobotFrame point = in_robot_frame(observation, T_robot_sensor);
    const Eigen::Vector2d point_m = to_dlr_axes(point.point_m);
    const Eigen::Matrix2d C = to_dlr_axes(point.covariance_m2);
    text_ += "LANDMARK_C";
    for (const double value : {point_m.x(), point_m.y(), 1.0, C(0, 0), C(0, 1), C(1, 1)}) number(value);
  }

  void add_line(const core::Observation& observation, const core::Pose2& T_robot_sensor) {
    if (seen_circle_) fail("circles and lines together");
    seen_line_ = true;
    text_ += "LANDMARK_L 0 0 0 0";
    number(core::wrap_to_pi(observation.z[0] + T_robot_sensor.heading_rad));
    text_ += " 0 0";
    number(std::sqrt(observation.R(0, 0)));
  }

  void add_ids(std::size_t observation) {
    const auto shared = shared_.find({scan_, observation});
    std::vector<core::Label> ids{core::no_label};
    if (shared != shared_.end()) {
      ids = shared->second;
    } else if (!recording_.labels.empty()) {
      ids = {recording_.labels.at(scan_).at(observation)};
    }
    for (const core::Label id : ids) text_ += ' ' + std::to_string(id);
    text_ += '\n';
  }

  const core::Recording& recording_;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<core::Label>> shared_;
  std::string text_;
  core::Odometry motion_;
  bool moved_ = false;
  bool seen_circle_ = false;
  bool seen_line_ = false;
  std::size_t scan_ = 0;
};

}  // namespace

void write_dlr(const core::Recording& recording, const std::filesystem::path& path) {
  files::write_whole_file(path.string(), DlrWriter(recording).write());
}

}  // namespace helixnav::logs
