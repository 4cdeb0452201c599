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

/// A scan that recognises nothing old says nothing about where the old landmarks are, and their absence is no evidence.
/// Drops these from `expected`, and those that an open search excludes (null without one).
void drop_what_may_be_elsewhere(const association::LandmarkLife& existence, const Search* open, double old_after_m,
                                const std::vector<core::LandmarkId>& seen, std::vector<core::LandmarkId>& expected);

}  // namespace helixnav::supervisor
