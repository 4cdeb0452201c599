// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::core {

/// A map with all correlations and the pose at its end: what another session needs to continue in it.
struct JointMap {
  JointGaussian joint;                               ///< ids ascending
  std::vector<LandmarkState> states;                 ///< [landmark] tentative or mature
  std::vector<int> observations;                     ///< [landmark]
  LandmarkId next_name = 0;                          ///< landmarks named later are this one and above
  double reach_m = 0.0;                              ///< of the sensor that mapped it; 0: unknown
  std::vector<LandmarkAppearance> appearances = {};  ///< [landmark], or empty: nothing is known
  std::vector<std::string> drives = {};              ///< what went into it, runs::DriveDigest each; sorted
  /// False for a joined map: each of its sessions ended elsewhere, and nobody continues from its pose.
  bool has_end = true;
};

}  // namespace helixnav::core
