// SPDX-License-Identifier: BSD-3-Clause
#include "closing/sure_placing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "association/median.hpp"
#include "helixnav/core/rigid_fit.hpp"

namespace helixnav::supervisor {
namespace {

using core::LandmarkId;
using pf_relocalize::ConstellationPair;

const double nats_of_thousand = std::log(1000.0);

std::map<LandmarkId, Eigen::Vector2d> points_of_old(const Stretch& stretch) {
  std::map<LandmarkId, Eigen::Vector2d> points_m;
  for (const auto& landmark : stretch.ground().old_landmarks) points_m[landmark.id] = landmark.point.mean_m;
  return points_m;
}

/// Median distance of a paired old landmark to the nearest other one.
double spacing_about(const Placing& placing, const std::map<LandmarkId, Eigen::Vector2d>& old_m) {
  std::vector<double> nearest_m;
  for (const ConstellationPair& pair : placing.pairs) {
    double least_m = std::numeric_limits<double>::infinity();
    for (const auto& [id, at_m] : old_m) {
      if (id != pair.old_landmark) least_m = std::min(least_m, (at_m - old_m.at(pair.old_landmark)).norm());
    }
    nearest_m.push_back(least_m);
  }
  return median(std::move(nearest_m));
}

/// ln of how much rarer chance is than one in so many tries.
double nats_against_chance(const Stretch& stretch, const Placing& placing, const SearchOptions& options) {
  const pf_relocalize::ConstellationLimits& limits = options.constellation;
  const double spacing_m = spacing_about(placing, points_of_old(stretch));
  double nats = 0.0;
  for (const ConstellationPair& pair : placing.pairs) {
    const double lever_m = limits.lever_rad * stretch.at_m(pair.branch).norm();
    const double tolerance_m = std::min(3.0 * limits.branch_sigma_m + lever_m, limits.most_tolerance_m);
    nats -= std::log(-std::expm1(-std::log(2.0) * std::pow(tolerance_m / spacing_m, 2)));
  }
  const auto pairs = static_cast<double>(placing.pairs.size());
  return nats * (pairs - 1.5) / pairs;
}

/// The stretch moved so that one of its landmarks comes onto another old one, then fitted to the pairs that it has there.
Placing moved_onto(const Stretch& stretch, const Placing& placing, const Eigen::Vector2d& shift_m,
                   const std::map<LandmarkId, Eigen::Vector2d>& old_m) {
  core::Pose2 T = placing.T_world_stretch;
  T.x_m += shift_m.x();
  T.y_m += shift_m.y();
  const Placing moved = stretch.placed_at(T);
  if (moved.pairs.size() < 2) return moved;
  std::vector<Eigen::Vector2d> kept_m, copies_m;
  for (const ConstellationPair& pair : moved.pairs) {
    kept_m.push_back(old_m.at(pair.old_landmark));
    copies_m.push_back(stretch.at_m(pair.branch));
  }
  return stretch.placed_at(core::fit_rigidly(kept_m, copies_m));
}

const ConstellationPair& innermost(const Stretch& stretch, const Placing& placing) {
  return *std::min_element(placing.pairs.begin(), placing.pairs.end(), [&](const auto& a, const auto& b) {
    return stretch.at_m(a.branch).norm() < stretch.at_m(b.branch).norm();
  });
}

/// Whether the old ground has the pattern of the stretch more than once.
bool repeats(const Stretch& stretch, const Placing& placing, const SearchOptions& options) {
  const std::map<LandmarkId, Eigen::Vector2d> old_m = points_of_old(stretch);
  const LandmarkId partner = innermost(stretch, placing).old_landmark;
  const double here_nats = stretch.nats_of_partners(placing);
  return std::any_of(old_m.begin(), old_m.end(), [&](const auto& other) {
    if (other.first == partner) return false;
    const Placing rival = moved_onto(stretch, placing, other.second - old_m.at(partner), old_m);
    return static_cast<int>(rival.pairs.size()) >= options.constellation.least_matches &&
           is_elsewhere(rival, placing) && stretch.nats_of_partners(rival) > here_nats - nats_of_thousand;
  });
}

}  // namespace

bool is_surely_placed(const Stretch& stretch, const Placing& placing, const SearchOptions& options) {
  static const double tries_nats = std::log(static_cast<double>(Stretch::most_placings));
  return stretch.count_alone(placing) < static_cast<int>(placing.pairs.size()) &&
         nats_against_chance(stretch, placing, options) > nats_of_thousand + tries_nats &&
         !repeats(stretch, placing, options);
}

}  // namespace helixnav::supervisor
