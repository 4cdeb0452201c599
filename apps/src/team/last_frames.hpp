// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/core/se2.hpp"
#include "helixnav/core/time.hpp"
#include "helixnav/team/team_join.hpp"

namespace helixnav::apps {

using Joins = std::vector<team::TeamJoin>;

/// Brings poses into the frame that their robot's component has at the end. A join may be taken back, and joins may come out
/// otherwise when everything is gone through again: a pose told while other joins held is first brought out of these.
/// Test: apps/last_frames_test.cpp.
class LastFrames {
 public:
  /// [robot] its component before any join.
  explicit LastFrames(std::vector<int> first_component) : first_component_(std::move(first_component)) {}

  /// The joins that hold now; a number for what is told now.
  std::size_t note(const Joins& joins);

  /// T_end_then for what the robot told when note() gave `then`, by the joins noted last.
  core::Pose2 T_end_then(int robot, std::size_t then) const;

  /// When the robot came into that frame: the time of the last of these joins that moved it; the least time where none did.
  core::Nanoseconds since_ns(int robot) const;

  /// Whether a join held then that is none of those noted last and had put the robot in another's frame.
  bool was_taken_back(int robot, std::size_t then) const;

 private:
  Joins that_moved(int robot, const Joins& joins) const;

  std::vector<int> first_component_;
  std::vector<Joins> noted_;
};

}  // namespace helixnav::apps
