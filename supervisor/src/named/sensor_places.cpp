// SPDX-License-Identifier: BSD-3-Clause
#include "named/sensor_places.hpp"

#include <cmath>
#include <cstddef>

namespace helixnav::supervisor {
namespace {

using core::LandmarkId;
using Index = Eigen::Index;

LandmarkId clone_point(cekf::CompressedEkf& filter, const Eigen::Vector2d& point_robot_m, double sigma_m) {
  return filter.augment(core::make_cartesian(point_robot_m, sigma_m * sigma_m * Eigen::Matrix2d::Identity()), {});
}

/// A point of the map in the frame of the robot, with its derivative by (pose, points).
struct RelativePoint {
  Eigen::Vector2d point_m;
  Eigen::MatrixXd J;
};

RelativePoint relative_point(const core::JointGaussian& joint, std::size_t index) {
  RelativePoint relative;
  const Eigen::Matrix2d R_robot_world = core::rotation(joint.pose.heading_rad).transpose();
  relative.point_m = R_robot_world * (joint.points_m[index] - joint.pose.position_m());
  relative.J.setZero(2, 3 + 2 * static_cast<Index>(joint.ids.size()));
  relative.J.leftCols<2>() = -R_robot_world;
  relative.J.col(2) = Eigen::Vector2d(relative.point_m.y(), -relative.point_m.x());
  relative.J.middleCols<2>(3 + 2 * static_cast<Index>(index)) = R_robot_world;
  return relative;
}

}  // namespace

SensorClone clone_sensor(cekf::CompressedEkf& filter, const core::Pose2& T_robot_sensor, double ahead_m,
                         double sigma_m) {
  SensorClone clone;
  clone.position = clone_point(filter, T_robot_sensor.position_m(), sigma_m);
  if (ahead_m > 0.0) {
    clone.ahead = clone_point(filter, core::transform(T_robot_sensor, Eigen::Vector2d(ahead_m, 0.0)), sigma_m);
  }
  return clone;
}

void remove_clone(cekf::CompressedEkf& filter, const SensorClone& clone) {
  filter.remove(clone.position);
  if (clone.ahead != core::no_landmark) filter.remove(clone.ahead);
}

SensorPlaces sensor_places(const cekf::CompressedEkf& filter, const std::vector<SensorClone>& clones) {
  std::vector<LandmarkId> ids;
  for (const SensorClone& clone : clones) {
    ids.push_back(clone.position);
    if (clone.ahead != core::no_landmark) ids.push_back(clone.ahead);
  }
  SensorPlaces places;
  places.joint = filter.joint(ids);
  places.by_map.setZero(3 * static_cast<Index>(clones.size()), 3 + 2 * static_cast<Index>(ids.size()));
  std::size_t next = 0;
  for (const SensorClone& clone : clones) {
    auto rows = places.by_map.middleRows<3>(3 * static_cast<Index>(places.T_robot_sensor.size()));
    const RelativePoint position = relative_point(places.joint, next++);
    rows.topRows<2>() = position.J;
    double heading_rad = 0.0;
    if (clone.ahead != core::no_landmark) {
      const RelativePoint ahead = relative_point(places.joint, next++);
      const Eigen::Vector2d way_m = ahead.point_m - position.point_m;
      heading_rad = std::atan2(way_m.y(), way_m.x());
      rows.row(2) = Eigen::RowVector2d(-way_m.y(), way_m.x()) / way_m.squaredNorm() * (ahead.J - position.J);
    }
    places.T_robot_sensor.emplace_back(position.point_m.x(), position.point_m.y(), heading_rad);
  }
  const Eigen::MatrixXd covariance = places.by_map * places.joint.covariance * places.by_map.transpose();
  places.covariance = 0.5 * (covariance + covariance.transpose());
  return places;
}

}  // namespace helixnav::supervisor
