// SPDX-License-Identifier: BSD-3-Clause
#include "closing/stretch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "helixnav/core/angle.hpp"

namespace helixnav::supervisor {
namespace {

using core::LandmarkId;
using pf_relocalize::ConstellationPair;

constexpr std::size_t most_anchors = 6;

/// The motion that brings a and b, at their own distance, to the midpoint and the direction of two others.
core::Pose2 motion_between(const Eigen::Vector2d& a_m, const Eigen::Vector2d& b_m, const Eigen::Vector2d& to_a_m,
                           const Eigen::Vector2d& to_b_m) {
  const Eigen::Vector2d from = b_m - a_m;
  const Eigen::Vector2d to = to_b_m - to_a_m;
  const double turn_rad = core::wrap_to_pi(std::atan2(to.y(), to.x()) - std::atan2(from.y(), from.x()));
  const Eigen::Vector2d shift_m = 0.5 * (to_a_m + to_b_m - Eigen::Rotation2Dd(turn_rad) * (a_m + b_m));
  return {shift_m.x(), shift_m.y(), turn_rad};
}

bool same_pairs(const std::vector<ConstellationPair>& one, const std::vector<ConstellationPair>& other) {
  return std::equal(one.begin(), one.end(), other.begin(), other.end(), [](const auto& a, const auto& b) {
    return a.branch == b.branch && a.old_landmark == b.old_landmark;
  });
}

}  // namespace

bool is_elsewhere(const Placing& placing, const Placing& other) {
  std::map<LandmarkId, LandmarkId> old_of;
  for (const ConstellationPair& pair : other.pairs) old_of[pair.branch] = pair.old_landmark;
  const auto contradictions = std::count_if(placing.pairs.begin(), placing.pairs.end(), [&](const auto& pair) {
    const auto found = old_of.find(pair.branch);
    return found != old_of.end() && found->second != pair.old_landmark;
  });
  return 2 * static_cast<std::size_t>(contradictions) > placing.pairs.size();
}

Stretch::Stretch(pf_relocalize::Constellation ground, const cekf::CompressedEkf& filter, const SearchOptions& options)
    : ground_(std::move(ground)), filter_(filter), options_(options) {
  for (const auto& landmark : ground_.branch) at_m_[landmark.id] = landmark.point_robot_m;
}

std::vector<Placing> Stretch::placings(const std::vector<Copy>& copies) const {
  std::vector<Copy> far = copies;
  std::sort(far.begin(), far.end(),
            [&](const Copy& a, const Copy& b) { return at_m_.at(a.id).norm() > at_m_.at(b.id).norm(); });
  const std::size_t anchors = std::min(most_anchors, copies.size() / 2);
  std::vector<Placing> found;
  std::size_t tried = 0;
  for (std::size_t i = 0; i < anchors; ++i) {
    for (std::size_t j = 0; j < anchors; ++j) {
      if (!add_placings(copies[i], far[j], found, tried)) return {};
    }
  }
  return found;
}

Placing Stretch::placed_at(const core::Pose2& T_world_stretch) const {
  return {T_world_stretch, score_constellation(ground_, T_world_stretch, options_.constellation).pairs};
}

double Stretch::nats_of_partners(const Placing& placing) const {
  const auto matched = static_cast<double>(placing.pairs.size());
  const auto alone = static_cast<double>(count_alone(placing));
  return std::lgamma(matched + 1.0) + std::lgamma(alone + 1.0) - std::lgamma(matched + alone + 2.0);
}

double Stretch::nats(const Placing& placing) const {
  const std::optional<cekf::CostByPart> merged = cost_of(filter_, kept_removed(placing.pairs), options_.merge_sigma_m);
  if (!merged) return -std::numeric_limits<double>::infinity();
  return nats_of_partners(placing) - 0.5 * (merged->cost - merged->dof);
}

bool Stretch::add_placings(const Copy& a, const Copy& b, std::vector<Placing>& found, std::size_t& tried) const {
  if (a.id == b.id) return true;
  const Eigen::Vector2d& a_m = at_m_.at(a.id);
  const Eigen::Vector2d& b_m = at_m_.at(b.id);
  for (const Leftover& to_a : a.may_be) {
    for (const Leftover& to_b : b.may_be) {
      const Eigen::Vector2d to_a_m = filter_.landmark_mean(to_a.kept);
      const Eigen::Vector2d to_b_m = filter_.landmark_mean(to_b.kept);
      if (std::abs((to_b_m - to_a_m).norm() - (b_m - a_m).norm()) > options_.stretch_rigid_m) continue;
      if (++tried > most_placings) return false;
      Placing placing = placed_at(motion_between(a_m, b_m, to_a_m, to_b_m));
      const bool known = std::any_of(found.begin(), found.end(),
                                     [&](const Placing& other) { return same_pairs(other.pairs, placing.pairs); });
      const bool enough = static_cast<int>(placing.pairs.size()) >= options_.constellation.least_matches;
      if (enough && !known) found.push_back(std::move(placing));
    }
  }
  return true;
}

int Stretch::count_alone(const Placing& placing) const {
  std::map<LandmarkId, bool> paired;
  for (const ConstellationPair& pair : placing.pairs) paired[pair.branch] = paired[pair.old_landmark] = true;
  int alone = 0;
  for (const auto& landmark : ground_.branch) {
    if (paired.count(landmark.id) > 0 || landmark.point_robot_m.norm() > options_.stretch_m) continue;
    if (ground_.old_drive.covers(core::transform(placing.T_world_stretch, landmark.point_robot_m))) ++alone;
  }
  const core::Pose2 T_stretch_world = core::inverse(placing.T_world_stretch);
  for (const auto& landmark : ground_.old_landmarks) {
    const Eigen::Vector2d at_m = core::transform(T_stretch_world, landmark.point.mean_m);
    if (paired.count(landmark.id) > 0 || at_m.norm() > options_.stretch_m) continue;
    if (ground_.new_drive.covers(at_m)) ++alone;
  }
  return alone;
}

}  // namespace helixnav::supervisor
