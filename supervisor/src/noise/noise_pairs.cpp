// SPDX-License-Identifier: BSD-3-Clause
#include "noise/noise_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include <Eigen/LU>

#include "helixnav/core/angle.hpp"

namespace helixnav::supervisor {
namespace {

constexpr std::size_t most_observations = 24;
constexpr double distinct = 4.0;

double to_next_m(const std::vector<SeenPoint>& seen, std::size_t s) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < seen.size(); ++k) {
    if (k != s) nearest_m = std::min(nearest_m, (seen[k].point_m - seen[s].point_m).norm());
  }
  return nearest_m;
}

struct OnlyLandmark {
  core::LandmarkId id;
  double limit_m;  ///< a quarter of the distance to the next
};

/// The landmark near `point_m` [world], if nothing else within `spacing_m` could be mistaken for it.
std::optional<OnlyLandmark> only_landmark(const cekf::CompressedEkf& filter, const Eigen::Vector2d& point_m,
                                          double spacing_m) {
  core::LandmarkId nearest = core::no_landmark;
  double nearest_m = std::numeric_limits<double>::infinity();
  double second_m = spacing_m;
  for (const core::LandmarkId id : filter.landmarks_within(point_m, spacing_m)) {
    const double distance_m = (filter.landmark_mean(id) - point_m).norm();
    if (distance_m < nearest_m) {
      second_m = std::min(second_m, nearest_m);
      nearest_m = distance_m;
      nearest = id;
    } else {
      second_m = std::min(second_m, distance_m);
    }
  }
  if (distinct * nearest_m >= second_m) return std::nullopt;
  return OnlyLandmark{nearest, second_m / distinct};
}

}  // namespace

bool is_fair(const NoisePair& pair, const Eigen::Matrix2d& S_m2) {
  // Errors cut off there keep 0.76 of their mean square, and the dead band of a factor forgives 0.74.
  constexpr double sigmas = 2.2;
  const double half_trace = 0.5 * S_m2.trace();
  const double largest_m2 = half_trace + std::sqrt(std::max(0.0, half_trace * half_trace - S_m2.determinant()));
  return pair.limit_m * pair.limit_m >= sigmas * sigmas * largest_m2;
}

std::vector<NoisePair> noise_pairs(const cekf::CompressedEkf& filter, const core::Scan& scan) {
  const std::vector<SeenPoint> seen = seen_points(scan, most_observations);
  const core::Pose2 T_world_robot = filter.pose().mean;
  std::vector<NoisePair> pairs;
  for (std::size_t s = 0; s < seen.size(); ++s) {
    const double spacing_m = to_next_m(seen, s);
    if (!std::isfinite(spacing_m)) continue;
    const auto landmark = only_landmark(filter, core::transform(T_world_robot, seen[s].point_m), spacing_m);
    if (landmark) pairs.push_back({seen[s], landmark->id, landmark->limit_m});
  }
  return pairs;
}

void SidesSeen::next_scan() {
  constexpr long forgotten_after = 200;
  ++scan_;
  for (auto side = sides_.begin(); side != sides_.end();) {
    side = scan_ - side->second.scan > forgotten_after ? sides_.erase(side) : std::next(side);
  }
}

bool SidesSeen::is_new_side(core::LandmarkId id, double bearing_to_vehicle_rad) {
  constexpr double another_side_rad = 0.5;
  const auto [side, first] = sides_.try_emplace(id, Side{bearing_to_vehicle_rad, scan_});
  side->second.scan = scan_;
  if (first || std::abs(core::wrap_to_pi(bearing_to_vehicle_rad - side->second.bearing_rad)) < another_side_rad) {
    return false;
  }
  side->second.bearing_rad = bearing_to_vehicle_rad;
  return true;
}

}  // namespace helixnav::supervisor
