// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/association/landmark_life.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/step_report.hpp"
#include "search/search.hpp"

namespace helixnav::supervisor {

/// Landmarks that the scan should have seen, less those next to an unused observation, which may have been theirs.
std::vector<core::LandmarkId> expected_unseen(const cekf::CompressedEkf& filter, const core::Scan& scan,
                                              double margin_m,
                                              const std::vector<core::AssociationReport>& associations);

/// Landmarks in view but within the margin of its edges that the scan did not see; `expected` is what lies inside the margin.
std::vector<core::LandmarkId> unseen_at_rim(const cekf::CompressedEkf& filter, const core::Scan& scan,
                                            const std::vector<core::AssociationReport>& associations,
                                            const std::vector<core::LandmarkId>& expected);

/// What tells whether a scan shows where old landmarks should be.
struct OldGround {
  double old_after_m = 0.0;  ///< a landmark begun or unseen over this length of the drive is old
  double lately_m = 0.0;     ///< two old ones that were seen over this length place the vehicle, see below
  double margin_m = 0.0;     ///< that expected landmarks keep from the rim of the view
};

/// A scan that recognises nothing old says nothing about where the old landmarks are, and their absence is no evidence. It does
/// where it recognises two of them; and where it recognises one landmark that was there when the second last of the old ones was
/// seen, which was lately: the vehicle has not slipped since. Then what is known relative to the vehicle to a third of the margin
/// should be seen, too. Drops the others from `expected`, and those that an open search excludes (null without one).
/// Test: supervisor/association/expected_landmarks_test.cpp.
void drop_what_may_be_elsewhere(const cekf::CompressedEkf& filter, const association::LandmarkLife& existence,
                                const Search* open, const OldGround& ground, const std::vector<core::LandmarkId>& seen,
                                std::vector<core::LandmarkId>& expected);

}  // namespace helixnav::supervisor
