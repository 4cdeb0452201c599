// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "helixnav/core/random.hpp"
#include "helixnav/pf_relocalize/particles.hpp"
#include "helixnav/pf_relocalize/scan_likelihood.hpp"

namespace helixnav::pf_relocalize {

struct HelixOptions {
  double prior_share = 0.1;      ///< share drawn from the prior itself; 1 is the Gaussian start (baseline)
  double prior_inflation = 2.0;  ///< covariance factor of the prior that spreads particles over helices, ≥ 1
  double sigmas = 3.5;           ///< half width of the heading interval, and of the gate on poses, in σ of the prior
};

/// Start of the filter on helices: for every observation z_j and landmark m_i the poses that would see m_i at z_j form the
/// curve x(φ) = m_i − R(φ) b_j in (x, y, φ), b_j the observed point in the robot's frame (eq (12) of hybrid_masson2003 in
/// forward-referenced bearings), thickened by the noise of z_j and m_i (eq (13)). The heading runs over the prior's
/// interval in cells of equal width; cells get particles in proportion to the inflated prior on the curve.
/// Every particle knows its density under the whole mixture,
///   q(x) = share·prior(x) + (1−share) Σ_ij w_ij(φ)/Δφ · N(m_j(x); m_i, Σ_i + R_j(x)),
/// so that prior·Λ/q is right where tubes cross, mirror images included.
/// Test: pf_relocalize/helix_proposal_test.cpp (mean of prior/q is 1; q against a histogram; posterior against a grid).
class HelixProposal {
 public:
  /// `likelihood` must have its scan set and outlive this object. Cost: observations × landmarks × 24 cells.
  HelixProposal(const ReferenceMap& map, const ScanLikelihood& likelihood, const HelixOptions& options);

  /// Number of (observation, landmark) pairs with any pose inside the prior's bounds; 0: all particles from the prior.
  std::size_t pairs() const { return pairs_; }

  /// Assigns the n particles to cells, systematically with the given offset in [0, 1). Call before sample().
  void allot(std::size_t n, double offset);

  /// Draws the poses of particles [begin, end).
  void sample(Particles& particles, std::size_t begin, std::size_t end, core::RandomStream& random) const;

  /// Sets log_weight of particles [begin, end) to log(prior/q). Fastest after order_by_place.
  void weigh(Particles& particles, std::size_t begin, std::size_t end) const;

  /// log prior(x) of particle i; log q(x) of particles [begin, end).
  double log_prior(const Particles& particles, std::size_t i) const;
  void log_proposal(const Particles& particles, std::size_t begin, std::size_t end, double* out) const;

 private:
  struct Cell {
    std::uint32_t pair;     // observation × landmarks + landmark
    std::uint32_t heading;  // index of the heading cell
  };
  void weigh_cells();
  int heading_cell(double heading_rad) const;

  const ReferenceMap& map_;
  const ScanLikelihood& likelihood_;
  HelixOptions options_;
  double heading_min_rad_ = 0.0, heading_step_rad_ = 0.0;
  std::size_t pairs_ = 0;
  std::vector<double> weight_;  // [pair][heading], sums to 1
  std::vector<Cell> cells_;     // of positive weight
  std::vector<Cell> allotted_;  // of particle i − from_prior_
  std::size_t from_prior_ = 0;  // particles [0, from_prior_) come from the prior
  double prior_share_ = 1.0;
  Eigen::Matrix3d prior_L_, prior_information_;  // of the pose given ξ
  double log_prior_norm_ = 0.0;
};

}  // namespace helixnav::pf_relocalize
