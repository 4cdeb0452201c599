// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>

#include "team/team_drive.hpp"

namespace helixnav::apps {

/// A time in which a robot without names missed the landmarks that it knew there, and began others beside them: it stood
/// elsewhere than it took itself for, after a slip or wrong matches.
struct MappedAnew {
  core::Nanoseconds from_ns = 0, to_ns = 0;
  double missed = 0.0;  ///< share of the landmarks that it has known for ten seconds and that were to be seen
  double begun = 0.0;   ///< share of what was seen that is of landmarks that no robot knew ten seconds before
};

/// The worst twenty scans of the robot, where both shares are 0.8 or more. Which landmarks are to be seen is told by where it
/// saw others: nearer than nine in ten of these, and within the middle nine tenths of their bearings. Test: apps/mapped_anew_test.cpp.
std::optional<MappedAnew> mapped_anew(const TeamDrive& drive, std::size_t robot);

}  // namespace helixnav::apps
