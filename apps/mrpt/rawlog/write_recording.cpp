// SPDX-License-Identifier: BSD-3-Clause
#include "rawlog/write_recording.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <set>
#include <variant>
#include <vector>

#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3D.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/odometry.hpp"
#include "rawlog/rawlog_sink.hpp"
#include "reading/rawlog_movement.hpp"
#include "reading/rawlog_time.hpp"

namespace helixnav::apps {
namespace {

using mrpt::obs::CObservationBearingRange;

/// Range and bearing with their covariance, in whichever form the observation gives it.
struct Polar {
  double range_m;
  double bearing_rad;
  Eigen::Matrix2d covariance;
};

Polar polar_of(const core::Observation& observation, const std::string& log) {
  if (observation.kind == core::ObservationKind::range_bearing) {
    return {observation.z[0], observation.z[1], observation.R};
  }
  if (observation.kind != core::ObservationKind::cartesian) {
    throw core::InputError(
        log + ": CObservationBearingRange holds range and bearing together, and this log has one of them alone");
  }
  const double x = observation.z[0];
  const double y = observation.z[1];
  const double range_m = std::hypot(x, y);
  Eigen::Matrix2d J;
  J << x / range_m, y / range_m, -y / (range_m * range_m), x / (range_m * range_m);
  return {range_m, std::atan2(y, x), J * observation.R * J.transpose()};
}

void set_sensor(const core::Scan& scan, CObservationBearingRange& observation) {
  const core::Pose2& T = scan.T_robot_sensor;
  observation.setSensorPose(mrpt::poses::CPose3D(T.x_m, T.y_m, 0.0, T.heading_rad, 0.0, 0.0));
  const core::FieldOfView& view = scan.field_of_view;
  observation.minSensorDistance = static_cast<float>(view.min_range_m);
  observation.maxSensorDistance = std::isfinite(view.max_range_m) ? static_cast<float>(view.max_range_m) : 0.0F;
  // MRPT's field of view is symmetric.
  const double half_rad = std::max(std::abs(view.min_bearing_rad), std::abs(view.max_bearing_rad));
  observation.fieldOfView_yaw = static_cast<float>(2.0 * half_rad);
  observation.fieldOfView_pitch = 0.0F;
}

class Writer {
 public:
  Writer(const core::Recording& recording, const std::string& path, LandmarkIds ids)
      : recording_(recording), sink_(path), ids_(ids) {}

  RawlogCounts write() {
    for (const core::Event& event : recording_.events) {
      if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
        motion_ = motion_ ? core::chain(*motion_, *odometry) : *odometry;
      } else if (const auto* scan = std::get_if<core::Scan>(&event)) {
        write(*scan);
      } else {
        throw core::InputError(recording_.name + ": position fixes in the map frame have no place in a rawlog");
      }
    }
    sink_.finish();
    return counts_;
  }

 private:
  /// Readers of pairs skip a frame that no action precedes, so a first scan gets one without motion.
  void write(const core::Scan& scan) {
    sink_.write(movement_of(motion_ ? *motion_ : core::no_motion(scan.t_ns)));
    motion_.reset();
    mrpt::obs::CSensoryFrame frame;
    frame.insert(observation_of(scan));
    sink_.write(frame);
    ++counts_.movements;
    ++counts_.scans;
    counts_.observations += scan.observations.size();
  }

  CObservationBearingRange::Ptr observation_of(const core::Scan& scan) {
    auto observation = std::make_shared<CObservationBearingRange>();
    observation->timestamp = rawlog_time(scan.t_ns);
    observation->sensorLabel = "LANDMARKS";
    observation->validCovariances = true;
    set_sensor(scan, *observation);
    std::set<core::Label> taken;
    for (std::size_t i = 0; i < scan.observations.size(); ++i) {
      const Polar polar = polar_of(scan.observations[i], recording_.name);
      CObservationBearingRange::TMeasurement measurement{};
      measurement.range = static_cast<float>(polar.range_m);
      measurement.yaw = static_cast<float>(polar.bearing_rad);
      measurement.landmarkID = landmark_id(i, taken);
      measurement.covariance.setZero();
      for (int row = 0; row < 2; ++row) {
        for (int column = 0; column < 2; ++column) measurement.covariance(row, column) = polar.covariance(row, column);
      }
      observation->sensedData.push_back(measurement);
    }
    return observation;
  }

  std::int32_t landmark_id(std::size_t i, std::set<core::Label>& taken) {
    if (ids_ == LandmarkIds::none || recording_.labels.empty()) return mrpt::obs::INVALID_LANDMARK_ID;
    const core::Label label = recording_.labels[counts_.scans][i];
    if (label == core::no_label) return mrpt::obs::INVALID_LANDMARK_ID;
    if (label > std::numeric_limits<std::int32_t>::max()) {
      throw core::InputError(recording_.name + ": label " + std::to_string(label) + " does not fit MRPT's landmarkID");
    }
    if (taken.insert(label).second) return static_cast<std::int32_t>(label);
    ++counts_.repeated_labels;
    return mrpt::obs::INVALID_LANDMARK_ID;
  }

  const core::Recording& recording_;
  RawlogSink sink_;
  LandmarkIds ids_;
  std::optional<core::Odometry> motion_;  ///< since the last scan
  RawlogCounts counts_;
};

}  // namespace

RawlogCounts write_recording(const core::Recording& recording, const std::string& path, LandmarkIds ids) {
  return Writer(recording, path, ids).write();
}

}  // namespace helixnav::apps
