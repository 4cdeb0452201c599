// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/atlas/relative_gaussian.hpp"
#include "tree/state.hpp"

namespace helixnav::atlas {

/// The pose and the points of a factor relative to its reference, [x, y, heading; x, y; …] (3+2n rows).
Eigen::VectorXd relative_coordinates(const Values& values);

/// A relative factor as information on its variables where they are: rows of the reference, the pose, the points, and last the
/// right-hand side with χ² in its corner, all as a lower triangle of (3+3+2n+1). Values in the same order. With
/// D = blkdiag(R, 1, R, …) and G the motion of everything by the reference: [GᵀWG, −GᵀW; −WG, W], W = DΛDᵀ. Rigid motions of all
/// are its null vectors, to rounding. Cost O(n²). Test: atlas/phase_factor_test.cpp.
Eigen::MatrixXd world_form(const RelativeGaussian& factor, const Values& values);

}  // namespace helixnav::atlas
