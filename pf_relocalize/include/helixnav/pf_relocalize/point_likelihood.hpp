// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/observation.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::pf_relocalize {

/// log p(z | pose) of one observation of one uncertain landmark: the integral of eq (4)-(9) of hybrid_masson2003 over the
/// landmark's position, p(z|x) = ∫ N(m; µ, Σ) p(z | x, m) dm. The density is per unit of z: 1/(m·rad) for range and
/// bearing, 1/m² for cartesian. Kinds with two rows only, else PreconditionError. Not for inner loops.
/// Test: pf_relocalize/point_likelihood_test.cpp (dense quadrature over the table of THEORY §3.1).

/// Closed form with the sensor linearised at the observation: |∂m/∂z|·N(m(z); µ, Σ + G R Gᵀ). Exact for cartesian; for a
/// laser within 1 % unless the map is much tighter than the arc. Σ may be singular.
double log_likelihood_linearised(const core::Observation& observation, const core::Pose2& T_world_robot,
                                 const core::Pose2& T_robot_sensor, const core::PointGaussian& landmark);

/// Adaptive Gauss–Hermite in the noise space about the mode of the integrand, `order` × `order` nodes, order 3 or 5.
/// |Δ log p| ≤ 1e-3 with order 5, over all rows of that table. Σ positive definite, else PreconditionError.
double log_likelihood_gauss_hermite(const core::Observation& observation, const core::Pose2& T_world_robot,
                                    const core::Pose2& T_robot_sensor, const core::PointGaussian& landmark,
                                    int order = 5);

}  // namespace helixnav::pf_relocalize
