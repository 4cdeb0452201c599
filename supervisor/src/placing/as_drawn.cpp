// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Core>

#include "helixnav/supervisor/joint_map.hpp"
#include "placing/earlier_map.hpp"

namespace helixnav::supervisor {

core::JointMap as_drawn(const core::JointMap& map, double reach_m, double pair_noise_m) {
  const EarlierMap earlier(map);
  const core::JointGaussian& landmarks = earlier.landmarks();
  const auto rows = static_cast<Eigen::Index>(3 + 2 * landmarks.ids.size());
  core::JointMap drawn;
  drawn.joint.ids = landmarks.ids;
  drawn.joint.points_m = landmarks.points_m;
  drawn.joint.covariance = Eigen::MatrixXd::Zero(rows, rows);
  for (std::size_t i = 0; i < landmarks.ids.size(); ++i) {
    const auto row = 3 + 2 * static_cast<Eigen::Index>(i);
    drawn.joint.covariance.block<2, 2>(row, row) = earlier.relative_to_neighbours(i, reach_m).covariance_m2 +
                                                   0.5 * pair_noise_m * pair_noise_m * Eigen::Matrix2d::Identity();
    drawn.states.push_back(core::LandmarkState::mature);
    drawn.observations.push_back(earlier.observations(i));
    if (!map.appearances.empty()) drawn.appearances.push_back(earlier.appearance().of(landmarks.ids[i]));
  }
  drawn.next_name = map.next_name;
  drawn.reach_m = map.reach_m;
  return drawn;
}

}  // namespace helixnav::supervisor
