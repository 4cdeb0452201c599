// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "helixnav/pf_relocalize/particles.hpp"
#include "helixnav/pf_relocalize/reference_map.hpp"
#include "kernels.hpp"
#include "landmark_grid.hpp"

namespace helixnav::pf_relocalize {

/// Pairs further apart than this many σ (of the longer axes of both ellipses) are left out of sums.
inline constexpr double reach_sigmas = 6.0;

/// Largest eigenvalue of a symmetric 2×2 matrix.
inline double largest_variance(const Eigen::Matrix2d& S) {
  return 0.5 * (S(0, 0) + S(1, 1)) + std::hypot(0.5 * (S(0, 0) - S(1, 1)), S(0, 1));
}

/// The reference map as arrays, with neighbour search.
struct LandmarkTable {
  explicit LandmarkTable(const ReferenceMap& map);

  std::size_t size() const { return x.size(); }

  std::vector<double> x, y, sxx, sxy, syy;
  std::vector<double> variance;  // largest, of each landmark
  double largest = 0.0;          // of all
  std::size_t modes = 0;
  std::vector<double> latent;    // [landmark][mode][x, y]
  double latent_reach_m = 0.0;   // how far modes can move a landmark from its cell
  LandmarkGrid grid;
};

/// One block of particles, as the sums below want it.
struct ParticleBlock {
  ParticleBlock(const Particles& particles, std::size_t begin, std::size_t end);

  /// Displacement V_i ξ of a landmark for one particle of the block.
  Eigen::Vector2d displacement(const LandmarkTable& table, std::size_t landmark, std::size_t particle) const {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    const double* V = table.latent.data() + 2 * table.modes * landmark;
    for (std::size_t k = 0; k < table.modes; ++k) {
      const double xi = source.latent[k][first + particle];
      sum += xi * Eigen::Vector2d(V[2 * k], V[2 * k + 1]);
    }
    return sum;
  }

  const Particles& source;
  std::size_t first;
  PoseBlock poses;
};

/// Working memory of one thread, about 70 kB on its stack.
struct PairWorkspace {
  PlacedPoints placed;
  PairBuffer pairs;
};

inline void add_values(PairBuffer& pairs, double* sum) {
  pair_densities(pairs);
  for (std::size_t k = 0; k < pairs.n; ++k) sum[pairs.particle[k]] += pairs.value[k];
  pairs.n = 0;
}

/// sum[p] += Σ_i factor(p, i)·N(m(x_p); m_i, Σ_i + R(x_p)) over landmarks i within reach of where particle p of the block
/// sees `point`. Order of summation depends on the map alone.
template <typename Factor>
void add_pair_densities(const LandmarkTable& table, const ParticleBlock& block, const RobotPoint& point,
                        PairWorkspace& work, Factor&& factor, double* sum) {
  place_points(block.poses, point, work.placed);
  const double variance = largest_variance(point.covariance_m2);
  const double reach_m = reach_sigmas * std::sqrt(variance + table.largest) + table.latent_reach_m;
  PairBuffer& pairs = work.pairs;
  for (std::size_t p = 0; p < block.poses.n; ++p) {
    const double x = work.placed.x[p], y = work.placed.y[p];
    table.grid.visit(x, y, reach_m, [&](std::uint32_t i) {
      double dx = table.x[i] - x, dy = table.y[i] - y;
      if (table.modes != 0) {
        const Eigen::Vector2d shift = block.displacement(table, i, p);
        dx += shift.x();
        dy += shift.y();
      }
      if (dx * dx + dy * dy > reach_sigmas * reach_sigmas * (variance + table.variance[i])) return;
      const std::size_t k = pairs.n++;
      pairs.dx[k] = dx;
      pairs.dy[k] = dy;
      pairs.sxx[k] = table.sxx[i] + work.placed.sxx[p];
      pairs.sxy[k] = table.sxy[i] + work.placed.sxy[p];
      pairs.syy[k] = table.syy[i] + work.placed.syy[p];
      pairs.factor[k] = factor(p, i);
      pairs.particle[k] = static_cast<std::uint32_t>(p);
      if (pairs.n == pair_capacity) add_values(pairs, sum);
    });
  }
  add_values(pairs, sum);
}

}  // namespace helixnav::pf_relocalize
