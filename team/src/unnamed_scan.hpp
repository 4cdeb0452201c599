// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "helixnav/core/step_report.hpp"
#include "helixnav/supervisor/find_slip.hpp"
#include "helixnav/team/team_options.hpp"
#include "state.hpp"

namespace helixnav::team {

/// What a scan without names is of.
struct UnnamedScan {
  std::vector<core::AssociationReport> fate;  ///< [observation] matched, to begin a landmark, or ambiguous
  std::optional<supervisor::Slip> slip;       ///< the robot slipped before it, and `fate` allows for that
  std::vector<int> order;                     ///< in which the observations are to be processed
};

/// Associates a scan with the landmarks of the robot's component. If a slip explains it better, by the evidence that the
/// navigator of one robot asks for (supervisor::find_slip), the pairs of the slip are matched and the others associated from
/// where these put the robot. Pairs come first then, the farthest before the nearest: each is nearly linear in the error
/// that those before it leave. Test: team/slip_test.cpp.
UnnamedScan read_unnamed(std::size_t robot, const core::Scan& scan, const TeamOptions& options, const State& state);

}  // namespace helixnav::team
