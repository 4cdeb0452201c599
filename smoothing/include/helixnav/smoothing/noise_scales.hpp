// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "helixnav/smoothing/problem.hpp"

namespace helixnav::smoothing {

/// A factor on every standard deviation of one kind of measurement, with its two-sided 95 % interval.
struct NoiseScale {
  double factor = 1.0;
  double low_95 = 1.0, high_95 = 1.0;
  double redundancy = 0.0;  ///< degrees of freedom that judge it
};

struct NoiseScales {
  NoiseScale odometry, landmarks;
};

/// How far the covariances of odometry and of landmark observations are off, from the residuals of a solved problem and
/// nothing else. With P what the solution leaves of the measurements, Q_i the covariance of kind i and q_i its χ²,
/// E[q_i] = Σ_j S_ij σ_j² where S_ij = tr(P Q_i P Q_j): two equations for the two factors σ_j², and 2 S⁻¹ is their
/// covariance where the factors are near 1, so that a caller who scales and solves again until they are has the
/// restricted maximum likelihood. All of S but one number follows exactly from entries of H⁻¹ that the factorisation has the
/// pattern of; the number, tr(H⁻¹H₁H⁻¹H₂) with H₁ and H₂ the parts of H of both kinds, is the mean of `draws` draws for each kind
/// of what noise of it moves the other by. The interval is that of ln σ. Cost: a factorisation, about as much again for the
/// entries of the inverse, and 2 · draws solves. NumericalError when the two kinds cannot be told apart, PreconditionError when
/// either is missing or draws < 1. Test: smoothing/noise_scales_test.cpp (S against its dense twin, coverage of the intervals).
NoiseScales estimate_noise_scales(const Problem& solved, std::uint64_t seed, int draws = 3);

}  // namespace helixnav::smoothing
