// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/supervisor/slip_options.hpp"
#include "slip/relative_geometry.hpp"

namespace helixnav::supervisor {

/// One component of what may have happened between two scans: δ is normal, zero mean, with these deviations.
struct SlipComponent {
  double sigma_m = 0.0;
  double sigma_rad = 0.0;
  double probability = 0.0;  ///< per scan

  Eigen::Matrix3d covariance() const { return Eigen::Vector3d(sigma_m, sigma_m, sigma_rad).cwiseAbs2().asDiagonal(); }
};

/// Small, middle, large.
std::vector<SlipComponent> slip_components(const SlipOptions& options);

/// What one more pair is worth before it is looked at: ln P_D/(1 − P_D) − ln λ, λ [1/m²] the density of what is in no map.
double pair_nats(double detection_probability, double extraneous_per_m2);

/// How well pairs are explained.
struct SlipExplanation {
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();             ///< the likeliest δ
  Eigen::Matrix3d displacement_covariance = Eigen::Matrix3d::Zero();  ///< of δ, given the pairs
  SlipComponent component;                                            ///< the one that explains best
  double nats = 0.0;
};

/// ln p(component) + m·pair_nats + ln N(ν; 0, S + A Q Aᵀ), linearised at the likeliest δ, of the best component: the
/// price of explaining too much (the Occam factor) is in the determinant. `start`: where the iteration begins. Very low
/// if S is not positive definite. O(m³). Test: supervisor/slip/slip_decision_test.cpp (numeric integration).
SlipExplanation explain_by_slip(const RelativeGeometry& geometry, const std::vector<SeenPoint>& seen,
                                const std::vector<PointPair>& pairs, double nats_a_pair,
                                const std::vector<SlipComponent>& components, const Eigen::Vector3d& start);

/// The same for a vehicle that is where it was predicted: m·pair_nats + ln N(ν; 0, S).
double explain_without_slip(const RelativeGeometry& geometry, const std::vector<SeenPoint>& seen,
                            const std::vector<PointPair>& pairs, double nats_a_pair);

}  // namespace helixnav::supervisor
