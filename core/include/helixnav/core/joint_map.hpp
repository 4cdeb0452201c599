// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/map_factors.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::core {

/// A map with all correlations and the pose at its end: what another session needs to continue in it. A large map holds
/// them as factors. If it is too large for a joint covariance, too, that of `joint` is of the pose alone, 3×3, and
/// `covariances_m2` has those of the landmarks one by one.
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
  std::shared_ptr<const MapFactors> factors = {};
  std::vector<Eigen::Matrix2d> covariances_m2 = {};  ///< [landmark], without a joint covariance
  /// A pose that was given, and is not where the drive ended; known as well relative to the landmarks around it.
  struct Given {
    PoseGaussian pose;
    std::vector<LandmarkId> around;  ///< ascending
  };
  std::optional<Given> given = {};

  bool has_covariance() const { return joint.covariance.rows() == rows_with_landmarks(); }
  Eigen::Index rows_with_landmarks() const { return 3 + 2 * static_cast<Eigen::Index>(joint.ids.size()); }
  Eigen::Matrix2d covariance_m2_of(std::size_t landmark) const {
    const auto row = 3 + 2 * static_cast<Eigen::Index>(landmark);
    return has_covariance() ? Eigen::Matrix2d(joint.covariance.block<2, 2>(row, row)) : covariances_m2[landmark];
  }
};

}  // namespace helixnav::core
