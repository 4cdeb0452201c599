// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/landmark_id.hpp"
#include "helixnav/core/se2.hpp"

/// What an estimator that is a cloud of particles, each with a path and a map of its own, reports about itself.
namespace helixnav::core {

/// The health of the cloud after a scan.
struct CloudReport {
  std::size_t hypotheses = 0;   ///< weighed in this scan; more than particles where hypotheses were split
  double effective_size = 0.0;  ///< 1 / Σ w² before resampling
  bool resampled = false;
  double log_evidence = 0.0;  ///< log of Σ w before normalisation
  /// How many particles of a loop's length ago the present particles descend from: 1 means that the earlier path is a
  /// single guess. The effective size says nothing about it (docs/fastslam.md). Until that much was driven, since the
  /// start.
  std::size_t distinct_ancestors = 0;
};

/// A point on the paths of the surviving particles: paths part and, looking back, join, so that they form a tree.
struct PathPoint {
  std::int64_t step = 0;
  std::ptrdiff_t before = -1;  ///< index of the point before it; -1: none
  Pose2 T_world_robot;
  double share = 0.0;  ///< weight of the particles whose path this is
};

/// A landmark as all particles that hold it know it.
struct MixedLandmark {
  LandmarkId id = no_landmark;
  PointGaussian point;        ///< mean and covariance of the mixture
  double share = 0.0;         ///< weight of the particles that hold it
  double mature_share = 0.0;  ///< of those that hold it as mature
};

}  // namespace helixnav::core
