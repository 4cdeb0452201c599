// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "helixnav/core/se2.hpp"

namespace helixnav::pf_relocalize {

/// Weighted poses T_base_robot, one array per coordinate so that loops over particles vectorise. log_weight is up to a
/// common constant. latent[k][i]: coordinate k of particle i's map realisation ξ; empty without latent modes.
struct Particles {
  std::vector<double> x_m, y_m, heading_rad, log_weight;
  std::vector<std::vector<double>> latent;

  std::size_t size() const { return x_m.size(); }
  core::Pose2 pose(std::size_t i) const { return {x_m[i], y_m[i], heading_rad[i]}; }

  /// Sets the number of particles; allocates only beyond the largest number seen so far.
  void resize(std::size_t n) {
    for (auto* column : {&x_m, &y_m, &heading_rad, &log_weight}) column->resize(n);
    for (auto& column : latent) column.resize(n);
  }
  void set_pose(std::size_t i, const core::Pose2& pose) {
    x_m[i] = pose.x_m;
    y_m[i] = pose.y_m;
    heading_rad[i] = pose.heading_rad;
  }
};

/// Sorts a cloud along a space-filling curve through (x, y, heading), coordinates scaled by the cloud's extent, so that
/// neighbours in memory are close together. Resampling keeps that order. Cost O(n log n), allocates; for starts.
void order_by_place(Particles& particles);

}  // namespace helixnav::pf_relocalize
