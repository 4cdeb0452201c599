// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <random>
#include <string_view>

#include <Eigen/Core>

namespace helixnav::core {

/// A repeatable stream of random numbers: mt19937_64 seeded from (seed, name), distributions of Boost.Random, whose
/// algorithms, unlike the standard library's, are the same on every platform. Streams of different names are
/// independent for practical purposes, so that a draw added in one place does not change another.
/// Test: core/random_test.cpp (repeatability, moments, Kolmogorov–Smirnov with stated false-alarm probability).
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed, std::string_view name = {});

  std::uint64_t bits();                      ///< 64 uniform bits
  double uniform();                          ///< in [0, 1)
  double uniform(double low, double high);   ///< in [low, high); rounding may give high in a tiny interval
  std::uint64_t below(std::uint64_t bound);  ///< uniform in {0 … bound−1}, bound ≥ 1; no modulo bias
  double normal();                           ///< N(0, 1)
  double normal(double mean, double sigma);
  int poisson(double mean);  ///< mean in [0, 500]; 0 for a mean below
  bool bernoulli(double probability);

  /// N(0, covariance) for a symmetric positive semidefinite 3×3 matrix. Always three normal draws.
  Eigen::Vector3d normal3(const Eigen::Matrix3d& covariance);

 private:
  std::mt19937_64 engine_;
};

}  // namespace helixnav::core
