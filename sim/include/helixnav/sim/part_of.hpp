// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/recording.hpp"

namespace helixnav::sim {

/// The part of a recording from its first scan at or after from_ns up to until_ns: another session, which starts there.
/// Times, truth and frames stay unchanged, so that `start`, where the whole recording started, is no longer where this
/// one starts. Test: sim/part_of_test.cpp.
core::Recording part_of(const core::Recording& whole, core::Nanoseconds from_ns, core::Nanoseconds until_ns);

/// The same including the motion to its first scan: the continuation of a drive that was interrupted before from_ns.
core::Recording rest_of(const core::Recording& whole, core::Nanoseconds from_ns, core::Nanoseconds until_ns);

}  // namespace helixnav::sim
