// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "drive.hpp"
#include "helixnav/core/recording.hpp"

namespace helixnav::apps {

/// Takes the truth of a drive on an earlier map into the frame that the drive begins in: that of the map, if that run knows its pose
/// in the frame of the truth; that of the session's own start, if the place is searched for, with that of the map to come. If nobody
/// knows, the truth is in a frame of its own, and is aligned for comparison. A drive without an earlier map is unchanged. Test:
/// python/test_truth_frame.py.
void put_truth_on_map(Drive& job);

/// Likewise for a recording appended to the drive of the run in `folder`; `driven` of its scans were that drive's.
void put_truth_behind(const std::string& folder, std::size_t driven, core::Recording& recording);

}  // namespace helixnav::apps
