// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/pose_on_map.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "placing/place_by_points.hpp"

namespace helixnav::supervisor {

core::PoseGaussian pose_on_map(const cekf::CompressedEkf& filter, core::LandmarkId next_name) {
  constexpr std::size_t most = 12;
  const core::PoseGaussian pose = filter.pose();
  std::vector<std::pair<double, core::LandmarkId>> near;
  for (const core::LandmarkId id : filter.landmarks()) {
    if (id < next_name) near.emplace_back((filter.landmark_mean(id) - pose.mean.position_m()).norm(), id);
  }
  if (near.size() < 2) return pose;
  std::sort(near.begin(), near.end());
  near.resize(std::min(most, near.size()));
  std::vector<core::LandmarkId> ids;
  for (const auto& [distance_m, id] : near) ids.push_back(id);
  std::sort(ids.begin(), ids.end());
  const core::JointGaussian joint = filter.joint(ids);
  Eigen::MatrixXd error(3, joint.covariance.cols());
  error << Eigen::Matrix3d::Identity(), -place_by_points(joint.pose, joint.points_m);
  const Eigen::Matrix3d relative = error * joint.covariance * error.transpose();
  return {pose.mean, 0.5 * (relative + relative.transpose())};
}

}  // namespace helixnav::supervisor
