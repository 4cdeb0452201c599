// SPDX-License-Identifier: BSD-3-Clause
#include "packed_ellipse.hpp"

#include <algorithm>
#include <cmath>

#include "helixnav/core/angle.hpp"
#include "packed.hpp"

namespace helixnav::reports {
namespace {

std::int64_t by_doublings(double sigma_m) {
  constexpr double least_m = 1e-3;
  return sigma_m > least_m ? quantised(24.0 * std::log2(sigma_m / least_m), 1.0) : 0;
}

}  // namespace

void PackedEllipses::add(const Eigen::Matrix2d& covariance_m2) {
  const double middle = 0.5 * covariance_m2.trace();
  const double difference = 0.5 * (covariance_m2(0, 0) - covariance_m2(1, 1));
  const double radius = std::hypot(difference, covariance_m2(0, 1));
  const double angle_rad = 0.5 * std::atan2(covariance_m2(0, 1), difference);
  major_.push_back(by_doublings(std::sqrt(std::max(middle + radius, 0.0))));
  less_.push_back(major_.back() - by_doublings(std::sqrt(std::max(middle - radius, 0.0))));
  angle_.push_back(quantised(angle_rad, core::pi / 64.0));
}

Json PackedEllipses::json() const {
  return {{"a", packed(major_, 1)}, {"b_less", packed(less_, 0)}, {"angle", packed(angle_, 1)}};
}

}  // namespace helixnav::reports
