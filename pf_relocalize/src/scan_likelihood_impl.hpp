// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/pf_relocalize/scan_likelihood.hpp"
#include "pair_sum.hpp"

namespace helixnav::pf_relocalize {

struct ScanLikelihood::Impl {
  explicit Impl(const ReferenceMap& map, const SensorModel& model) : table(map), sensor(model) {}

  void evaluate_block(const ParticleBlock& block, double* out) const;

  /// out[p] −= P_D · (number of landmarks in the field of view of particle p).
  void subtract_expected(const ParticleBlock& block, double* out) const;

  LandmarkTable table;
  SensorModel sensor;
  std::vector<RobotPoint> points;
  double density_ratio_m2 = 0.0;  // P_D / λ
  bool with_visibility = false;
  ViewSector sector{};
};

}  // namespace helixnav::pf_relocalize
