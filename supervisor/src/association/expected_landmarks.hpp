// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/association/landmark_life.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/step_report.hpp"
#include "search/search.hpp"

namespace helixnav::supervisor {

/// Landmarks that the scan should have seen, except those next to an unused observation, which may have been theirs.
std::vector<core::LandmarkId> expected_unseen(const cekf::CompressedEkf& filter, const core::Scan& scan,
                                              double margin_m,
                                              const std::vector<core::AssociationReport>& associations);

/// Landmarks in view, but within the margin of its edges, that the scan did not see; `expected`: those farther in.
std::vector<core::LandmarkId> unseen_at_rim(const cekf::CompressedEkf& filter, const core::Scan& scan,
                                            const std::vector<core::AssociationReport>& associations,
                                            const std::vector<core::LandmarkId>& expected);

/// Limits for deciding whether a scan shows where old landmarks should be.
struct OldGround {
  double old_after_m = 0.0;  ///< a landmark begun or last seen longer ago than this length of drive is old
  double lately_m = 0.0;     ///< two old ones seen within this length locate the vehicle, see below
  double margin_m = 0.0;     ///< least distance of expected landmarks from the edge of the view
};

/// A scan that recognises nothing old says nothing about where the old landmarks are, so their absence is not evidence.
/// It is evidence if the scan recognises two of them; or if it recognises one landmark that already existed when the second
/// last of the old ones was seen, and that was recently: the vehicle has not slipped since. Then landmarks known relative to
/// the vehicle to a third of the margin should be seen, too. Drops the others from `expected`, and those that an open
/// search excludes (null without one).
/// Test: supervisor/association/expected_landmarks_test.cpp.
void drop_what_may_be_elsewhere(const cekf::CompressedEkf& filter, const association::LandmarkLife& existence,
                                const Search* open, const OldGround& ground, const std::vector<core::LandmarkId>& seen,
                                std::vector<core::LandmarkId>& expected);

}  // namespace helixnav::supervisor
