// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <utility>
#include <vector>

#include "helixnav/core/random.hpp"
#include "helixnav/sim/world.hpp"
#include "roads.hpp"

namespace helixnav::sim {

/// A path through a town, how much of it is driven, and where along it a street with trees that was left behind is
/// entered again.
struct TownTour {
  Polyline road;
  double drive_m = 0.0;
  std::vector<double> returns_at_m;
};

/// A square grid of streets. The first one leads from the crossing at the origin along x. Test: sim/town_test.cpp.
class Town {
 public:
  /// Draws which streets are bare.
  Town(const WorldOptions& options, core::RandomStream& random);

  /// A random tour of at least this length, and this long after the last return: at every crossing any street except
  /// the one it comes from. Corners are rounded.
  TownTour tour(double length_m, double drive_on_m, core::RandomStream& random) const;

  /// From crossing to crossing, those that have trees.
  std::vector<Polyline> streets_with_trees() const;

 private:
  using Crossing = std::pair<int, int>;  ///< column and row
  using Street = std::pair<Crossing, Crossing>;

  static Street street(Crossing a, Crossing b) { return a < b ? Street(a, b) : Street(b, a); }
  bool is_on_grid(Crossing crossing) const;
  std::vector<Crossing> neighbours(Crossing crossing) const;
  std::vector<Crossing> draw_crossings(double length_m, core::RandomStream& random) const;
  Eigen::Vector2d at_m(Crossing crossing) const;

  double side_m_;
  int blocks_;
  Crossing start_;
  std::set<Street> bare_;
};

}  // namespace helixnav::sim
