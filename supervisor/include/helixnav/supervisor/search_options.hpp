// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "helixnav/pf_relocalize/constellation.hpp"
#include "helixnav/pf_relocalize/reference_map.hpp"
#include "helixnav/pf_relocalize/relocalizer.hpp"
#include "helixnav/pf_relocalize/rivals.hpp"

namespace helixnav::supervisor {

/// How the map is closed. replay: back to where the search began, and its scans once more with the associations now
/// known; where that costs too much to be believed, merge. merge: the branch stays and each of its landmarks is
/// conditioned on being the old one. Both are exact, and differ by where they linearise. restart: the paper's, a baseline
/// that throws the branch away. Figures: docs/closing.md.
enum class ClosingMethod { merge, replay, restart };

/// What is believed. constellation: landmarks of the branch stand on old ones, and nowhere else as well. paper_rule: the
/// cloud's standard deviations are below twice those of the odometry since the last look, and that is all; a baseline,
/// which has no pairs of landmarks to close with and needs ClosingMethod::restart.
enum class Acceptance { constellation, paper_rule };

/// What makes a pose doubtful whose covariance says nothing: old landmarks that are missing where new ones spawn.
/// Source of the figures: LifeOptions (log-odds of a hit and a miss). Measured: docs/adr/0009-doubt.md.
struct IntegrityLimits {
  bool enabled = true;
  int looks = 3;              ///< scans that looked for a landmark make it count
  double missing_nats = 1.1;  ///< for a wrong pose, of each that was looked for and not seen
  double seen_nats = 1.95;    ///< against it, of each that was mostly seen
  double nats = 4.0;          ///< so many, and …
  int spawned = 2;            ///< … so many landmarks matured meanwhile, make a search begin from before
  int reach = 200;            ///< scans that can be gone through again; doubts older than that are let go
};

/// When a return to old ground is too ambiguous to be associated scan by scan, how it is resolved by the particle filter,
/// and what is asked before the map is closed. Distances are driven ones. Source of the figures: PROTOTYPE §2 to §6.
/// Lengths and densities stand here for a sensor of reference_reach_m; what they are for another one: lengths.hpp.
struct SearchOptions {
  bool enabled = true;
  std::uint64_t seed = 1;

  // Trigger.
  double old_after_m = 60.0;        ///< a mature landmark unseen over so long a drive is old
  double expected_confusers = 0.1;  ///< expected objects that may be seen in an old one's stead that begin a search
  double wrong_place_probability = 1e-4;  ///< P(another pose | scan) below which all old landmarks together decide it
  double defer_confusers = 0.05;          ///< above it an old landmark is not matched alone, but no search begins yet
  double confirmation_widening =
      2.0;                      ///< √(|S|/|R|) above which an old landmark is matched alone only when met again, …
  double confirmation_m = 5.0;  ///< … within so long a drive
  double foreign_per_scan = 2.5;  ///< observations of no old landmark in one scan: clutter and new ones together
  bool learn_foreign = false;     ///< instead, as many as the drive so far has begun landmarks, see with_foreign

  IntegrityLimits integrity;

  // Search.
  double look_distance_m = 1.0;  ///< scans nearer to one another are no new look for the particle filter
  int start_observations = 3;    ///< in the scan that starts the particle filter, and …
  int start_in_gate = 2;         ///< … so many of them with an old landmark in their gate
  double start_gate = 9.21;      ///< χ² of that gate
  double reach_m = 110.0;        ///< old landmarks so far beyond what the sensor may see belong to the reference map
  double rest_m = 9.0;           ///< after an attempt that failed
  double attempt_m = 105.0;      ///< after so long an attempt that was never accepted is begun again
  double undecided_m = 330.0;    ///< after so long a search the question is left open, and …
  double idle_m = 60.0;          ///< … after so long a drive without anything in an old landmark's gate
  pf_relocalize::RelocalizerOptions relocalizer;
  pf_relocalize::ReferenceMapOptions reference;
  pf_relocalize::GateLimits gate;
  pf_relocalize::GiveUpLimits give_up;

  // Acceptance.
  double coverage_spacing_m = 4.0;  ///< between the places whose views make up the ground looked at
  Acceptance acceptance = Acceptance::constellation;
  double branch_seen_within_m = 67.5;  ///< landmarks mapped since the trigger count while seen so lately
  double ask_again_m = 4.5;            ///< after a test that was not passed
  double confirm_m = 1.5;              ///< between the tests that must be passed in a row
  int passes = 2;                      ///< so many; a closure is not to be had by asking until chance grants it
  pf_relocalize::RivalOptions rivals;
  pf_relocalize::ConstellationLimits constellation;

  // Closing.
  ClosingMethod closing = ClosingMethod::replay;
  double merge_sigma_m = 0.02;        ///< two landmarks that are one differ by so little
  double duplicate_sigma_m = 0.01;    ///< on top of the covariance, where it is asked whether two may be one
  double closing_probability = 0.99;  ///< χ² quantile that the cost of a closing must not exceed
  int most_dropped = 1;               ///< pairs that may go, worst first, until the cost passes
  double leftover_gate = 9.21;        ///< χ² within which remaining duplicates are merged after a closing
  double leftover_least_m = 1.0;      ///< so near to an old landmark one may be its duplicate, and …
  double leftover_most_m = 2.5;       ///< … never farther off, wherever its neighbours stand
  double stretch_m = 40.0;         ///< of duplicates placed as a whole, around the best known; 25 and 60 m do as well
  double stretch_rim_m = 3.0;      ///< beyond it landmarks are partners, but nobody misses one
  double stretch_rigid_m = 0.7;    ///< two duplicates are as far apart as their partners, but for this
  int smooth_up_to_scans = 20000;  ///< and fixes; a drive of more is not solved as a whole after a closing
};

}  // namespace helixnav::supervisor
