// SPDX-License-Identifier: BSD-3-Clause
#include "closing/duplicate_segment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "helixnav/core/angle.hpp"

namespace helixnav::supervisor {
namespace {

using core::LandmarkId;
using pf_relocalize::Constellation;
using pf_relocalize::ConstellationPair;

constexpr std::size_t most_anchors = 6;
// Ten times what orchards need. A stretch that may be almost anywhere is left to the whole map (search/whole_map).
constexpr std::size_t most_placings = 1000;
// χ² gate of what a copy may be. To first order the true one was beyond 9.2 for most trees of a stretch in one of 50
// orchards; the cost of merging, which is iterated, was 41 for 42 degrees of freedom there.
constexpr double wide_gate = 40.0;
const double least_nats = std::log(1000.0);

struct Copy {
  LandmarkId id;
  std::vector<Leftover> may_be;
  double variance_m2;  ///< of its offset
};

/// Confirmed landmarks that are where an old one may be, best known first.
std::vector<Copy> copies_among(const std::vector<LandmarkId>& confirmed, const cekf::CompressedEkf& filter,
                               const std::vector<LandmarkId>& old, const SearchOptions& options,
                               const core::MapAppearance& appearance) {
  const std::vector<LandmarkId> ids = held_by(filter, confirmed);
  std::vector<double> look_m;
  for (const LandmarkId id : ids) {
    look_m.push_back(options.leftover_most_m + std::sqrt(wide_gate) * filter.landmark_sigma_bound_m(id));
  }
  auto may_be = compatible(filter, ids, old, look_m, {wide_gate, options.duplicate_sigma_m, appearance});
  std::vector<Copy> copies;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (may_be[i].empty()) continue;
    const double variance_m2 = may_be[i].front().information.inverse().trace();
    copies.push_back({ids[i], std::move(may_be[i]), variance_m2});
  }
  std::sort(copies.begin(), copies.end(), [](const Copy& a, const Copy& b) { return a.variance_m2 < b.variance_m2; });
  return copies;
}

/// A place of the stretch in the map, and the evidence for and against it.
struct Placing {
  core::Pose2 T_world_stretch;
  std::vector<ConstellationPair> pairs;
  double nats = 0.0;
};

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

/// Most of its pairs contradict the other's.
bool is_elsewhere(const Placing& placing, const Placing& other) {
  std::map<LandmarkId, LandmarkId> old_of;
  for (const ConstellationPair& pair : other.pairs) old_of[pair.branch] = pair.old_landmark;
  const auto contradictions = std::count_if(placing.pairs.begin(), placing.pairs.end(), [&](const auto& pair) {
    const auto found = old_of.find(pair.branch);
    return found != old_of.end() && found->second != pair.old_landmark;
  });
  return 2 * static_cast<std::size_t>(contradictions) > placing.pairs.size();
}

/// One stretch and the old ground around it. Its frame is the map before the closing, moved to the best-known copy.
class Stretch {
 public:
  Stretch(Constellation ground, const cekf::CompressedEkf& filter, const SearchOptions& options)
      : ground_(std::move(ground)), filter_(filter), options_(options) {
    for (const auto& landmark : ground_.branch) at_m_[landmark.id] = landmark.point_robot_m;
  }

  bool holds(LandmarkId id) const { return at_m_.count(id) > 0; }

