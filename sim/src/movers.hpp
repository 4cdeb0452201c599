// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/random.hpp"
#include "helixnav/sim/route.hpp"
#include "helixnav/sim/scenario.hpp"
#include "vehicle.hpp"

namespace helixnav::sim {

/// Objects that move along the road, each at its own speed and distance from the centre line; nothing beyond its ends.
/// Test: sim/movers_test.cpp.
class Movers {
 public:
  /// Draws as many as are in view on average over the scans of `steps`: each is in view at some time of the drive.
  Movers(const Scenario& scenario, const Route& road, const std::vector<DriveStep>& steps, std::uint64_t seed);

  /// World frame; a point for each that is on the road at that time.
  std::vector<Eigen::Vector2d> at(double t_s) const;

 private:
  struct Mover {
    double met_s = 0.0;
    double met_at_m = 0.0;   ///< along the road
    double speed_mps = 0.0;  ///< along the road, negative against it
    double to_left_m = 0.0;  ///< of its middle
  };

  Mover draw(const MoverOptions& options, const core::FieldOfView& view, const std::vector<DriveStep>& steps,
             double period_s, core::RandomStream& random) const;
  bool is_on_road(const Mover& mover, double t_s) const;
  Eigen::Vector2d place_m(const Mover& mover, double t_s) const;
  double scans_in_view(const Mover& mover, const Scenario& scenario, const std::vector<DriveStep>& steps) const;

  const Route& road_;
  std::vector<Mover> movers_;
};

}  // namespace helixnav::sim
