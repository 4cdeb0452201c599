// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/cekf/reserved_matrix.hpp"
#include "helixnav/core/landmark_id.hpp"
#include "helixnav/core/numerical_health.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::cekf {

/// Scratch space of an update, kept between updates so that none allocates. The "involved" columns are the vehicle's
/// three and two for each landmark seen; H is m × involved.
struct UpdateWorkspace {
  std::vector<int> involved;              ///< for each column of H, its column in the active part
  std::vector<core::LandmarkId> ids;      ///< landmarks involved, in the order of their columns
  std::vector<int> landmark_of_row;       ///< for each match (or pair), its index in ids
  core::Pose2 pose;                       ///< where the measurement is linearised
  std::vector<Eigen::Vector2d> points_m;  ///< same, for the landmarks involved

  ReservedMatrix H;     ///< m × involved
  ReservedMatrix R;     ///< m × m
  ReservedMatrix nu;    ///< m × 1
  ReservedMatrix P;     ///< covariance of the involved columns
  ReservedMatrix L;     ///< S = L·Lᵀ
  ReservedMatrix G;     ///< L⁻¹H
  ReservedMatrix y;     ///< L⁻¹ν
  ReservedMatrix gain;  ///< involved × 1: the correction is P(:, involved)·gain

  // The covariance of (active; weights) changes by left·rightᵀ, left = [W n g], right = [−W g n], W = P(:,
  // involved)·Gᵀ.
  ReservedMatrix picked_active, picked_weights;  ///< involved columns of P and of A
  ReservedMatrix left_active, left_weights;
  ReservedMatrix right_active, right_weights;
  ReservedMatrix delta_active, delta_weights;  ///< correction δ, then Δ of the retraction
  ReservedMatrix variances;                    ///< diagonal of the active covariance after the update

  ReservedMatrix scale;          ///< 1/√S_ii
  core::NumericalHealth health;  ///< of the updates since it was last taken
};

}  // namespace helixnav::cekf
