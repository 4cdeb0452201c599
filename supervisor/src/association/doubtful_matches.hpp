// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "association/gated_scan.hpp"
#include "helixnav/association/landmark_life.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::supervisor {

/// A tentative landmark may be a false alarm, and the observation matched with it another: the two say nothing of where the vehicle
/// is. The odds that a match is right are (odds that the landmark exists) · P_D N(ν; 0, S) / λ, λ the density of what is in no
/// map, of which a scan has as many as the scans of this drive have begun. Matches that are right with less than 95 % are left
/// unused (docs/slips.md, "False alarms", says why 95), and those with P_D N > λ returned: that something was seen there again
/// counts for the landmark's existence, by ln P_D N/λ. Mature landmarks are never in question.
/// Test: supervisor/association/doubtful_matches_test.cpp.
std::vector<association::UnusedSighting> leave_doubtful_unused(const GatedScan& gated,
                                                               const association::LandmarkLife& existence,
                                                               const core::Scan& scan, const NavigatorOptions& options,
                                                               std::vector<core::AssociationReport>& reports);

}  // namespace helixnav::supervisor
