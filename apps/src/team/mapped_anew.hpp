// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>

#include "team/team_drive.hpp"

namespace helixnav::apps {

/// A time in which a robot without names missed the landmarks that it knew there, and began others beside them: after a
/// slip or wrong matches, it was not where it believed itself to be.
struct MappedAnew {
  core::Nanoseconds from_ns = 0, to_ns = 0;
  double missed = 0.0;  ///< share of the landmarks known to it for ten seconds that were expected in view
  double begun = 0.0;   ///< share of observations that belong to landmarks no robot knew ten seconds before
};

/// The worst twenty scans of the robot, if both shares are 0.8 or more. Landmarks are expected in view if they are nearer than nine in
/// ten of those that it saw, and within the middle nine tenths of their bearings. Test: apps/mapped_anew_test.cpp.
std::optional<MappedAnew> mapped_anew(const TeamDrive& drive, std::size_t robot);

}  // namespace helixnav::apps
