// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

namespace helixnav::sim {

/// Part of a route, by distance along it [m].
struct Stretch {
  double from_m = 0.0;
  double to_m = 0.0;
};

/// The path of a vehicle, as a polyline parametrised by the distance along it [m], in the world frame. A road driven
/// twice is in it twice: laps are unrolled. Test: sim/route_test.cpp.
class Route {
 public:
  /// At least two points, no two neighbours equal; else PreconditionError.
  explicit Route(std::vector<Eigen::Vector2d> points_m);

  double length_m() const { return along_m_.back(); }

  /// Point at a distance along the route; beyond the ends, the end point. O(log n).
  Eigen::Vector2d at(double along_m) const;

  /// Unit vector of travel, from the points half a metre before and after. O(log n).
  Eigen::Vector2d direction(double along_m) const;

  /// Distance along the route of the point of `stretch` nearest to a given point. Cost: segments of the stretch.
  double nearest_along_m(const Eigen::Vector2d& point_m, const Stretch& stretch) const;

  /// How far a point is from the whole route. O(n).
  double distance_m(const Eigen::Vector2d& point_m) const;

 private:
  std::size_t segment_of(double along_m) const;

  std::vector<Eigen::Vector2d> points_m_;
  std::vector<double> along_m_;  ///< of each point
};

/// The same polyline, moved so that its route starts at the origin in the direction of x (the map frame of a run).
Route route_from_origin(const std::vector<Eigen::Vector2d>& points_m);

}  // namespace helixnav::sim
