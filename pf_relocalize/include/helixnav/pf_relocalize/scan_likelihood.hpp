// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/events.hpp"
#include "helixnav/pf_relocalize/particles.hpp"
#include "helixnav/pf_relocalize/reference_map.hpp"

namespace helixnav::pf_relocalize {

/// What a scan may hold besides the map.
struct SensorModel {
  double detection_probability = 0.77;  ///< that a mapped landmark in view is seen AND still stands; in (0, 1)
  double extraneous_per_scan = 2.5;     ///< mean number of false and unmapped objects in the field of view, > 0
};

/// An observation as a Gaussian point in the frame of the robot.
struct RobotPoint {
  Eigen::Vector2d mean_m;
  Eigen::Matrix2d covariance_m2;
};

/// Points of a scan's observations; PreconditionError for kinds that do not fix a point.
std::vector<RobotPoint> robot_points(const core::Scan& scan);

/// Likelihood of a whole scan without association, as a ratio to "everything seen is extraneous and the map is empty":
///   log Λ(x) = Σ_j log(1 + Σ_i P_D N(m_j(x); m_i, Σ_i + R_j(x)) / λ)  −  Σ_i P_D·1{landmark i in the field of view},
/// λ = extraneous_per_scan / area of the field of view [1/m²]. The closed form linearised at the observation, whose
/// Jacobian cancels against that of λ. Pairs beyond 6 σ may be left out, an error below 2e-4 per observation.
/// Thread safe once a scan is set; nothing is allocated by evaluate(). Source: THEORY §3.2.
/// Test: pf_relocalize/scan_likelihood_test.cpp (brute force; pairs summed by point_likelihood).
class ScanLikelihood {
 public:
  /// Keeps copies of what it needs. PreconditionError for a sensor model out of range.
  ScanLikelihood(const ReferenceMap& map, const SensorModel& sensor);
  ~ScanLikelihood();
  ScanLikelihood(ScanLikelihood&&) noexcept;
  ScanLikelihood& operator=(ScanLikelihood&&) noexcept;

  /// Sets the scan for evaluate(). The field of view must be bounded in range, else PreconditionError.
  void set_scan(const core::Scan& scan);

  /// Sets points only, against `extraneous_per_m2`, without a visibility term: for constellations of landmarks.
  void set_points(const std::vector<RobotPoint>& points, double extraneous_per_m2);

  /// log Λ of particles [begin, end) into out[0 … end−begin). Particles are taken in tiles of 64; a landmark is computed
  /// for a whole tile when it is within reach of any of it, about 1 ns per particle. Clouds in an order that keeps
  /// neighbours together (order_by_place) are therefore weighed fastest.
  void evaluate(const Particles& particles, std::size_t begin, std::size_t end, double* out) const;

 private:
  friend class HelixProposal;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace helixnav::pf_relocalize
