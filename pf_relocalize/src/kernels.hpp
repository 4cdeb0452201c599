// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "helixnav/core/events.hpp"
#include "helixnav/pf_relocalize/scan_likelihood.hpp"

namespace helixnav::pf_relocalize {

/// Particles are worked on in blocks of this size: the unit of threads, of random streams and of the loops below.
inline constexpr std::size_t block_size = 256;
inline constexpr std::size_t pair_capacity = 1024;

using BlockArray = std::array<double, block_size>;

/// Poses of one block, n ≤ block_size of them.
struct PoseBlock {
  std::size_t n = 0;
  const double* x = nullptr;
  const double* y = nullptr;
  alignas(64) BlockArray cos_heading;
  alignas(64) BlockArray sin_heading;
};

/// Where one observed point lies for every pose of a block, with its covariance in the map frame.
struct PlacedPoints {
  alignas(64) BlockArray x, y, sxx, sxy, syy;
};
void place_points(const PoseBlock& poses, const RobotPoint& point, PlacedPoints& placed);

/// Pairs (particle, landmark) within reach: difference and summed covariance, and a factor on the density.
struct PairBuffer {
  std::size_t n = 0;
  alignas(64) std::array<double, pair_capacity> dx, dy, sxx, sxy, syy, factor, value;
  std::array<std::uint32_t, pair_capacity> particle;
};

/// value = factor · N((dx, dy); 0, S). Relative error below 1e-9. This loop is where the filter spends its arithmetic:
/// about 45 flops a pair, two of them a division and a square root.
void pair_densities(PairBuffer& pairs);

/// Region of the sensor in the frame of the robot, in the form that a comparison without atan2 needs.
struct ViewSector {
  double x_m, y_m;                    // sensor in the robot frame
  double cos_middle, sin_middle;      // middle of the bearings in the robot frame
  double cos_half;                    // cosine of half their width; −2 for all around
  double min_range2_m2, max_range2_m2;
};
ViewSector view_sector(const core::FieldOfView& view, const core::Pose2& T_robot_sensor);

/// count += 1 for every pose of the block that has (x, y) in its sector. (shift_x, shift_y): per-pose displacement of
/// the landmark, or nullptr.
void count_visible(const PoseBlock& poses, const ViewSector& sector, double x_m, double y_m, const double* shift_x,
                   const double* shift_y, double* count);

}  // namespace helixnav::pf_relocalize
