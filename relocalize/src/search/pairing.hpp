// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "search/hypothesis.hpp"

namespace helixnav::relocalize {

/// A pair that the noise allows.
struct Pairable {
  double chi2 = 0.0;
  Match match;
  core::LandmarkId id = core::no_landmark;  ///< of the map's landmark: breaks ties
  double log_determinant = 0.0;             ///< ln |covariance of the difference|

  bool operator<(const Pairable& other) const {
    if (chi2 != other.chi2) return chi2 < other.chi2;
    return match.point != other.match.point ? match.point < other.match.point : id < other.id;
  }
};

inline constexpr double pair_gate_chi2 = 3.5 * 3.5;

/// A point of the question in the index's coordinates.
inline Eigen::Vector2f laid(const core::Pose2& T_origin_centre, const Point& point) {
  return core::transform(T_origin_centre, Eigen::Vector2d(point.x_m, point.y_m)).cast<float>();
}

/// Calls visit for all landmarks that may be the point's partner: within the gate of χ², and six pair noises.
template <class Visit>
void for_each_pairable(const Prepared& asked, const core::Pose2& T_origin_centre, std::size_t point, Visit&& visit) {
  const Eigen::Vector2f at = laid(T_origin_centre, asked.points[point]);
  asked.map.grid.within(asked.map.nodes, at.x(), at.y(), asked.map.far_pair_m(), [&](Slot slot, float) {
    const Difference d = difference(asked, T_origin_centre, {point, slot});
    const auto& S = d.covariance_m2;
    const double determinant = S(0, 0) * S(1, 1) - S(0, 1) * S(0, 1);
    const double x = d.value_m.x();
    const double y = d.value_m.y();
    const double chi2 = (S(1, 1) * x * x - 2.0 * S(0, 1) * x * y + S(0, 0) * y * y) / determinant;
    if (chi2 <= pair_gate_chi2) visit(Pairable{chi2, {point, slot}, asked.map.details[slot].id, std::log(determinant)});
  });
}

}  // namespace helixnav::relocalize
