// SPDX-License-Identifier: BSD-3-Clause
#include "placing/earlier_map.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "placing/index_traits.hpp"
#include "placing/relative_covariance.hpp"

namespace helixnav::supervisor {

EarlierMap::EarlierMap(const core::JointMap& map) : next_name_(map.next_name) {
  const core::JointGaussian& all = map.joint;
  const auto n = static_cast<Eigen::Index>(3 + 2 * all.ids.size());
  const bool fits = map.states.size() == all.ids.size() && map.observations.size() == all.ids.size() &&
                    (map.appearances.empty() || map.appearances.size() == all.ids.size()) &&
                    all.points_m.size() == all.ids.size() && all.covariance.rows() == n && all.covariance.cols() == n &&
                    std::is_sorted(all.ids.begin(), all.ids.end()) &&
                    (all.ids.empty() || (all.ids.front() >= 0 && all.ids.back() < next_name_));
  if (!fits) throw core::PreconditionError("earlier map: its parts do not fit each other");
  std::vector<Eigen::Index> rows{0, 1, 2};
  landmarks_.pose = all.pose;
  for (std::size_t i = 0; i < all.ids.size(); ++i) {
    if (map.states[i] != core::LandmarkState::mature) continue;
    landmarks_.ids.push_back(all.ids[i]);
    landmarks_.points_m.push_back(all.points_m[i]);
    observations_.push_back(map.observations[i]);
    if (!map.appearances.empty()) appearance_.adopt(all.ids[i], map.appearances[i]);
    const auto row = 3 + 2 * static_cast<Eigen::Index>(i);
    rows.insert(rows.end(), {row, row + 1});
  }
  landmarks_.covariance = all.covariance(rows, rows);
}

core::PointGaussian EarlierMap::relative_to_neighbours(std::size_t landmark, double reach_m) const {
  constexpr std::size_t most = 12;
  const Eigen::Vector2d& at_m = landmarks_.points_m[landmark];
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t i = 0; i < landmarks_.points_m.size(); ++i) {
    const double distance_m = (landmarks_.points_m[i] - at_m).norm();
    if (distance_m <= reach_m) near.emplace_back(distance_m, i);
  }
  const auto kept = static_cast<std::ptrdiff_t>(std::min(most, near.size()));
  std::partial_sort(near.begin(), near.begin() + kept, near.end());
  near.resize(static_cast<std::size_t>(kept));
  std::vector<Eigen::Vector2d> points_m;
  std::vector<Eigen::Index> rows;
  std::size_t own = 0;
  for (std::size_t k = 0; k < near.size(); ++k) {
    if (near[k].second == landmark) own = k;
    points_m.push_back(landmarks_.points_m[near[k].second]);
    const auto row = 3 + 2 * static_cast<Eigen::Index>(near[k].second);
    rows.insert(rows.end(), {row, row + 1});
  }
  return {at_m, relative_covariances(points_m, landmarks_.covariance(rows, rows))[own]};
}

relocalize::MapIndex EarlierMap::index(const relocalize::IndexOptions& lengths) const {
  const double half_m2 = 0.5 * lengths.pair_noise_m * lengths.pair_noise_m;
  const double farthest_m = 3e5 * lengths.pair_noise_m;  // beyond, an index cannot hold it, and nobody drives there
  std::vector<relocalize::Landmark> landmarks;
  for (std::size_t i = 0; i < landmarks_.ids.size(); ++i) {
    if ((landmarks_.points_m[i] - landmarks_.points_m[0]).norm() > farthest_m) continue;
    relocalize::Landmark& landmark = landmarks.emplace_back();
    landmark.id = landmarks_.ids[i];
    landmark.point = relative_to_neighbours(i, lengths.reach_m);
    landmark.point.covariance_m2 += half_m2 * Eigen::Matrix2d::Identity();
    tell_traits(appearance_.of(landmark.id), landmark);
  }
  relocalize::MapIndex index(lengths, landmarks);
  index.look_around_landmarks();
  return index;
}

}  // namespace helixnav::supervisor
