// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "helixnav/core/particle_cloud.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::fastslam {

/// The paths of the surviving particles, as points where they were marked. Paths of particles that died are forgotten:
/// the memory is that of the remaining points, which some distance back is a single line.
///
///   FastSlam slam(…); PathTree paths;
///   slam.update(scan); paths.descend(slam.parents());      // every scan
///   paths.mark(step, slam.poses());                        // where a point is wanted
///   paths.points(slam.weights())
///
/// Cost of a mark: the number of particles, amortised. Test: fastslam/path_tree_test.cpp (paths kept whole by each particle).
class PathTree {
 public:
  /// Particle k comes from parents[k] of before.
  void descend(const std::vector<std::uint32_t>& parents);

  /// A point on the path of every particle.
  void mark(std::int64_t step, const std::vector<core::Pose2>& poses);

  /// The tree, a point after the one before it; `weights` of the particles of today.
  std::vector<core::PathPoint> points(const std::vector<double>& weights) const;

 private:
  void forget_the_dead();

  std::vector<core::PathPoint> points_;
  std::vector<std::ptrdiff_t> last_;  ///< [particle] the last point of its path
  std::size_t least_to_look_ = 0;     ///< points from which on to look for dead ones
};

}  // namespace helixnav::fastslam
