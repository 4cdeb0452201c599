// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "helixnav/core/gaussian.hpp"

namespace helixnav::team {

/// Sightings of one robot that the filter took or refused.
struct SightingCounts {
  std::int64_t accepted = 0;
  std::int64_t refused = 0;
};

/// A named landmark that is seen somewhere else than it was: refused sightings in a row that agree about a place, of robots
/// that see most other things where they should be. A misread name is seen now here and now there, and a robot that was moved sees
/// nothing where it should be. Test: team/moved_landmark_test.cpp.
class MovedLandmark {
 public:
  /// The place at which a refused sighting puts it, and what the robot has seen so far, this sighting included.
  void refuse(std::size_t robot, const core::PointGaussian& place, const SightingCounts& robots);
  /// It was seen where it should be.
  void accept() { in_a_row_ = 0; }

  /// Refused often enough: five times in a row, as for one vehicle (docs/names.md), and a quarter as often as it was `observed`
  /// where it was: a robot that loses its way for a while sees much where it is not.
  bool has_moved(int observed, const SightingCounts& robots) const;

 private:
  int in_a_row_ = 0;
  int by_robot_ = 0;  ///< of them, the last ones in a row by the same
  std::size_t robot_ = 0;
  core::PointGaussian place_;  ///< of the last one refused
  SightingCounts before_;      ///< by_robot_ sightings ago
};

}  // namespace helixnav::team
