// SPDX-License-Identifier: BSD-3-Clause
#include "search/old_ground_index.hpp"

#include <algorithm>
#include <utility>

#include "placing/relative_covariance.hpp"

namespace helixnav::supervisor {
namespace {

/// The nearest of `old` within reach, the landmark itself first.
std::vector<core::LandmarkId> neighbours_of(core::LandmarkId id, const cekf::CompressedEkf& filter,
                                            const std::vector<core::LandmarkId>& old, double reach_m) {
  constexpr std::size_t most = 12;
  const Eigen::Vector2d at_m = filter.landmark_mean(id);
  std::vector<std::pair<double, core::LandmarkId>> near;
  for (const core::LandmarkId other : filter.landmarks_within(at_m, reach_m)) {
    if (other == id || !std::binary_search(old.begin(), old.end(), other)) continue;
    near.emplace_back((filter.landmark_mean(other) - at_m).norm(), other);
  }
  std::sort(near.begin(), near.end());
  near.resize(std::min(most - 1, near.size()));
  std::vector<core::LandmarkId> ids{id};
  for (const auto& [distance_m, other] : near) ids.push_back(other);
  return ids;
}

/// Where it is, as uncertain as it is relative to its neighbours.
core::PointGaussian point_of(core::LandmarkId id, const cekf::CompressedEkf& filter,
                             const std::vector<core::LandmarkId>& old, double reach_m) {
  const core::JointGaussian joint = filter.joint(neighbours_of(id, filter, old, reach_m));
  const Eigen::Index n = joint.covariance.rows() - 3;
  return {joint.points_m.front(),
          relative_covariances(joint.points_m, joint.covariance.bottomRightCorner(n, n)).front()};
}

}  // namespace

void OldGroundIndex::follow(const cekf::CompressedEkf& filter, const std::vector<core::LandmarkId>& old) {
  const auto gone = [&](core::LandmarkId id) {
    if (filter.contains(id)) return false;
    index_.erase(id);
    return true;
  };
  ids_.erase(std::remove_if(ids_.begin(), ids_.end(), gone), ids_.end());
  const relocalize::IndexOptions& lengths = index_.options();
  const Eigen::Matrix2d half_m2 = 0.5 * lengths.pair_noise_m * lengths.pair_noise_m * Eigen::Matrix2d::Identity();
  const std::size_t before = ids_.size();
  for (const core::LandmarkId id : old) {
    if (index_.contains(id) || !filter.contains(id)) continue;
    relocalize::Landmark landmark;
    landmark.id = id;
    landmark.point = point_of(id, filter, old, lengths.reach_m);
    landmark.point.covariance_m2 += half_m2;
    index_.insert(landmark);
    ids_.push_back(id);
  }
  if (ids_.size() == before) return;
  std::sort(ids_.begin(), ids_.end());
  index_.look_around_landmarks();
}

}  // namespace helixnav::supervisor
