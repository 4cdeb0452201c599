// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "helixnav/smoothing/problem.hpp"

namespace helixnav::smoothing {

/// A factor on every standard deviation of one kind of measurement, with its two-sided 95 % interval.
struct NoiseScale {
  double factor = 1.0;
  double low_95 = 1.0, high_95 = 1.0;
  double redundancy = 0.0;  ///< degrees of freedom that determine it
};

struct NoiseScales {
  NoiseScale odometry, landmarks;
};

/// How far off the covariances of odometry and of landmark observations are, from nothing but the residuals of a solved
/// problem. With P what the solution leaves of the measurements, Q_i the covariance of kind i and q_i its χ²,
/// E[q_i] = Σ_j S_ij σ_j² where S_ij = tr(P Q_i P Q_j): two equations for the two factors σ_j², and 2 S⁻¹ is their
/// covariance where the factors are near 1, so that a caller that scales and solves again until they are obtains the
/// restricted maximum likelihood. All of S except one number follows exactly from entries of H⁻¹ in the pattern of the
/// factorisation; that number, tr(H⁻¹H₁H⁻¹H₂) with H₁ and H₂ the parts of H from the two kinds, is the mean over
/// `draws` draws per kind of how far noise of that kind moves the other. The interval is that of ln σ. Cost: a
/// factorisation, about as much again for the entries of the inverse, and 2 · draws solves. NumericalError when the two
/// kinds cannot be told apart, PreconditionError when either is missing or draws < 1.
/// Test: smoothing/noise_scales_test.cpp (S against its dense twin, coverage of the intervals).
NoiseScales estimate_noise_scales(const Problem& solved, std::uint64_t seed, int draws = 3);

}  // namespace helixnav::smoothing
