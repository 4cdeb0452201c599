// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/cekf/compressed_ekf.hpp"
#include "innovation.hpp"

namespace helixnav::cekf {

core::LandmarkId CompressedEkf::augment(const core::Observation& observation, const core::Pose2& T_robot_sensor) {
  check_observation_of({active_.next_id, observation, T_robot_sensor}, "augment");
  const core::LocatedLandmark located = core::locate_landmark(observation, active_.pose, T_robot_sensor);

  const int n = active_.dimension();
  active_.P.resize(n + 2, n + 2);
  active_.A.resize(active_.weights(), n + 2);
  auto P = active_.P.view();
  auto A = active_.A.view();
  const Eigen::Matrix<double, 3, 2> G = located.G_pose.transpose();
  P.block(0, n, n, 2).noalias() = P.topLeftCorner(n, 3).lazyProduct(G);
  P.block(n, 0, 2, n) = P.block(0, n, n, 2).transpose();
  const Eigen::Matrix2d own = located.G_pose * P.topLeftCorner<3, 3>() * G +
                              located.G_z * Eigen::Matrix2d(observation.R) * located.G_z.transpose();
  P.block<2, 2>(n, n) = 0.5 * (own + own.transpose());
  A.rightCols<2>().noalias() = A.leftCols<3>().lazyProduct(G);

  const core::LandmarkId id = active_.next_id++;
  places_.push_back({Whereabouts::active, active_count()});
  active_.ids.push_back(id);
  active_.slots.push_back(-1);
  active_.points_m.push_back(located.point_world_m);
  ++mapped_;
  return id;
}

}  // namespace helixnav::cekf
