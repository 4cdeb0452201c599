// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "helixnav/core/step_report.hpp"
#include "helixnav/pf_relocalize/constellation.hpp"
#include "search/search.hpp"

namespace helixnav::supervisor {

/// Old landmarks in reach of where the vehicle may be and of where it may drive next, ascending.
std::vector<core::LandmarkId> reference_landmarks(const SearchView& view, const std::vector<core::LandmarkId>& old,
                                                  double reach_m);

/// The joint estimate of those among them that locate the vehicle (old_ground).
core::JointGaussian reference_ground(const SearchView& view, const std::vector<core::LandmarkId>& old, double reach_m);

/// Landmarks of the branch in the frame of the vehicle: all that were seen recently and from which the vehicle has
/// since drifted by less than the tolerance of a pair, because the constellation is compared as a rigid body.
std::vector<pf_relocalize::BranchLandmark> branch_landmarks(const SearchView& view,
                                                            const std::vector<core::LandmarkId>& old,
                                                            const SearchOptions& options);

/// Whether the constellation mapped by the branch matches old landmarks, and nowhere else nearly as well. The hypothesis is
/// T_world_robot, the particle filter's, unless another pose inside the prior explains so much more that it, not the
/// filter's, would pass the test: scans weigh an unmapped tree again every time, the constellation counts it once.
struct ConstellationAnswer {
  pf_relocalize::ConstellationVerdict verdict;
  core::Pose2 T_world_winner;
  core::Pose2 T_world_rival;  ///< of the best rival that counts; the winner's when there is none
  bool adopted = false;       ///< the winner is not the particle filter's hypothesis
};
ConstellationAnswer ask_constellation(const SearchView& view, const std::vector<core::LandmarkId>& old,
                                      double search_begun_path_m, const core::Pose2& T_world_robot,
                                      const SearchOptions& options, std::uint64_t seed);

/// The answer with the numbers that decided it.
core::VerificationDecision verification_decision(const ConstellationAnswer& answer);

}  // namespace helixnav::supervisor
