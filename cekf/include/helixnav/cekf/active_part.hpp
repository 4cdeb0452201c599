// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/cekf/phase_costs.hpp"
#include "helixnav/cekf/reserved_matrix.hpp"
#include "helixnav/core/landmark_id.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::cekf {

/// Everything that changes between two region switches, and what a snapshot copies.
///
/// The state is (vehicle; active landmarks; weights s). The error of a passive landmark is its error at the start of
/// the phase plus E·s, where E is its rows of the phase's basis; the weights are carried as additional states of the
/// same filter:
///   mean of s = theta,  cov(s, active) = A,  cov(s, s) = M,
/// so that P_ab = AᵀEᵀ, P_bb = P_bb0 + E·M·Eᵀ, x_b = x_b0 + E·theta. In THEORY §1 these are Φ = Aᵀ, Ψ = −M, θ = theta.
/// Anchors are the vehicle's coordinates and, for each active landmark, its error relative to the vehicle: the
/// landmark's error minus that of a rigid motion by the vehicle's error. What all have in common is thus one weight,
/// which sightings do not affect, and E·M·Eᵀ has no terms that are larger than their sum by (drift / noise)².
/// One anchor coordinate (a coordinate of the active part at the start of the phase) has one weight in the standard
/// filter and, in the right-invariant one, a pair of weights that rotates like a landmark.
struct ActivePart {
  core::Pose2 pose;
  std::vector<Eigen::Vector2d> points_m;  ///< active landmarks, parallel to ids
  std::vector<core::LandmarkId> ids;
  std::vector<int> slots;                      ///< index in the passive store, −1 for landmarks born in this phase
  ReservedMatrix P;                            ///< (3+2n)², symmetric, both triangles
  ReservedMatrix A;                            ///< q × (3+2n)
  ReservedMatrix M;                            ///< q × q, lower triangle valid
  Eigen::VectorXd theta;                       ///< q
  std::vector<core::LandmarkId> left_passive;  ///< landmarks activated or removed from the passive part in this phase
  std::vector<int> dead_slots;                 ///< slots of landmarks removed in this phase
  std::vector<int> late_anchors;  ///< slots activated in this phase, in order: anchors after the first ones
  core::LandmarkId next_id = 0;
  int last_seen = 0;                               ///< landmarks of the last update
  Eigen::Vector2i cell = Eigen::Vector2i::Zero();  ///< of the vehicle when the region was chosen
  double rows = 0.0;                               ///< of the observations used since the phase began
  PhaseCosts costs;                                ///< of the previous phases

  /// All but P and M.
  ActivePart without_symmetric() const {
    return {pose,         points_m,   ids,          slots,   {},        A,    {},   theta,
            left_passive, dead_slots, late_anchors, next_id, last_seen, cell, rows, costs};
  }
  int dimension() const { return 3 + 2 * static_cast<int>(ids.size()); }
  int weights() const { return static_cast<int>(theta.size()); }
  static int column(int landmark_index) { return 3 + 2 * landmark_index; }
};

}  // namespace helixnav::cekf
