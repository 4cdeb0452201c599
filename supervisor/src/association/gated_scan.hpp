// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "association/confirmation.hpp"
#include "association/gating.hpp"
#include "association/place_evidence.hpp"
#include "association/revisit_ambiguity.hpp"
#include "helixnav/association/associate.hpp"
#include "helixnav/association/landmark_life.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/supervisor/navigator_options.hpp"

namespace helixnav::supervisor {

/// What the map expects a scan to look like, the best assignment, and which old landmarks it may have returned to.
struct GatedScan {
  core::PoseGaussian pose;  ///< that it was gated from
  std::unique_ptr<Gating> gating;
  association::Assignment assignment;
  std::vector<RevisitAmbiguity> returns;
  std::vector<RevisitAmbiguity> away;  ///< likewise, of landmarks unseen for a reach of the sensor that are not old yet
  PlaceEvidence place;                 ///< weighed if a return alone is too ambiguous
  /// Tentative landmarks that the vehicle has drifted from, ascending: left unused.
  std::vector<core::LandmarkId> doubtful;
};

/// `appearance`: class and size of the landmarks.
GatedScan gate_scan(const cekf::CompressedEkf& filter, const std::vector<core::LandmarkId>& candidates,
                    const core::Scan& scan, const NavigatorOptions& options,
                    const core::MapAppearance& appearance = {});

/// Fills returns and place. `view`: what the sensor is known to see.
void look_for_returns(const cekf::CompressedEkf& filter, const association::LandmarkLife& existence,
                      const core::Scan& scan, const NavigatorOptions& options, const core::FieldOfView& view,
                      GatedScan& gated);

/// Leaves all old landmarks unmatched: while a search is open, none can begin for those that have become old since, and
/// the pose by which they would be matched is in question.
void leave_returns_unused(GatedScan& gated);

/// Old landmarks that are ambiguous by themselves (defer_confusers) are not matched, however many others are.
void leave_ambiguous_unused(const SearchOptions& options, GatedScan& gated);

/// A range or a bearing alone fits too many landmarks: without identities it is left unused.
void leave_unplaced_unused(const core::Scan& scan, std::vector<core::AssociationReport>& reports);

/// Whether any observation is a range or a bearing alone: it is then not known what the scan did not see.
bool has_unplaced(const core::Scan& scan);

/// The outcome of every observation. Two matched old landmarks confirm each other; an isolated match is deferred if other
/// objects may be in its gate, and, if it would correct the pose by a lot, until its second hit at the same place and unless it is 95 %
/// likely to be right, beside an object in no map and beside the other observations that may be of that landmark. A single match of a
/// landmark that has been out of view for a reach of the sensor, which where the road winds may be far less than makes it old, is deferred
/// where an object in no map is likelier. A loose match (place_evidence.hpp) is deferred too, however many others there are.
/// Tests: supervisor/association/revisit_ambiguity_test.cpp, isolated_match_test.cpp.
std::vector<core::AssociationReport> associate_scan(const GatedScan& gated, const core::Scan& scan,
                                                    const NavigatorOptions& options, double path_m,
                                                    Confirmation& confirmation);

}  // namespace helixnav::supervisor
