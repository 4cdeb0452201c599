// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/association/associate.hpp"
#include "helixnav/cekf/match.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::supervisor {

/// The outcome of every observation. Observations to be augmented have no landmark yet.
std::vector<core::AssociationReport> association_reports(const association::Assignment& assignment);

/// The matched observations, in the form that the filter takes.
std::vector<cekf::Match> matches(const core::Scan& scan, const std::vector<core::AssociationReport>& associations);

/// Landmarks of all observations with this outcome, in the order of the scan.
std::vector<core::LandmarkId> landmarks_with(core::Outcome outcome,
                                             const std::vector<core::AssociationReport>& associations);

}  // namespace helixnav::supervisor
