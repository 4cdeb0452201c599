// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "helixnav/pf_relocalize/constellation.hpp"
#include "helixnav/pf_relocalize/reference_map.hpp"

namespace helixnav::pf_relocalize {

struct RivalOptions {
  std::size_t helices = 6000;  ///< poses sampled on the helices of all branch landmarks
  std::size_t starts = 60;     ///< best of them that are refined
  std::size_t most_rivals = 25;
  /// Rivals stay inside this squared distance from the map's prior (3 dof). Far beyond what is likely: a map that fits
  /// itself when it is shifted proves nothing, wherever the shifted pose is. Orchards of seeds 1-60: false closings 3
  /// at 16, where poses a pitch beyond the winner were out of bounds.
  double prior_chi2 = 64.0;
  double apart_m = 2.5;  ///< further than this from the winner, or turned further …
  double apart_rad = 8.0 * core::pi / 180.0;
  double soften_m = 0.5;              ///< σ added to every point at the beginning of the refinement
  double distinct_m = 1.0;            ///< rivals are at least this far from one another
  double branch_sigma_m = 0.15;       ///< of a branch landmark relative to the vehicle
  double lever_rad = 0.004;           ///< its σ across, per metre of distance
  double extraneous_per_m2 = 1.4e-3;  ///< unmapped landmarks (2 in a half disc of 30 m)
};

/// The winner's pose, refined on the constellation, and the best poses elsewhere inside the prior.
struct RivalPoses {
  core::Pose2 winner;
  std::vector<core::Pose2> rivals;  ///< by descending likelihood
};

/// Where else could the constellation of branch landmarks be? Helices of the branch landmarks over the reference map
/// (built from the state as it is now, so that map.prior is the branch's pose), best ones refined by expectation
/// maximisation of the scan likelihood with σ of the points shrinking from soften_m, then kept apart from the winner
/// and from one another. All poses T_base_robot. Cost: about 10 ms for 20 × 60 landmarks. Fewer than three branch
/// landmarks: no rivals.
/// Source: PROTOTYPE §4. Test: pf_relocalize/rivals_test.cpp (all shifts of a lattice are found; none in a world without).
RivalPoses find_rivals(const ReferenceMap& map, const std::vector<BranchLandmark>& branch, const core::Pose2& winner,
                       const RivalOptions& options, std::uint64_t seed);

}  // namespace helixnav::pf_relocalize
