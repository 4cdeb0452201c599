// SPDX-License-Identifier: BSD-3-Clause
#include "closing/duplicate_segment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/LU>

#include "closing/stretch.hpp"
#include "closing/sure_placing.hpp"

namespace helixnav::supervisor {
namespace {

using core::LandmarkId;
using pf_relocalize::Constellation;

// χ² gate of what a copy may be. To first order the true one was beyond 9.2 for most trees of a stretch in one of 50
// orchards; the cost of merging, which is iterated, was 41 for 42 degrees of freedom there.
constexpr double wide_gate = 40.0;
const double least_nats = std::log(1000.0);

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

/// The likeliest placing, unless a rival elsewhere is not a thousand times less likely.
std::optional<Placing> likeliest(const Stretch& stretch, const std::vector<Copy>& copies) {
  std::vector<Placing> placings = stretch.placings(copies);
  if (placings.empty()) return std::nullopt;
  for (Placing& placing : placings) placing.nats = stretch.nats(placing);
  std::sort(placings.begin(), placings.end(), [](const Placing& a, const Placing& b) { return a.nats > b.nats; });
  const Placing& best = placings.front();
  const bool has_rival = std::any_of(placings.begin() + 1, placings.end(), [&](const Placing& other) {
    return other.nats > best.nats - least_nats && is_elsewhere(other, best);
  });
  return has_rival ? std::nullopt : std::optional(best);
}

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
  const Stretch stretch = stretch_about(copies.front().id, copies, filter, old, options);
  const std::optional<Placing> placing = likeliest(stretch, copies);
  return placing ? kept_removed(placing->pairs) : KeptRemoved{};
}

std::optional<KeptRemoved> DuplicateSegment::place_next(const cekf::CompressedEkf& filter,
                                                        const std::vector<LandmarkId>& old,
                                                        const SearchOptions& options,
                                                        std::vector<LandmarkId>& tried) const {
  std::vector<Copy> copies = copies_among(confirmed_, filter, old, options, appearance_);
  const auto is_tried = [&](const Copy& copy) {
    return std::any_of(tried.begin(), tried.end(), [&](LandmarkId other) {
      return (before_m_.at(copy.id) - before_m_.at(other)).norm() <= 0.5 * options.stretch_m;
    });
  };
  const auto middle = std::find_if_not(copies.begin(), copies.end(), is_tried);
  if (middle == copies.end()) return std::nullopt;
  tried.push_back(middle->id);
  const Stretch stretch = stretch_about(tried.back(), copies, filter, old, options);
  const std::optional<Placing> placing = likeliest(stretch, copies);
  const bool is_sure = placing && is_surely_placed(stretch, *placing, options);
  return is_sure ? kept_removed(placing->pairs) : KeptRemoved{};
}

Stretch DuplicateSegment::stretch_about(LandmarkId middle, std::vector<Copy>& copies, const cekf::CompressedEkf& filter,
                                        const std::vector<LandmarkId>& old, const SearchOptions& options) const {
  const double reach_m = options.stretch_m + options.stretch_rim_m + std::sqrt(wide_gate * copies.back().variance_m2);
  Stretch stretch(ground_around(middle, reach_m, filter, old, options), filter, options);
  copies.erase(std::remove_if(copies.begin(), copies.end(), [&](const Copy& copy) { return !stretch.holds(copy.id); }),
               copies.end());
  return stretch;
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
