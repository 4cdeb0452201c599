// SPDX-License-Identifier: BSD-3-Clause
#include "placing/question_landmarks.hpp"

#include "placing/index_traits.hpp"
#include "placing/relative_covariance.hpp"

namespace helixnav::supervisor {

std::vector<relocalize::Landmark> question_landmarks(const core::JointGaussian& joint,
                                                     const std::vector<std::size_t>& chosen, double pair_noise_m,
                                                     const core::MapAppearance& appearance) {
  std::vector<Eigen::Vector2d> points_m;
  std::vector<Eigen::Index> rows;
  for (const std::size_t i : chosen) {
    points_m.push_back(joint.points_m[i]);
    const auto row = 3 + 2 * static_cast<Eigen::Index>(i);
    rows.insert(rows.end(), {row, row + 1});
  }
  const std::vector<Eigen::Matrix2d> relative = relative_covariances(points_m, joint.covariance(rows, rows));
  const Eigen::Matrix2d half_m2 = 0.5 * pair_noise_m * pair_noise_m * Eigen::Matrix2d::Identity();
  std::vector<relocalize::Landmark> landmarks(chosen.size());
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    landmarks[k].id = joint.ids[chosen[k]];
    landmarks[k].point = {points_m[k], relative[k] + half_m2};
    tell_traits(appearance.of(landmarks[k].id), landmarks[k]);
  }
  return landmarks;
}

}  // namespace helixnav::supervisor
