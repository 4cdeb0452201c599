// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "state.hpp"

namespace helixnav::team {

/// When a landmark was seen, and how well.
struct Looks {
  std::vector<std::pair<std::size_t, std::int64_t>> scans;  ///< (robot, scan), in order
  double variance_m2 = 0.0;                                 ///< of the place from one look, along an axis, on average
};

/// Of landmarks as they are resolved now. `looks_as_one`: TeamOptions. O(rows log rows).
std::map<core::LandmarkId, Looks> looks_of(const std::vector<core::LandmarkId>& ids, double looks_as_one,
                                           const State& state);

/// Things that one scan shows together are two. One look in twenty may have been taken for the other's.
bool were_seen_together(const Looks& a, const Looks& b);

/// A robot saw now one of them and now the other, four times over, a few scans apart, and hardly ever both: of two things that are
/// there, each seen nine times in ten, one alone is seen in one scan in ten. Test: team/looks_test.cpp.
bool were_seen_in_turn(const Looks& a, const Looks& b);

}  // namespace helixnav::team
