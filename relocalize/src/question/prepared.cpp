// SPDX-License-Identifier: BSD-3-Clause
#include "question/prepared.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <Eigen/LU>

#include "helixnav/core/errors.hpp"

namespace helixnav::relocalize {

namespace {

void refuse(const std::string& why) { throw core::PreconditionError("question: " + why); }

void check(const Question& question) {
  for (const Landmark& landmark : question.landmarks) {
    const std::string name = "landmark " + std::to_string(landmark.id);
    if (!landmark.point.mean_m.allFinite()) refuse(name + " has a position that is not finite");
    if (!core::is_symmetric_positive_definite(landmark.point.covariance_m2))
      refuse(name + " has a covariance that is not symmetric positive definite");
    if (landmark.size && !(std::isfinite(landmark.size->mean_m) && landmark.size->sigma_m > 0.0))
      refuse(name + " has a size without a finite mean and a positive sigma");
  }
  for (const Disc& disc : question.looked)
    if (!disc.centre_m.allFinite() || !(disc.radius_m > 0.0) || !std::isfinite(disc.radius_m))
      refuse("looked-at ground needs finite centres and positive radii");
  if (!question.landmarks.empty() && question.looked.empty()) refuse("landmarks, but no ground that was looked at");
  if (!question.prior) return;
  if (!question.prior->T_map_branch.mean.vector().allFinite() ||
      !core::is_symmetric_positive_definite(question.prior->T_map_branch.covariance))
    refuse("the prior needs a finite mean and a symmetric positive definite covariance");
  if (!(question.prior->epsilon > 0.0 && question.prior->epsilon < 1.0)) refuse("the prior's epsilon is not in (0, 1)");
}

/// Length of the union of intervals.
double covered(std::vector<std::pair<double, double>>& intervals) {
  std::sort(intervals.begin(), intervals.end());
  double length = 0.0;
  double end = -std::numeric_limits<double>::infinity();
  for (const auto& [from, to] : intervals) {
    length += std::max(0.0, to - std::max(from, end));
    end = std::max(end, to);
  }
  return length;
}

}  // namespace

double union_area_m2(const std::vector<Disc>& discs) {
  if (discs.empty()) return 0.0;
  if (discs.size() == 1) return core::pi * discs.front().radius_m * discs.front().radius_m;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Disc& disc : discs) {
    low = std::min(low, disc.centre_m.y() - disc.radius_m);
    high = std::max(high, disc.centre_m.y() + disc.radius_m);
  }
  constexpr int strips = 256;
  const double step_m = (high - low) / strips;
  double area_m2 = 0.0;
  std::vector<std::pair<double, double>> chords;
  for (int strip = 0; strip < strips; ++strip) {
    const double y_m = low + (strip + 0.5) * step_m;
    chords.clear();
    for (const Disc& disc : discs) {
      const double dy_m = y_m - disc.centre_m.y();
      const double half_m = std::sqrt(std::max(0.0, disc.radius_m * disc.radius_m - dy_m * dy_m));
      chords.emplace_back(disc.centre_m.x() - half_m, disc.centre_m.x() + half_m);
    }
    area_m2 += step_m * covered(chords);
  }
  return area_m2;
}

Prepared::Prepared(const MapIndex::Parts& parts, const Question& asked)
    : map(parts), question(asked), looked(asked.looked) {
  check(asked);
  const double ground_m2 = map.looked.area_m2();
  if (map.count > 0 && !(ground_m2 > 0.0)) refuse("the map does not say which ground was looked at");
  if (asked.landmarks.empty() || map.count == 0) return;
  for (const Landmark& landmark : asked.landmarks) centre_m += landmark.point.mean_m;
  centre_m /= static_cast<double>(asked.landmarks.size());
  for (const Landmark& landmark : asked.landmarks) {
    const Eigen::Vector2d from_centre_m = landmark.point.mean_m - centre_m;
    points.push_back({static_cast<float>(from_centre_m.x()), static_cast<float>(from_centre_m.y())});
    extent_m = std::max(extent_m, from_centre_m.norm());
  }
  for (Disc& disc : looked) disc.centre_m -= centre_m;
  density_per_m2 = static_cast<double>(points.size()) / union_area_m2(looked);
  ln_poses = std::log(2.0 * core::pi * ground_m2);
  const double map_per_m2 = static_cast<double>(map.count) / ground_m2;
  const double noise_m = map.options.pair_noise_m;
  // Six σ, or less where landmarks are so dense that an eighth of the ground would count as near.
  near_m = std::clamp(std::sqrt(0.12 / (core::pi * map_per_m2)), 3.5 * noise_m, 6.0 * noise_m);
  chance_hit = std::clamp(1.0 - std::exp(-map_per_m2 * core::pi * near_m * near_m), 0.002, 0.6);
}

core::Pose2 Prepared::T_map_branch(const core::Pose2& T_origin_centre) const {
  const core::Pose2 T_map_centre(T_origin_centre.x_m + map.origin_m.x(), T_origin_centre.y_m + map.origin_m.y(),
                                 T_origin_centre.heading_rad);
  return core::compose(T_map_centre, core::Pose2(-centre_m.x(), -centre_m.y(), 0.0));
}

}  // namespace helixnav::relocalize
