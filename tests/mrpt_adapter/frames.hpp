// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include "helixnav/core/events.hpp"
#include "helixnav/core/observation.hpp"

namespace helixnav::mrpt_adapter::testing {

using mrpt::obs::CActionCollection;
using mrpt::obs::CActionRobotMovement2D;
using mrpt::obs::CObservationBearingRange;
using mrpt::obs::CSensoryFrame;

inline mrpt::system::TTimeStamp stamp(core::Nanoseconds t_ns) {
  return mrpt::system::TTimeStamp(mrpt::Clock::duration(t_ns / 100 + 116'444'736'000'000'000));
}

inline mrpt::math::CMatrixDouble33 matrix(const Eigen::Matrix3d& from) {
  mrpt::math::CMatrixDouble33 to;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) to(r, c) = from(r, c);
  }
  return to;
}

inline CActionCollection action_of(const core::Odometry& odometry) {
  const core::Pose2& T = odometry.T_before_after;
  CActionRobotMovement2D movement;
  movement.poseChange = mrpt::poses::CPosePDFGaussian::Create(mrpt::poses::CPose2D(T.x_m, T.y_m, T.heading_rad),
                                                              matrix(odometry.covariance));
  CActionCollection actions;
  actions.insert(movement);
  return actions;
}

/// What MRPT's types keep of an odometry event: headings are rounded when they are wrapped.
inline core::Odometry as_mrpt_keeps(core::Odometry odometry) {
  core::Pose2& T = odometry.T_before_after;
  T = core::Pose2(T.x_m, T.y_m, mrpt::poses::CPose2D(T.x_m, T.y_m, T.heading_rad).phi());
  return odometry;
}

/// What MRPT's types keep of a scan: ranges and bearings in single precision.
inline core::Scan as_mrpt_keeps(core::Scan scan) {
  for (core::Observation& observation : scan.observations) {
    observation.z(0) = static_cast<float>(observation.z(0));
    observation.z(1) = core::wrap_to_pi(static_cast<float>(observation.z(1)));
  }
  core::FieldOfView& view = scan.field_of_view;
  view.min_range_m = static_cast<float>(view.min_range_m);
  view.max_range_m = static_cast<float>(view.max_range_m);
  const auto whole = static_cast<float>(view.max_bearing_rad - view.min_bearing_rad);
  view.max_bearing_rad = static_cast<double>(whole) / 2.0;
  view.min_bearing_rad = -view.max_bearing_rad;
  if (view.max_bearing_rad >= core::pi - 1e-6) view.min_bearing_rad = -(view.max_bearing_rad = core::pi);
  return scan;
}

inline std::shared_ptr<CObservationBearingRange> observation_of(const core::Scan& scan,
                                                                const std::vector<std::int64_t>& names = {}) {
  auto observation = std::make_shared<CObservationBearingRange>();
  const core::Pose2& T = scan.T_robot_sensor;
  observation->timestamp = stamp(scan.t_ns);
  observation->sensorLocationOnRobot = mrpt::poses::CPose3D(T.x_m, T.y_m, 0.5, T.heading_rad, 0.0, 0.0);
  observation->minSensorDistance = static_cast<float>(scan.field_of_view.min_range_m);
  observation->maxSensorDistance = static_cast<float>(scan.field_of_view.max_range_m);
  observation->fieldOfView_yaw =
      static_cast<float>(scan.field_of_view.max_bearing_rad - scan.field_of_view.min_bearing_rad);
  observation->validCovariances = true;
  for (std::size_t i = 0; i < scan.observations.size(); ++i) {
    const core::Observation& seen = scan.observations[i];
    CObservationBearingRange::TMeasurement measured;
    measured.range = static_cast<float>(seen.z(0));
    measured.yaw = static_cast<float>(seen.z(1));
    measured.pitch = 0.0F;
    measured.landmarkID = names.empty() ? -1 : static_cast<std::int32_t>(names[i]);
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    covariance.topLeftCorner<2, 2>() = seen.R;
    measured.covariance = matrix(covariance);
    observation->sensedData.push_back(measured);
  }
  return observation;
}

inline CSensoryFrame frame_of(const core::Scan& scan, const std::vector<std::int64_t>& names = {}) {
  CSensoryFrame frame;
  frame.insert(observation_of(scan, names));
  return frame;
}

}  // namespace helixnav::mrpt_adapter::testing
