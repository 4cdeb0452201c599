// SPDX-License-Identifier: BSD-3-Clause
#include "realise.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "associate.hpp"

namespace helixnav::fastslam {
namespace {

/// Only landmarks well inside the view are expected: within this share of its range, and this far from its sides.
constexpr double sure_range = 0.9, sure_edge_rad = 0.1;

/// Near an observation of nothing no landmark counts as absent: within this many σ of the observation.
constexpr double beside_sigmas = 6.0;

Eigen::Vector2d place_of(const Lineages& lineages, LineageId id, const LandmarkRecord& landmark) {
  return lineages.anchor_m(id) + Eigen::Vector2d(landmark.dx_m, landmark.dy_m);
}

}  // namespace

MapUpdate::MapUpdate(const Options& options, const PreparedScan& scan, const Lineages& lineages,
                     const std::vector<LineageId>& births, std::uint16_t look)
    : options_(options),
      scan_(scan),
      lineages_(lineages),
      births_(births),
      look_(look),
      expected_(scan.view, sure_range, sure_edge_rad) {
  const double pd = options.existence.detection_probability, pf = options.existence.false_hit_probability;
  hit_nats_ = static_cast<float>(std::log(pd / pf));
  miss_nats_ = static_cast<float>(std::log((1.0 - pd) / (1.0 - pf)));
}

void MapUpdate::look_around(const std::vector<Eigen::Vector3d>& poses, std::size_t begin, std::size_t end,
                            RealiseScratch& scratch) const {
  scratch.in_reach.clear();
  if (!options_.existence.remove || !expected_.bounded()) return;
  Eigen::Vector2d low = Eigen::Vector2d::Constant(HUGE_VAL), high = -low;
  for (std::size_t i = begin; i < end; ++i) {
    const Eigen::Vector2d sensor_m = TurnedPose(poses[i]).place(scan_.sensor_robot_m);
    low = low.cwiseMin(sensor_m);
    high = high.cwiseMax(sensor_m);
  }
  lineages_.visit(low, high, sure_range * scan_.view.max_range_m,
                  [&](LineageId id) { scratch.in_reach.push_back(id); });
  std::sort(scratch.in_reach.begin(), scratch.in_reach.end());
}

void MapUpdate::apply(const Eigen::Vector3d& pose, const Choice* choices, PersistentMap& map, NodePool& pool,
                      RealiseScratch& scratch) const {
  const TurnedPose turned(pose);
  const std::size_t n = scan_.observations.size();
  for (std::size_t j = 0; j < n; ++j) {
    if (choices[j] < 0) continue;
    update(turned, static_cast<LineageId>(choices[j]), scan_.observations[j], map, pool, scratch);
  }
  count_misses(turned, choices, map, pool, scratch);
  for (std::size_t j = 0; j < n; ++j) {
    if (choices[j] == begins_landmark) give_birth(turned, births_[j], scan_.observations[j], map, pool, scratch);
  }
}

void MapUpdate::update(const TurnedPose& pose, LineageId id, const PreparedObservation& z, PersistentMap& map,
                       NodePool& pool, RealiseScratch& scratch) const {
  LandmarkRecord& landmark = map.write(id, pool);
  const Pair pair = compare(scan_, z, pose, place_of(lineages_, id, landmark));
  const Eigen::Matrix2d P = landmark.covariance_m2().matrix(), PHt = P * pair.H_point.transpose();
  const Eigen::Matrix2d S = pair.H_point * PHt + z.R;
  const Eigen::Matrix2d K = PHt * S.inverse();
  const Eigen::Vector2d step = K * pair.nu;
  const Eigen::Matrix2d after = P - K * PHt.transpose();
  const bool can_be_told = step.norm() < Lineages::farthest_m && after.diagonal().minCoeff() > 0.0;
  if (!can_be_told) return;  // nothing was left of S but rounding
  landmark.dx_m += static_cast<float>(step.x());
  landmark.dy_m += static_cast<float>(step.y());
  landmark.set_covariance_m2({after(0, 0), 0.5 * (after(0, 1) + after(1, 0)), after(1, 1)});
  count_hit(landmark);
  note_reach(id, landmark, scratch);
}

void MapUpdate::count_hit(LandmarkRecord& landmark) const {
  const ExistenceOptions& e = options_.existence;
  if (e.remove) {
    if (landmark.last_hit_look == look_) return;
    landmark.log_odds = std::min(static_cast<float>(e.max_log_odds), landmark.log_odds + hit_nats_);
    landmark.last_hit_look = look_;
  }
  if (landmark.hits < 0xffff) ++landmark.hits;
  if (landmark.hits >= e.mature_looks && (!e.remove || landmark.log_odds >= static_cast<float>(e.mature_log_odds)))
    landmark.mature = 1;
}

bool MapUpdate::is_seen_or_hidden(const TurnedPose& pose, const Choice* choices, LineageId id,
                                  const Eigen::Vector2d& place_m) const {
  for (std::size_t j = 0; j < scan_.observations.size(); ++j) {
    if (choices[j] == static_cast<Choice>(id)) return true;
    if (choices[j] != of_nothing) continue;
    const PreparedObservation& z = scan_.observations[j];
    const Eigen::Vector2d apart_m = place_m - pose.place(z.point_robot_m);
    if (apart_m.squaredNorm() < beside_sigmas * beside_sigmas * z.noise_m2) return true;
  }
  return false;
}

void MapUpdate::count_misses(const TurnedPose& pose, const Choice* choices, PersistentMap& map, NodePool& pool,
                             const RealiseScratch& scratch) const {
  const ExistenceOptions& e = options_.existence;
  for (const LineageId id : scratch.in_reach) {
    const LandmarkRecord* landmark = map.find(id);
    if (landmark == nullptr || landmark->last_miss_look == look_) continue;
    const Eigen::Vector2d place_m = place_of(lineages_, id, *landmark), at_m = in_sensor(scan_, pose, place_m);
    if (!expected_.sees(at_m.x(), at_m.y()) || is_seen_or_hidden(pose, choices, id, place_m)) continue;
    const double death = landmark->mature != 0 ? e.mature_death_log_odds : e.tentative_death_log_odds;
    if (landmark->log_odds + miss_nats_ < static_cast<float>(death)) {
      map.erase(id, pool);
      continue;
    }
    LandmarkRecord& missed = map.write(id, pool);
    missed.log_odds += miss_nats_;
    missed.last_miss_look = look_;
  }
}

void MapUpdate::give_birth(const TurnedPose& pose, LineageId id, const PreparedObservation& z, PersistentMap& map,
                           NodePool& pool, RealiseScratch& scratch) const {
  const Eigen::Vector2d offset_m = pose.place(z.point_robot_m) - lineages_.anchor_m(id);
  const Eigen::Matrix2d G = place_by_observation(scan_, z, pose), P = G * z.R * G.transpose();
  LandmarkRecord& landmark = map.write(id, pool);
  landmark = {
      static_cast<float>(offset_m.x()), static_cast<float>(offset_m.y()), 0.0F, 0.0F, 0.0F, 0.0F, look_, look_, 1, 0};
  landmark.set_covariance_m2({P(0, 0), 0.5 * (P(0, 1) + P(1, 0)), P(1, 1)});
  note_reach(id, landmark, scratch);
}

void MapUpdate::note_reach(LineageId id, const LandmarkRecord& landmark, RealiseScratch& scratch) const {
  const double offset_m = std::sqrt(static_cast<double>(landmark.dx_m) * landmark.dx_m +
                                    static_cast<double>(landmark.dy_m) * landmark.dy_m);
  const double needed_m = offset_m + search_reach_m(options_, landmark);
  if (needed_m > lineages_.reach_m(id)) scratch.growth.emplace_back(id, Lineages::reach_for(needed_m));
}

}  // namespace helixnav::fastslam
