// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/random.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/poisson_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <boost/random/uniform_int_distribution.hpp>

namespace helixnav::core {
namespace {

/// FNV-1a of the stream's name, so that (seed, "clutter") and (seed, "odometry") start far apart.
std::uint64_t hash(std::string_view name) {
  std::uint64_t h = 0xcbf29ce484222325ULL;
  for (const char c : name) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return h;
}

std::mt19937_64 seeded_engine(std::uint64_t seed, std::string_view name) {
  const std::uint64_t h = hash(name);
  std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                         static_cast<std::uint32_t>(h), static_cast<std::uint32_t>(h >> 32)};
  return std::mt19937_64(sequence);
}

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::string_view name) : engine_(seeded_engine(seed, name)) {}

std::uint64_t RandomStream::bits() { return engine_(); }

double RandomStream::uniform() { return boost::random::uniform_01<double>()(engine_); }

double RandomStream::uniform(double low, double high) { return low + (high - low) * uniform(); }

std::uint64_t RandomStream::below(std::uint64_t bound) {
  return boost::random::uniform_int_distribution<std::uint64_t>(0, bound - 1)(engine_);
}

double RandomStream::normal() { return boost::random::normal_distribution<double>()(engine_); }

double RandomStream::normal(double mean, double sigma) { return mean + sigma * normal(); }

int RandomStream::poisson(double mean) {
  return mean > 0.0 ? boost::random::poisson_distribution<int, double>(mean)(engine_) : 0;
}

bool RandomStream::bernoulli(double probability) { return uniform() < probability; }

Eigen::Vector3d RandomStream::normal3(const Eigen::Matrix3d& covariance) {
  // Eigen decomposition rather than Cholesky: odometry covariances have rank two.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
  Eigen::Vector3d sample;
  for (int i = 0; i < 3; ++i) sample[i] = std::sqrt(std::max(0.0, eigen.eigenvalues()[i])) * normal();
  return eigen.eigenvectors() * sample;
}

}  // namespace helixnav::core
