// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "helixnav/core/recording.hpp"

namespace helixnav::apps {

/// Number of scans among the events.
std::size_t scans_of(const core::Recording& recording);

/// Ends a recording at scan number `most`, counted from 1; a shorter one is unchanged. The truth is kept, too.
/// Test: apps/calibrate/keep_scans_test.cpp
void keep_scans(core::Recording& recording, std::size_t most);

}  // namespace helixnav::apps
