// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/association/associate.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/supervisor/search_options.hpp"

namespace helixnav::supervisor {

/// What the old landmarks of a scan, taken together, say about where the vehicle is.
struct PlaceEvidence {
  int pairs = 0;           ///< old landmarks that the assignment matches
  int met = 0;             ///< landmarks that it matches, old or not
  int missing = 0;         ///< old landmarks that should be in view and that it does not match
  double widening = 1.0;   ///< √(|S|/|R|), median over these pairs: how much wider the pose makes their gates
  double width_m = 0.0;    ///< |S|^¼ on the ground, likewise: where each is expected, one standard deviation
  double spacing_m = 0.0;  ///< of old landmarks in view from the nearest other one, median; 0 of fewer than two
  /// P(another pose | scan): (1 + Σ exp e_rival) / (1 + Σ exp e_rival + exp e), where e is the log-likelihood ratio of a
  /// matching against "none of the old landmarks is met".
  double wrong_probability = 1.0;
  /// Old landmarks of matches that hang loose: the vehicle is known beside the others, and yet not where these are.
  std::vector<core::LandmarkId> loose;
};

/// Evidence of the assignment's matches with old landmarks (ascending in `old`) together, given its matches with landmarks
/// that are not old: those stand wherever the vehicle is. A matching's evidence is its joint likelihood against as many
/// observations of nothing mapped, `extraneous_per_scan` in the field of view, less what each old landmark costs that should
/// be in view and is not matched. S is given these matches.
/// Cost: O(n²) for n gated pairs with old landmarks, O(n) for each two pairs that a rival may begin with.
/// Source: docs/adr/0014-ambiguous-pose.md. Test: supervisor/association/place_evidence_test.cpp.
PlaceEvidence place_evidence(const cekf::CompressedEkf& filter, const association::InnovationProblem& problem,
                             const association::Assignment& assignment, const core::Scan& scan,
                             const std::vector<core::LandmarkId>& old, double extraneous_per_scan, double view_margin_m,
                             const SearchOptions& options);

/// Whether no other pose is in question, so that what is ambiguous is for the assignment to decide and no search helps:
/// either the pose adds little to where the old landmarks are expected (widening below the limit for a single match), or it
/// leaves them no room beside one another (two standard deviations below half their spacing) and P(another pose | scan) is
/// below `wrong_place_probability`. In question is the pose where two matches or more hang loose, whatever the others say; one is
/// to be left unused. It hangs loose where, given the half of the matches that is known best, its gate holds more than
/// `defer_confusers` objects of no landmark: a median says nothing about a single landmark far from all the others, and the
/// observation of nothing that meets its gate, as wide as the whole drift, would move everything by it.
bool fixes_pose(const PlaceEvidence& place, const SearchOptions& options);

/// Whether every pose in question is the same place, so that a search would look for the vehicle where it is: the scan says too little
/// for a match of old landmarks to be certain, but does not contradict the map (what is missing against what is met, weighed as by
/// the integrity monitor), the old landmarks have no room beside one another, and at most one match hangs loose. What is ambiguous is then to be left unused,
/// until more is seen, or the pose has drifted so far that another place may be meant.
bool leaves_one_place(const PlaceEvidence& place, const SearchOptions& options);

}  // namespace helixnav::supervisor
