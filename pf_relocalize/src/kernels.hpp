// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include "helixnav/core/events.hpp"
#include "helixnav/pf_relocalize/scan_likelihood.hpp"

namespace helixnav::pf_relocalize {

/// Particles are weighed in tiles of this size, neighbours in the cloud's order and therefore in space.
inline constexpr std::size_t tile_size = 64;

using TileArray = std::array<double, tile_size>;

/// Poses of one tile, n ≤ tile_size of them.
struct PoseTile {
  std::size_t n = 0;
  const double* x = nullptr;
  const double* y = nullptr;
  alignas(64) TileArray cos_heading;
  alignas(64) TileArray sin_heading;
};

/// Where one observed point is for every pose of a tile, with its covariance in the map frame.
struct PlacedPoints {
  alignas(64) TileArray x, y, sxx, sxy, syy;
};
void place_points(const PoseTile& poses, const RobotPoint& point, PlacedPoints& placed);

/// A landmark of the map, and for maps with latent modes its displacement for every particle of a tile, else nullptr.
struct TileLandmark {
  double x, y, sxx, sxy, syy;
  const double* shift_x = nullptr;
  const double* shift_y = nullptr;
};

/// sum[p] += factor[p] · N(placed point p; landmark, Σ + R_p) for the n particles of a tile. Relative error below 1e-9.
/// The filter spends its arithmetic in this loop: about 50 flops per pair, two of them a division and a square root.
void add_densities(std::size_t n, const PlacedPoints& placed, const TileLandmark& landmark, const double* factor,
                   double* sum);

/// Region of the sensor in the frame of the robot, in the form that a comparison without atan2 needs.
struct ViewSector {
  double x_m, y_m;                // sensor in the robot frame
  double cos_middle, sin_middle;  // middle of the bearings in the robot frame
  double cos_half;                // cosine of half their width; −2 for all around
  double min_range2_m2, max_range2_m2;
};
ViewSector view_sector(const core::FieldOfView& view, const core::Pose2& T_robot_sensor);

/// count[p] += 1 for every pose of the tile that has the landmark in its sector.
void count_visible(const PoseTile& poses, const ViewSector& sector, const TileLandmark& landmark, double* count);

}  // namespace helixnav::pf_relocalize
