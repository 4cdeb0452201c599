// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/relocalize/repetition.hpp"

#include <algorithm>
#include <cstddef>

namespace helixnav::relocalize {
namespace {

/// Points that lie on another one when moved by `way_m`.
std::ptrdiff_t repeated(const std::vector<Eigen::Vector2d>& points_m, const Eigen::Vector2d& way_m,
                        double tolerance_m) {
  return std::count_if(points_m.begin(), points_m.end(), [&](const Eigen::Vector2d& from_m) {
    return std::any_of(points_m.begin(), points_m.end(), [&](const Eigen::Vector2d& to_m) {
      return &from_m != &to_m && (from_m + way_m - to_m).squaredNorm() < tolerance_m * tolerance_m;
    });
  });
}

}  // namespace

double independent_share(const std::vector<Eigen::Vector2d>& points_m, double tolerance_m) {
  if (points_m.size() < 2) return 1.0;
  std::ptrdiff_t most = 1;
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const Eigen::Vector2d way_m = points_m[i] - points_m[k];
      if (way_m.norm() >= tolerance_m) most = std::max(most, repeated(points_m, way_m, tolerance_m));
    }
  }
  const auto count = static_cast<double>(points_m.size());
  return (count - static_cast<double>(most) + 1.0) / count;
}

double independent_share(const MapIndex& map, const Question& question, const Place& place) {
  std::vector<Eigen::Vector2d> paired_m;
  for (const Landmark& landmark : question.landmarks) {
    const bool has_pair = std::any_of(place.pairs.begin(), place.pairs.end(),
                                      [&](const Pair& pair) { return pair.branch == landmark.id; });
    if (has_pair) paired_m.push_back(landmark.point.mean_m);
  }
  return independent_share(paired_m, same_to_m(map.options()));
}

}  // namespace helixnav::relocalize
