// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/pf_relocalize/scan_likelihood.hpp"
#include "tile_sum.hpp"

namespace helixnav::pf_relocalize {

struct ScanLikelihood::Impl {
  explicit Impl(const ReferenceMap& map, const SensorModel& model) : table(map), sensor(model) {}

  void evaluate_tile(ParticleTile& tile, double* out) const;

  /// out[p] −= P_D · (number of landmarks in the field of view of particle p).
  void subtract_expected(ParticleTile& tile, double* out) const;

  LandmarkTable table;
  SensorModel sensor;
  std::vector<RobotPoint> points;
  double density_ratio_m2 = 0.0;  // P_D / λ
  bool with_visibility = false;
  ViewSector sector{};
  double view_reach_m = 0.0;  // of the field of view from the robot's reference point
};

}  // namespace helixnav::pf_relocalize
