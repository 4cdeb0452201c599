// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "closing/stretch.hpp"

namespace helixnav::supervisor {

/// Whether a stretch surely belongs where it is placed, whatever the covariance between the two maps says, which may be too small where
/// they are bent. All of this: more landmarks have a partner than have none on ground that both looked at; chance makes as many pairs
/// a thousand times less often than places were tried, (M − 3/2)·g nats for M pairs that also fix the pose, g = −ln of the probability
/// that chance puts an old landmark within a pair's tolerance (pf_relocalize::ConstellationScore::appearance_matches); and moved from
/// a landmark to any other one, as by a tree's spacing in an avenue, the stretch has a thousand times less likely partners.
/// O(old · branch · old). Test: supervisor/closing/duplicate_segment_test.cpp (a lattice
/// with and without its end).
bool is_surely_placed(const Stretch& stretch, const Placing& placing, const SearchOptions& options);

}  // namespace helixnav::supervisor
