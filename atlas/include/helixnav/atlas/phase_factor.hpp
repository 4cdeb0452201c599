// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/atlas/phase_log.hpp"
#include "helixnav/atlas/relative_gaussian.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/landmark_id.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::atlas {

/// Where the poses and points of a phase are, in the frame of the pose where it begins.
struct PhaseShape {
  std::vector<core::Pose2> T_entry_robot;  ///< one for each step of the log; the last is the exit
  std::vector<core::LandmarkId> ids;       ///< increasing: landmarks_of(log)
  std::vector<Eigen::Vector2d> points_m;   ///< in the order of ids
};

/// Joint estimate of landmarks in the frame of the entry pose; covariance 2n×2n [m²], positive definite.
struct PointPrior {
  std::vector<core::LandmarkId> ids;
  std::vector<Eigen::Vector2d> points_m;
  Eigen::MatrixXd covariance;
};

/// A phase with its interior poses eliminated: its information on its exit and on the landmarks it saw, relative to its entry.
struct PhaseFactor {
  RelativeGaussian gaussian;  ///< of (exit; points in the order of shape.ids), about shape
  PhaseShape shape;           ///< where it was linearised
};

/// Landmarks of a joint estimate in the frame of its pose, including what the uncertainty of that pose adds.
/// Test: atlas/phase_factor_test.cpp.
PointPrior relative_to_pose(const core::JointGaussian& joint);

/// An initial shape by dead reckoning; landmarks are placed where `known` has them, otherwise where the first
/// observation that fixes a point puts them, otherwise 3 m ahead along a bearing or at the measured range. Errors as
/// check_log.
PhaseShape dead_reckon(const PhaseLog& log, const PointPrior* known = nullptr);

/// The factor of a log. `rounds` Gauss–Newton steps from `start` find the linearisation point; `prior` helps to find it
/// and does not enter the factor. The interior poses form a chain, which is eliminated block by block: Λ = H_KK − H_KI
/// H_II⁻¹ H_IK, likewise the vector and χ². Cost O(T·n²) for T steps and n landmarks.
/// Errors: check_log; PreconditionError when the shape does not fit the log; NumericalError when a residual is not
/// finite.
/// Test: atlas/phase_factor_test.cpp (dense Schur complement, 1e-9; the same under any rigid motion).
PhaseFactor derive_factor(const PhaseLog& log, PhaseShape start, const PointPrior* prior = nullptr, int rounds = 3);

/// The factor relinearised about another exit and other points, relative to the entry: these stay fixed, only interior
/// poses move (`rounds` Gauss–Newton steps from those of `old`). Repeated with the solution of the whole, this ends at
/// the optimum of all measurements. Errors as derive_factor. Test: atlas/real_drives_test.cpp.
PhaseFactor rederive_factor(const PhaseLog& log, const PhaseFactor& old, const core::Pose2& T_entry_exit,
                            const std::vector<Eigen::Vector2d>& points_m, int rounds = 3);

}  // namespace helixnav::atlas
