// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/recording.hpp"

namespace helixnav::sim {

/// The part of a recording from its first scan at or after from_ns up to until_ns: another session, which begins there. Times,
/// truth and frames stay as they are, so that `start`, which is where the whole began, is no longer where this one begins.
/// Test: sim/part_of_test.cpp.
core::Recording part_of(const core::Recording& whole, core::Nanoseconds from_ns, core::Nanoseconds until_ns);

/// The same with the motion to its first scan: what a drive goes on with that was interrupted before from_ns.
core::Recording rest_of(const core::Recording& whole, core::Nanoseconds from_ns, core::Nanoseconds until_ns);

}  // namespace helixnav::sim
