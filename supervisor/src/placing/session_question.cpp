// SPDX-License-Identifier: BSD-3-Clause
#include "placing/session_question.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "helixnav/core/angle.hpp"
#include "placing/question_landmarks.hpp"

namespace helixnav::supervisor {
namespace {

constexpr std::size_t most_asked_with = 40;
constexpr double surely_seen = 0.8;  ///< of the reach

/// The largest disc in the view: around the sensor if it looks all around, else ahead of it.
relocalize::Disc disc_in_view(const core::FieldOfView& view, double reach_m, const core::Pose2& T_world_sensor) {
  const double half_rad = 0.5 * (view.max_bearing_rad - view.min_bearing_rad);
  const double range_m = surely_seen * reach_m;
  constexpr double nearly_all_around_rad = 0.8 * core::pi;
  if (half_rad >= nearly_all_around_rad) return {T_world_sensor.position_m(), range_m};
  const double sine = half_rad >= 0.5 * core::pi ? 1.0 : std::sin(half_rad);
  const double radius_m = range_m * sine / (1.0 + sine);
  const double middle_rad = 0.5 * (view.max_bearing_rad + view.min_bearing_rad);
  const Eigen::Vector2d ahead_m(std::cos(middle_rad), std::sin(middle_rad));
  return {core::transform(T_world_sensor, (range_m - radius_m) * ahead_m), radius_m};
}

std::vector<relocalize::Disc> looked_at(const Belief& belief, const core::FieldOfView& view, double reach_m,
                                        double since_path_m, double within_m) {
  const Eigen::Vector2d at_m = belief.filter.pose().mean.position_m();
  std::vector<relocalize::Disc> discs;
  for (const core::Pose2& T_world_sensor :
       belief.coverage.between(since_path_m, std::numeric_limits<double>::infinity())) {
    relocalize::Disc disc = disc_in_view(view, reach_m, T_world_sensor);
    disc.radius_m = std::min(disc.radius_m, within_m - (disc.centre_m - at_m).norm());
    if (disc.radius_m > 0.0) discs.push_back(disc);
  }
  return discs;
}

}  // namespace

LandmarksAbout landmarks_about(const Belief& belief, double seen_within_m, double born_after_path_m) {
  const Eigen::Vector2d at_m = belief.filter.pose().mean.position_m();
  std::vector<std::pair<double, core::LandmarkId>> order;
  for (const association::LandmarkRecord& record : belief.existence.records()) {
    if (record.state != core::LandmarkState::mature) continue;
    if (belief.existence.path_m() - record.last_seen_path_m > seen_within_m) continue;
    if (record.born_path_m <= born_after_path_m || !belief.filter.contains(record.id)) continue;
    order.emplace_back((belief.filter.landmark_mean(record.id) - at_m).norm(), record.id);
  }
  std::sort(order.begin(), order.end());
  LandmarksAbout about;
  if (order.size() > most_asked_with) {
    order.resize(most_asked_with);
    about.within_m = order.back().first;
  }
  for (const auto& [distance_m, id] : order) about.ids.push_back(id);
  return about;
}

relocalize::Question session_question(const Belief& belief, const LandmarksAbout& about, const core::FieldOfView& view,
                                      const relocalize::IndexOptions& lengths, double seen_within_m) {
  std::vector<std::size_t> all(about.ids.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  relocalize::Question question;
  question.landmarks =
      question_landmarks(belief.filter.joint(about.ids), all, lengths.pair_noise_m, belief.existence.appearance());
  const double since_path_m = belief.existence.path_m() - seen_within_m;
  question.looked = looked_at(belief, view, lengths.reach_m, since_path_m, about.within_m);
  return question;
}

}  // namespace helixnav::supervisor