  /// Every place that brings two far-apart copies onto old landmarks that they may be; none if there are too many.
  std::vector<Placing> placings(const std::vector<Copy>& copies) const {
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

  double nats(const Placing& placing) const {
    const auto matched = static_cast<double>(placing.pairs.size());
    const auto alone = static_cast<double>(count_alone(placing));
    const std::optional<cekf::CostByPart> merged =
        cost_of(filter_, kept_removed(placing.pairs), options_.merge_sigma_m);
    if (!merged) return -std::numeric_limits<double>::infinity();
    return std::lgamma(matched + 1.0) + std::lgamma(alone + 1.0) - std::lgamma(matched + alone + 2.0) -
           0.5 * (merged->cost - merged->dof);
  }

 private:
  /// False if there are too many to try.
  bool add_placings(const Copy& a, const Copy& b, std::vector<Placing>& found, std::size_t& tried) const {
    if (a.id == b.id) return true;
    const Eigen::Vector2d& a_m = at_m_.at(a.id);
    const Eigen::Vector2d& b_m = at_m_.at(b.id);
    for (const Leftover& to_a : a.may_be) {
      for (const Leftover& to_b : b.may_be) {
        const Eigen::Vector2d to_a_m = filter_.landmark_mean(to_a.kept);
        const Eigen::Vector2d to_b_m = filter_.landmark_mean(to_b.kept);
        if (std::abs((to_b_m - to_a_m).norm() - (b_m - a_m).norm()) > options_.stretch_rigid_m) continue;
        if (++tried > most_placings) return false;
        Placing placing{motion_between(a_m, b_m, to_a_m, to_b_m), {}};
        placing.pairs = score_constellation(ground_, placing.T_world_stretch, options_.constellation).pairs;
        const bool known = std::any_of(found.begin(), found.end(),
                                       [&](const Placing& other) { return same_pairs(other.pairs, placing.pairs); });
        const bool enough = static_cast<int>(placing.pairs.size()) >= options_.constellation.least_matches;
        if (enough && !known) found.push_back(std::move(placing));
      }
    }
    return true;
  }

  /// Landmarks of either drive without a partner, on ground that both looked at.
  int count_alone(const Placing& placing) const {
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

  Constellation ground_;
  const cekf::CompressedEkf& filter_;
  const SearchOptions& options_;
  std::map<LandmarkId, Eigen::Vector2d> at_m_;  ///< of the branch
};

std::vector<core::Pose2> near(std::vector<core::Pose2> poses, const Eigen::Vector2d& point_m, double reach_m) {
  poses.erase(std::remove_if(poses.begin(), poses.end(),
                             [&](const core::Pose2& pose) { return (pose.position_m() - point_m).norm() > reach_m; }),
              poses.end());
  return poses;
}

}  // namespace

DuplicateSegment::DuplicateSegment(const cekf::CompressedEkf& filter, const Branch& branch)
    : confirmed_(held_by(filter, branch.confirmed)),
      old_drive_(branch.old_drive),
      new_drive_(branch.new_drive),
      appearance_(branch.appearance) {
  for (const LandmarkId id : confirmed_) before_m_[id] = filter.landmark_mean(id);
}

KeptRemoved DuplicateSegment::place(const cekf::CompressedEkf& filter, const std::vector<LandmarkId>& old,
                                    const SearchOptions& options) const {
  std::vector<Copy> copies = copies_among(confirmed_, filter, old, options, appearance_);
  if (copies.empty()) return {};
  const double reach_m = options.stretch_m + options.stretch_rim_m + std::sqrt(wide_gate * copies.back().variance_m2);
  const Stretch stretch(ground_around(copies.front().id, reach_m, filter, old, options), filter, options);
  copies.erase(std::remove_if(copies.begin(), copies.end(), [&](const Copy& copy) { return !stretch.holds(copy.id); }),
               copies.end());
  std::vector<Placing> placings = stretch.placings(copies);
  if (placings.empty()) return {};
  for (Placing& placing : placings) placing.nats = stretch.nats(placing);
  std::sort(placings.begin(), placings.end(), [](const Placing& a, const Placing& b) { return a.nats > b.nats; });
  const Placing& best = placings.front();
  const bool has_rival = std::any_of(placings.begin() + 1, placings.end(), [&](const Placing& other) {
    return other.nats > best.nats - least_nats && is_elsewhere(other, best);
  });
  return has_rival ? KeptRemoved{} : kept_removed(best.pairs);
}

Constellation DuplicateSegment::ground_around(LandmarkId middle, double reach_m, const cekf::CompressedEkf& filter,
                                              const std::vector<LandmarkId>& old, const SearchOptions& options) const {
  const Eigen::Vector2d origin_m = before_m_.at(middle);
  const Eigen::Vector2d now_m = filter.landmark_mean(middle);
  Constellation ground;
  for (const LandmarkId id : confirmed_) {
    const Eigen::Vector2d at_m = before_m_.at(id) - origin_m;
    if (!filter.contains(id) || at_m.norm() > options.stretch_m + options.stretch_rim_m) continue;
    ground.branch.push_back({id, at_m, std::numeric_limits<int>::max(), appearance_.of(id)});
  }
  for (const LandmarkId id : filter.landmarks_within(now_m, reach_m)) {
    if (!std::binary_search(old.begin(), old.end(), id)) continue;
    ground.old_landmarks.push_back({id, {filter.landmark_mean(id), Eigen::Matrix2d::Zero()}, appearance_.of(id)});
  }
  ground.population = appearance_.population();
  const double range_m = new_drive_.field_of_view.max_range_m;
  ground.old_drive = old_drive_;
  ground.old_drive.T_frame_sensor = near(old_drive_.T_frame_sensor, now_m, reach_m + range_m);
  ground.new_drive = new_drive_;
  ground.new_drive.T_frame_sensor = near(new_drive_.T_frame_sensor, origin_m, options.stretch_m + range_m);
  const core::Pose2 T_stretch_before(-origin_m.x(), -origin_m.y(), 0.0);
  for (core::Pose2& pose : ground.new_drive.T_frame_sensor) pose = core::compose(T_stretch_before, pose);
  return ground;
}

}  // namespace helixnav::supervisor
