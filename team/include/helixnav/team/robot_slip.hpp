// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/decision.hpp"
#include "helixnav/core/time.hpp"

namespace helixnav::team {

/// A robot slipped before one of its scans without names: its motion was widened there.
struct RobotSlip {
  core::Nanoseconds t_ns = 0;  ///< of the scan
  int robot = 0;
  core::SlipDecision decision;
};

}  // namespace helixnav::team
