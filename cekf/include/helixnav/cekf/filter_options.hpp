// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace helixnav::cekf {

/// How a correction δ = Kν moves the estimate and where the covariance lives afterwards.
/// standard: x + δ. right_invariant: p + V(δθ)·δp for the vehicle and every landmark, heading + δθ, followed by the
/// transport of the covariance to the new point (THEORY §1b); consistent where the standard EKF is not.
enum class Retraction { standard, right_invariant };

/// The active set is the vehicle's cell of the square grid and its eight neighbours.
struct FilterOptions {
  Retraction retraction = Retraction::right_invariant;
  double cell_side_m = 80.0;       ///< side of a cell
  double hysteresis_m = 15.0;      ///< the vehicle must leave its cell by this much before the region switches
  int max_active_landmarks = 120;  ///< above this a switch is due, and only the nearest are made active
};

}  // namespace helixnav::cekf
