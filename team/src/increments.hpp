// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <set>
#include <vector>

#include "helixnav/core/odometry.hpp"

namespace helixnav::team {

/// A robot's increments as they came in, and the times at which they are cut because another robot sees it then. The pieces
/// do not depend on the order of arrival: an increment that comes late shortens the one after it, and so moves its cuts.
/// Test: team/increments_test.cpp.
class Increments {
 public:
  /// Consecutive pieces, which replace all that end after `after_ns` and not after `until_ns`.
  struct Pieces {
    core::Nanoseconds after_ns = 0, until_ns = 0;
    std::vector<core::Odometry> motions;
  };

  bool ends_after_all(core::Nanoseconds t_ns) const;
  /// Returns its place, for take_out.
  std::size_t add(const core::Odometry& motion);
  void take_out(std::size_t place);
  /// True if this cuts one of the increments so far. Before the first there is nothing to cut.
  bool cut(core::Nanoseconds t_ns);
  void mend(core::Nanoseconds t_ns);
  /// Of the increments that end at t_ns, and of the one that spans it or follows.
  Pieces pieces_about(core::Nanoseconds t_ns) const;

 private:
  void cut_to_pieces(std::size_t place, Pieces& pieces) const;

  std::vector<core::Odometry> motions_;  ///< by time
  std::set<core::Nanoseconds> cuts_ns_;
};

}  // namespace helixnav::team
