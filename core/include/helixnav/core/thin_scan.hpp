// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "helixnav/core/events.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::core {

/// An estimator works with at most this many observations of a scan; the work of a scan grows with their third power.
/// The fullest scan of DLR has 13, of a forest 20 m around 168.
inline constexpr std::size_t most_observations_used = 256;

/// Places in the scan of the observations to work with, ascending: all, where there are no more than most_observations_used.
/// Of more, those that cannot be the same as another one kept, as far as the sensor can tell (their difference is
/// within its 99 % gate), spread evenly over the order of the scan. Cost: most_observations_used for each of at most 51 200 observations.
/// Test: core/thin_scan_test.cpp.
std::vector<std::size_t> observations_to_use(const Scan& scan);

/// The scan with these observations only.
Scan thinned(const Scan& scan, const std::vector<std::size_t>& used);

/// Reports of a thinned scan as reports of the whole one: places are those in `used`, and what is not among them is
/// ambiguous. `all` has a report for every observation of the whole scan (reports_of_none). Allocates nothing.
void name_in_whole_scan(const std::vector<std::size_t>& used, std::vector<AssociationReport>& all,
                        std::vector<AssociationReport>& reports) noexcept;

/// An ambiguous observation for each.
std::vector<AssociationReport> reports_of_none(std::size_t observations);

/// Notes in the report of a step that a scan was thinned.
Decision thinning_decision(std::size_t observations, std::size_t used);

}  // namespace helixnav::core
