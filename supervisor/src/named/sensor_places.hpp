// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/landmark_id.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::supervisor {

/// A past place of the sensor as points of the filter: its position, and for bearings a second point ahead of it.
struct SensorClone {
  core::LandmarkId position = core::no_landmark;
  core::LandmarkId ahead = core::no_landmark;
};

/// `ahead_m`: to the second point, none if not positive. `sigma_m`: keeps the covariance positive definite.
SensorClone clone_sensor(cekf::CompressedEkf& filter, const core::Pose2& T_robot_sensor, double ahead_m,
                         double sigma_m);
void remove_clone(cekf::CompressedEkf& filter, const SensorClone& clone);

/// Places of the sensor relative to the robot now, and how they depend on the map.
struct SensorPlaces {
  core::JointGaussian joint;                ///< of the points of the clones
  std::vector<core::Pose2> T_robot_sensor;  ///< heading 0 where the clone has none
  Eigen::MatrixXd by_map;                   ///< errors of the places by those of (pose, points)
  Eigen::MatrixXd covariance;               ///< (x, y, heading) of each
};
SensorPlaces sensor_places(const cekf::CompressedEkf& filter, const std::vector<SensorClone>& clones);

}  // namespace helixnav::supervisor
