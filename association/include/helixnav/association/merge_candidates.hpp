// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/association/landmark_life.hpp"
#include "helixnav/core/gaussian.hpp"

namespace helixnav::association {

struct MergeOptions {
  double gate_probability = 0.99;
  double max_distance_m = 2.0;  ///< beyond it, compatible only means uncertain
};

/// Two landmarks that may be one: their difference with its covariance, correlations included.
struct MergeCandidate {
  core::LandmarkId kept = core::no_landmark;  ///< the older
  core::LandmarkId merged = core::no_landmark;
  double distance_m = 0.0;
  double nis = 0.0;        ///< of this pair alone, 2 degrees of freedom
  double joint_nis = 0.0;  ///< of this pair and all before it in the list
  int joint_dof = 0;
};

/// Pairs of mature landmarks, never seen in one scan, that are compatible together: nearest NIS first, each landmark in
/// one pair at most, every pair kept only while the χ² gate holds for all so far.
/// Cost O(n²) for n landmarks plus O(pairs³). Throws NumericalError when the covariance of differences is not positive
/// definite. Test: association/merge_candidates_test.cpp.
std::vector<MergeCandidate> merge_candidates(const core::JointGaussian& landmarks, const LandmarkLife& life,
                                             const MergeOptions& options = {});

}  // namespace helixnav::association
