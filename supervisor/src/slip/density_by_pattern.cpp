// SPDX-License-Identifier: BSD-3-Clause
#include "slip/density_by_pattern.hpp"

#include <cmath>
#include <cstddef>

#include <Eigen/LU>

#include "helixnav/core/angle.hpp"

namespace helixnav::supervisor {
namespace {

constexpr double mapped_within = 1.25;  // spacings from a landmark: others were seen there
constexpr double prior_landmarks = 2.0;

}  // namespace

DensityByPattern::DensityByPattern(const RelativeGeometry& geometry, const core::Pose2& T_other_one) {
  const Eigen::Matrix2d turn = core::rotation(T_other_one.heading_rad);
  const std::vector<Eigen::Vector2d>& points_m = geometry.points_m;
  const double mapped_m = mapped_within * median_spacing_m(points_m);
  for (std::size_t a = 0; a < points_m.size(); ++a) {
    const Eigen::Vector2d displaced_m = core::transform(T_other_one, points_m[a]);
    std::size_t nearest = a;
    double nearest_m = mapped_m;
    for (std::size_t b = 0; b < points_m.size(); ++b) {
      const double distance_m = (points_m[b] - displaced_m).norm();
      if (b == a || !(distance_m < nearest_m)) continue;
      nearest = b;
      nearest_m = distance_m;
    }
    if (nearest == a) continue;
    const Eigen::Matrix2d cross_m2 = turn * geometry.covariance_of(a, nearest);
    differences_.push_back({displaced_m - points_m[nearest], turn * geometry.covariance_of(a, a) * turn.transpose() +
                                                                 geometry.covariance_of(nearest, nearest) - cross_m2 -
                                                                 cross_m2.transpose()});
  }
}

double DensityByPattern::per_m2(const Eigen::Matrix2d& seen_covariance_m2) const {
  double sum_per_m2 = 0.0;
  for (const Difference& one : differences_) {
    const Eigen::Matrix2d S = seen_covariance_m2 + one.covariance_m2;
    const double nis = one.difference_m.dot(S.inverse() * one.difference_m);
    sum_per_m2 += std::exp(-0.5 * nis) / (2.0 * core::pi * std::sqrt(S.determinant()));
  }
  return sum_per_m2 / (static_cast<double>(differences_.size()) + prior_landmarks);
}

}  // namespace helixnav::supervisor
