// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/atlas/phase_factor.hpp"

namespace helixnav::atlas {

/// Normal equations of a phase about a shape, entry pose fixed. Interior poses 1 … T−1 form a chain: `diagonal[k]` of pose
/// k+1, `next[k]` its coupling to pose k+2; `kept` holds what is left in the order exit, points, right-hand side, as a
/// lower triangle with χ² in its last corner; `to_kept` holds the chain's rows of the same columns.
struct PhaseEquations {
  std::vector<Eigen::Matrix3d> diagonal;
  std::vector<Eigen::Matrix3d> next;
  Eigen::MatrixXd to_kept;
  Eigen::MatrixXd kept;
};

/// Linearises a log about a shape. NumericalError when a residual is not finite.
PhaseEquations linearise(const PhaseLog& log, const PhaseShape& shape);

/// Eliminates the chain: blocks become their Cholesky factors, rows L⁻¹ times themselves, `kept` the Schur complement.
void eliminate_chain(PhaseEquations& equations);

/// Steps of the interior poses, after eliminate_chain, when exit and points move by `kept_step` (3+2n rows).
Eigen::VectorXd chain_step(const PhaseEquations& equations, const Eigen::VectorXd& kept_step);

}  // namespace helixnav::atlas
