// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "association/gated_scan.hpp"
#include "helixnav/association/landmark_life.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::supervisor {

/// A tentative landmark may be a false alarm, and the observation matched with it another one: then the two say nothing
/// about where the vehicle is. The odds that a match is right are (odds that the landmark exists) · P_D N(ν; 0, S) / λ,
/// where λ is the density of objects in no map, with as many of them per scan as landmarks were begun per scan on this
/// drive. Matches less than 95 % likely to be right are left unused (docs/moving.md, "False alarms", explains the
/// 95), and those of them with P_D N > λ are returned: another sighting there counts towards the landmark's existence,
/// by ln P_D N/λ. Mature landmarks are never in question.
/// Test: supervisor/association/doubtful_matches_test.cpp.
std::vector<association::UnusedSighting> leave_doubtful_unused(const GatedScan& gated,
                                                               const association::LandmarkLife& existence,
                                                               const core::Scan& scan, const NavigatorOptions& options,
                                                               std::vector<core::AssociationReport>& reports);

}  // namespace helixnav::supervisor
