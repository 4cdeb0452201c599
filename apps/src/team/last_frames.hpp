// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/core/se2.hpp"
#include "helixnav/core/time.hpp"
#include "helixnav/team/team_join.hpp"

namespace helixnav::apps {

using Joins = std::vector<team::TeamJoin>;

/// Brings poses into the final frame of their robot's component. A join may be taken back, and joins may come out
/// differently when everything is reprocessed: a pose reported while other joins held is first transformed out of these.
/// Test: apps/last_frames_test.cpp.
class LastFrames {
 public:
  /// [robot] its component before any join.
  explicit LastFrames(std::vector<int> first_component) : first_component_(std::move(first_component)) {}

  /// The joins that hold now; returns a number for what is reported now.
  std::size_t note(const Joins& joins);

  /// T_end_then for what the robot reported when note() gave `then`, by the joins noted last.
  core::Pose2 T_end_then(int robot, std::size_t then) const;

  /// When the robot came into that frame: the time of the last of these joins that moved it; the least time if none did.
  core::Nanoseconds since_ns(int robot) const;

  /// Whether a join held then that is not among those noted last and had put the robot in another's frame.
  bool was_taken_back(int robot, std::size_t then) const;

 private:
  Joins that_moved(int robot, const Joins& joins) const;

  std::vector<int> first_component_;
  std::vector<Joins> noted_;
};

}  // namespace helixnav::apps
