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
  int missing = 0;         ///< old landmarks that should be in view but that it does not match
  double widening = 1.0;   ///< √(|S|/|R|), median over these pairs: how much wider the pose makes their gates
  double width_m = 0.0;    ///< |S|^¼ on the ground, likewise: where each is expected, one standard deviation
  double spacing_m = 0.0;  ///< from old landmarks in view to the nearest other one, median; 0 if fewer than two
  /// P(another pose | scan): (1 + Σ exp e_rival) / (1 + Σ exp e_rival + exp e), where e is the log-likelihood ratio of a
  /// matching against "none of the old landmarks is met".
  double wrong_probability = 1.0;
  /// Old landmarks of loose matches: the vehicle is known relative to the others, but not where these are.
  std::vector<core::LandmarkId> loose;
};

/// Evidence of the assignment's matches with old landmarks (ascending in `old`) together, given its matches with
/// landmarks that are not old: those are right wherever the vehicle is. A matching's evidence is its joint likelihood
/// against as many observations of nothing mapped, `extraneous_per_scan` in the field of view, less a cost for each old
/// landmark that should be in view and is not matched. S is conditioned on the matches that are not old.
/// Cost: O(n²) for n gated pairs with old landmarks, O(n) for every two pairs that a rival may start from.
/// Source: docs/adr/0014-ambiguous-pose.md. Test: supervisor/association/place_evidence_test.cpp.
PlaceEvidence place_evidence(const cekf::CompressedEkf& filter, const association::InnovationProblem& problem,
                             const association::Assignment& assignment, const core::Scan& scan,
                             const std::vector<core::LandmarkId>& old, double extraneous_per_scan, double view_margin_m,
                             const SearchOptions& options);

/// Whether no other pose is in question, so that ambiguities are for the assignment to decide and a search does not
/// help: either the pose widens the gates of the old landmarks little (widening below the limit for a single match), or
/// it leaves no room to confuse neighbours (two standard deviations below half their spacing) and
/// P(another pose | scan) is below `wrong_place_probability`. The pose is in question if two or more matches are loose, whatever the
/// others say; a single one is to be left unused. A match is loose if, given the half of the matches that is known
/// best, its gate holds more than `defer_confusers` objects that are not landmarks: a median says nothing about a
/// single landmark far from all the others, and an extraneous observation in its gate, as wide as the whole drift,
/// would shift everything by as much.
bool fixes_pose(const PlaceEvidence& place, const SearchOptions& options);

/// Whether all poses in question are the same place, so that a search would look for the vehicle where it is: the scan
/// says too little for a match with old landmarks to be certain, but does not contradict the map (missing against
/// matched landmarks, weighed as in the integrity monitor), the pose leaves no room to confuse neighbours, and at most
/// one match is loose. Ambiguous matches are then to be left unused until more is seen, or until the pose has drifted
/// so far that another place may be meant.
bool leaves_one_place(const PlaceEvidence& place, const SearchOptions& options);

}  // namespace helixnav::supervisor
