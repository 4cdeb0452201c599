// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/landmark_id.hpp"
#include "helixnav/core/relative_gaussian.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::core {

/// The joint estimate of a map that is too large for a dense covariance: the Gaussian factors of its drive, phase by
/// phase, from which atlas::Atlas computes the joint marginal of any landmarks. Memory O(phases × landmarks seen in one).
/// Poses and points are variables, referred to by index. Source: docs/atlas.md.
struct MapFactors {
  struct Variable {
    int dim = 2;                                      ///< 3: a pose (x, y, heading), 2: a point (x, y, unused)
    Eigen::Vector3d value = Eigen::Vector3d::Zero();  ///< in a frame that all values share [m, m, rad]
  };
  /// A factor: reference pose, pose, points. Its Gaussian has 3 rows and 2 for each point.
  struct Part {
    std::vector<int> variables;
    std::shared_ptr<const RelativeGaussian> gaussian;
    std::optional<AbsoluteFix> fix;  ///< what it came from, if that was a fix
  };
  struct Phase {
    std::vector<Part> parts;  ///< the first: from where the phase begins to where it ends; none: taken in by the host
    int revisits = -1;        ///< the part that holds what later phases on the same ground saw; −1: none
    int host = -1;            ///< the phase that took it in, …
    Pose2 T_host_entry;       ///< … and where it began, relative to where the host begins
  };

  /// False: the values are where a filter had its landmarks, near the solution of the factors but not at it.
  bool is_solved = true;
  PoseGaussian start;  ///< of the first pose in the frame of the map
  int world = -1;      ///< variable of the frame of the map: the first pose if it is certain
  std::vector<Variable> variables;
  std::vector<int> poses;  ///< variables: [k] where phase k begins; the last where it all ends
  std::vector<std::pair<LandmarkId, int>> landmarks;  ///< name and variable, by increasing name
  std::vector<Phase> phases;
};

}  // namespace helixnav::core
