// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "helixnav/pf_relocalize/constellation.hpp"
#include "helixnav/pf_relocalize/reference_map.hpp"
#include "helixnav/pf_relocalize/relocalizer.hpp"
#include "helixnav/pf_relocalize/rivals.hpp"

namespace helixnav::supervisor {

/// How the map is closed. replay: the filter goes back to where the search began and processes its scans again with the
/// associations now known; if the cost of that is too high, merge is used. merge: the branch is kept and each of its
/// landmarks is conditioned on being the old one. Both are exact and differ in where they linearise. restart: the
/// paper's method, a baseline that discards the branch. Figures: docs/closing.md.
enum class ClosingMethod { merge, replay, restart };

/// The evidence that a closing requires. constellation: landmarks of the branch match old ones, and no other place fits
/// as well. paper_rule: the cloud's standard deviations are below twice those of the odometry since the last look,
/// nothing more; a baseline, which has no landmark pairs to close with and needs ClosingMethod::restart.
enum class Acceptance { constellation, paper_rule };

/// When the integrity monitor reports a wrong pose: old landmarks are missing while new ones spawn.
/// Source of the figures: LifeOptions (log-odds of a hit and a miss). Measured: docs/adr/0009-integrity.md.
struct IntegrityLimits {
  bool enabled = true;
  int looks = 3;              ///< scans that must have looked for a landmark before it counts
  double missing_nats = 1.1;  ///< for a wrong pose, per landmark looked for and not seen
  double seen_nats = 1.95;    ///< against it, per landmark mostly seen
  double nats = 4.0;          ///< threshold on the sum; and …
  int spawned = 2;            ///< … this many landmarks must have matured meanwhile: then the navigator rolls back
  int reach = 200;            ///< maximum number of scans to roll back; older evidence is discarded
};

/// How the particle filter resolves a return to old ground that is too ambiguous to be associated scan by scan, and
/// what must hold before the map is closed. Distances are measured along the drive. Source of the figures: PROTOTYPE §2
/// to §6. Lengths and densities here are for a sensor with a reach of reference_reach_m; for any other sensor see
/// lengths.hpp.
struct SearchOptions {
  bool enabled = true;
  std::uint64_t seed = 1;

  // Trigger.
  double old_after_m = 60.0;              ///< a mature landmark unseen over this distance is old
  double expected_confusers = 0.1;        ///< a search begins at this expected number of objects taken for an old one
  double wrong_place_probability = 1e-4;  ///< P(another pose | scan) below which no search begins
  double defer_confusers = 0.05;          ///< above this an isolated match is deferred, but no search begins yet
  double confirmation_widening = 2.0;     ///< √(|S|/|R|) above which an isolated match needs a second hit, …
  double confirmation_m = 5.0;            ///< … within this distance
  double extraneous_per_scan = 2.5;       ///< observations per scan not of an old landmark: clutter plus new ones
  bool learn_extraneous = false;          ///< estimate it from landmarks created so far, see with_extraneous_density

  IntegrityLimits integrity;

  // Search.
  double look_distance_m = 1.0;  ///< minimum distance between two scans used by the particle filter
  int start_observations = 3;    ///< needed in the scan that starts the particle filter, and …
  int start_in_gate = 2;         ///< … how many of them must have an old landmark in their gate
  double start_gate = 9.21;      ///< χ² of that gate
  double reach_m = 110.0;        ///< margin beyond the sensor's view within which old landmarks enter the reference map
  double rest_m = 9.0;           ///< pause after a failed attempt
  double attempt_m = 105.0;      ///< an attempt not accepted within this distance is restarted
  double undecided_m = 330.0;    ///< a search is given up after this distance, or …
  double idle_m = 60.0;          ///< … after this distance with nothing in any old landmark's gate
  bool whole_map = true;         ///< query the whole map if the search ends undecided or its closing is refused
  pf_relocalize::RelocalizerOptions relocalizer;
  pf_relocalize::ReferenceMapOptions reference;
  pf_relocalize::GateLimits gate;
  pf_relocalize::GiveUpLimits give_up;

  // Acceptance.
  double coverage_spacing_m = 4.0;  ///< between the poses whose views make up the covered ground
  Acceptance acceptance = Acceptance::constellation;
  double branch_seen_within_m = 67.5;  ///< landmarks mapped since the trigger count if seen within this distance
  double ask_again_m = 4.5;            ///< to the next test after a failed one
  double confirm_m = 1.5;              ///< between consecutive tests
  int passes = 2;  ///< consecutive tests to pass, so that repeating the test does not raise the false-alarm rate
  pf_relocalize::RivalOptions rivals;
  pf_relocalize::ConstellationLimits constellation;

  // Closing.
  ClosingMethod closing = ClosingMethod::replay;
  double merge_sigma_m = 0.02;        ///< standard deviation of the difference between two merged landmarks
  double duplicate_sigma_m = 0.01;    ///< added to the covariance when testing whether two landmarks are the same
  double closing_probability = 0.99;  ///< χ² quantile that the cost of a closing must not exceed
  int most_dropped = 1;               ///< pairs that may be dropped, worst first, until the cost passes
  double leftover_gate = 9.21;        ///< χ² within which remaining duplicates are merged after a closing
  double leftover_least_m = 1.0;      ///< this close to an old landmark is always near enough to be its duplicate; …
  double leftover_most_m = 2.5;       ///< … farther away never is, however sparse the neighbours
  double stretch_m = 40.0;            ///< length of the segment aligned as a whole; 25 and 60 m work as well
  double stretch_rim_m = 3.0;    ///< rim of the segment: landmarks there may be matched, but do not count as missing
  double stretch_rigid_m = 0.7;  ///< tolerance on the distance between two duplicates, against that of their partners
  /// Up to this many scans and fixes, the tape keeps a drive from its start, so that it can be solved again with
  /// different noise or with a jump in it. For a longer drive, the atlas keeps the measurements. After a closing,
  /// whichever applies is solved; 0: none.
  int smooth_up_to_scans = 20000;
};

}  // namespace helixnav::supervisor
