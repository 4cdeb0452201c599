// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/smoothing/problem.hpp"

namespace helixnav::smoothing {

/// How measurements made with a constant (a scale, a mounting, a delay) change with it, per unit of it.
struct ConstantDerivative {
  std::vector<Eigen::Vector3d> increments;  ///< [pose edge] of T_from_to
  std::vector<Eigen::Vector3d> mountings;   ///< [landmark edge] of T_robot_sensor
};

/// What a solved problem says about constants, with all poses and landmarks integrated out: near the solution,
/// the minimum χ² is χ² + 2 gᵀd + dᵀSd for constants changed by d.
struct ConstantsEvidence {
  Eigen::VectorXd gradient;     ///< g
  Eigen::MatrixXd information;  ///< S: the Schur complement of H in the normal equations of everything
};

/// Throws as optimize(); PreconditionError when a derivative and the problem differ in their number of edges.
/// Cost: a factorisation, and a solve for each constant.
/// Test: smoothing/constants_test.cpp (against the minimum χ² of changed measurements).
ConstantsEvidence evidence_of_constants(const Problem& solved, const std::vector<ConstantDerivative>& constants);

}  // namespace helixnav::smoothing
