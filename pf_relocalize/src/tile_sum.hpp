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

/// Landmarks further than this many σ (of the longer axes of both ellipses) from all particles of a tile are left out.
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
  std::vector<double> latent;   // [landmark][mode][x, y]
  double latent_reach_m = 0.0;  // how far modes can move a landmark from its cell
  LandmarkGrid grid;
};

/// A rectangle about points of a tile.
struct Box {
  Eigen::Vector2d low, high;

  Box(const double* x, const double* y, std::size_t n) : low(x[0], y[0]), high(low) {
    for (std::size_t p = 1; p < n; ++p) {
      low.x() = x[p] < low.x() ? x[p] : low.x();
      low.y() = y[p] < low.y() ? y[p] : low.y();
      high.x() = x[p] > high.x() ? x[p] : high.x();
      high.y() = y[p] > high.y() ? y[p] : high.y();
    }
  }

  double squared_distance(double x, double y) const {
    const double dx = std::max({low.x() - x, x - high.x(), 0.0}), dy = std::max({low.y() - y, y - high.y(), 0.0});
    return dx * dx + dy * dy;
  }
};

/// One tile of particles, as the sums below need it; about 5 kB, on the stack of the thread that works on it.
struct ParticleTile {
  ParticleTile(const LandmarkTable& landmarks, const Particles& particles, std::size_t begin, std::size_t end);

  /// Landmark i for the particles of this tile. The result points into this tile, until the next call.
  TileLandmark landmark(std::uint32_t i);

  const LandmarkTable& table;
  const Particles& source;
  std::size_t first;
  PoseTile poses;
  PlacedPoints placed;
  alignas(64) TileArray shift_x, shift_y;
};

/// sum[p] += Σ_i factor(i)[p]·N(m(x_p); m_i, Σ_i + R(x_p)) over the landmarks within reach of where any particle of the
/// tile sees `point`; factor(i) gives an array over the tile.
template <typename Factor>
void add_point_densities(ParticleTile& tile, const RobotPoint& point, Factor&& factor, double* sum) {
  const LandmarkTable& table = tile.table;
  place_points(tile.poses, point, tile.placed);
  const Box box(tile.placed.x.data(), tile.placed.y.data(), tile.poses.n);
  const double variance = largest_variance(point.covariance_m2);
  const double reach_m = reach_sigmas * std::sqrt(variance + table.largest) + table.latent_reach_m;
  const Eigen::Vector2d reach(reach_m, reach_m);
  table.grid.visit(box.low - reach, box.high + reach, [&](std::uint32_t i) {
    const double own_reach_m = reach_sigmas * std::sqrt(variance + table.variance[i]) + table.latent_reach_m;
    if (box.squared_distance(table.x[i], table.y[i]) > own_reach_m * own_reach_m) return;
    add_densities(tile.poses.n, tile.placed, tile.landmark(i), factor(i), sum);
  });
}

}  // namespace helixnav::pf_relocalize
