// SPDX-License-Identifier: BSD-3-Clause
#include "search/old_ground_index.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "placing/index_traits.hpp"
#include "placing/relative_covariance.hpp"

namespace helixnav::supervisor {
namespace {

using core::LandmarkId;

constexpr std::size_t most_neighbours = 11;
constexpr std::size_t at_once = 40;

/// The landmark itself, and the nearest others of `old` within reach. It is not certain to be among those within reach:
/// if parts of the passive map have moved far apart since they were left, some are missed
/// (CompressedEkf::landmarks_within).
std::vector<LandmarkId> neighbours_of(LandmarkId id, const cekf::CompressedEkf& filter,
                                      const std::vector<LandmarkId>& old, double reach_m) {
  const Eigen::Vector2d at_m = filter.landmark_mean(id);
  std::vector<std::pair<double, LandmarkId>> near;
  for (const LandmarkId other : filter.landmarks_within(at_m, reach_m)) {
    if (other == id || !std::binary_search(old.begin(), old.end(), other)) continue;
    near.emplace_back((filter.landmark_mean(other) - at_m).norm(), other);
  }
  const std::size_t kept = std::min(most_neighbours, near.size());
  std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(kept), near.end());
  std::vector<LandmarkId> ids{id};
  for (std::size_t i = 0; i < kept; ++i) ids.push_back(near[i].second);
  return ids;
}

/// Where the first of `ids` is, with its uncertainty relative to the others.
core::PointGaussian point_of(const std::vector<LandmarkId>& ids, const core::JointGaussian& joint) {
  std::vector<Eigen::Vector2d> points_m;
  std::vector<Eigen::Index> rows;
  for (const LandmarkId id : ids) {
    const auto at = std::lower_bound(joint.ids.begin(), joint.ids.end(), id) - joint.ids.begin();
    points_m.push_back(joint.points_m[static_cast<std::size_t>(at)]);
    rows.insert(rows.end(), {3 + 2 * at, 4 + 2 * at});
  }
  return {points_m.front(), relative_covariances(points_m, joint.covariance(rows, rows)).front()};
}

}  // namespace

void OldGroundIndex::follow(const cekf::CompressedEkf& filter, const core::MapAppearance& appearance,
                            const std::vector<core::LandmarkId>& old) {
  const auto gone = [&](core::LandmarkId id) {
    if (filter.contains(id)) return false;
    index_.erase(id);
    return true;
  };
  ids_.erase(std::remove_if(ids_.begin(), ids_.end(), gone), ids_.end());
  std::vector<LandmarkId> added;
  for (const LandmarkId id : old) {
    if (index_.contains(id) || !filter.contains(id)) continue;
    if (index_.has_room_at(filter.landmark_mean(id))) added.push_back(id);
  }
  for (std::size_t i = 0; i < added.size(); i += at_once) {
    insert({added.begin() + static_cast<std::ptrdiff_t>(i),
            added.begin() + static_cast<std::ptrdiff_t>(std::min(i + at_once, added.size()))},
           filter, appearance, old);
  }
  if (added.empty()) return;
  const auto is_held = [&](LandmarkId id) { return index_.contains(id); };
  std::copy_if(added.begin(), added.end(), std::back_inserter(ids_), is_held);
  std::sort(ids_.begin(), ids_.end());
  index_.look_around_landmarks();
}

/// With one joint covariance for all, which costs little more than for one.
void OldGroundIndex::insert(const std::vector<LandmarkId>& added, const cekf::CompressedEkf& filter,
                            const core::MapAppearance& appearance, const std::vector<LandmarkId>& old) {
  const relocalize::IndexOptions& lengths = index_.options();
  std::vector<std::vector<LandmarkId>> neighbours;
  std::vector<LandmarkId> all;
  for (const LandmarkId id : added) {
    neighbours.push_back(neighbours_of(id, filter, old, lengths.reach_m));
    all.insert(all.end(), neighbours.back().begin(), neighbours.back().end());
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  const core::JointGaussian joint = filter.joint(all);
  const Eigen::Matrix2d half_m2 = 0.5 * lengths.pair_noise_m * lengths.pair_noise_m * Eigen::Matrix2d::Identity();
  for (const std::vector<LandmarkId>& one : neighbours) {
    relocalize::Landmark landmark;
    landmark.id = one.front();
    landmark.point = point_of(one, joint);
    if (!index_.has_room_at(landmark.point.mean_m)) continue;  // of the first ones, that begin the index
    landmark.point.covariance_m2 += half_m2;
    tell_traits(appearance.of(landmark.id), landmark);
    index_.insert(landmark);
  }
}

}  // namespace helixnav::supervisor
