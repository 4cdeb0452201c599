// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/core/random.hpp"
#include "helixnav/sim/world.hpp"

namespace helixnav::sim {

/// Planted trees: one too near to another or to the route is left out.
class Grove {
 public:
  Grove(const Route& route, double road_clearance_m) : route_(route), road_clearance_m_(road_clearance_m) {}

  /// False when there was no room.
  bool plant(const Eigen::Vector2d& point_m, const Stretch& present);

  /// Beside the tree planted last, as its second stem.
  void plant_twin(const Eigen::Vector2d& point_m) { trees_.push_back({point_m, trees_.back().present}); }

  /// Plants on both sides of a stretch of the route, each place with a probability.
  void plant_along(const Stretch& stretch, const WorldOptions& options, double probability, const Stretch& present,
                   core::RandomStream& random) {
    plant_along(route_, stretch, options, probability, present, random);
  }
  /// The same along another road, with the same clearance from the route.
  void plant_along(const Route& road, const Stretch& stretch, const WorldOptions& options, double probability,
                   const Stretch& present, core::RandomStream& random);

  /// Ends the presence of each tree with a probability.
  void fell(double share, double at_m, core::RandomStream& random);

  const std::vector<Tree>& trees() const { return trees_; }

 private:
  const Route& route_;
  double road_clearance_m_;
  std::vector<Tree> trees_;
};

}  // namespace helixnav::sim
