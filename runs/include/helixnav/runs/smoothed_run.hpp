// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/se2.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::runs {

/// What a smoother made of a run, for trajectory_final.tum and the report. Map frame, metres, radians.
struct SmoothedRun {
  struct LargeResidual {
    std::int64_t step = 0;
    std::string name;  ///< "pose 203 sees landmark 17"
    double nis = 0.0;  ///< eᵀC⁻¹e
    int rows = 0;
  };
  /// One row of a landmark residual over its own σ.
  struct Normalised {
    std::int64_t step = 0;
    double value = 0.0;
  };

  bool alone = false;  ///< no filter ran: the steps hold the start values, and the run's result are the values below
  std::vector<core::Pose2> poses;         ///< [step] as known at the end
  std::vector<core::Pose2> poses_before;  ///< [step] at the start of the solution
  std::vector<core::MapLandmark> map_before;
  std::vector<core::MapLandmark> map_after;
  std::vector<double> chi2;    ///< of the start, then after every iteration
  double chi2_odometry = 0.0;  ///< of the solution
  double chi2_landmarks = 0.0;
  int dof = 0;
  std::vector<LargeResidual> largest;  ///< largest nis per row first
  std::vector<Normalised> normalised_residuals;
};

}  // namespace helixnav::runs
