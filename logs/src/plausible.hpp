// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "text_cursor.hpp"

namespace helixnav::logs {

// What a log of a vehicle may hold; beyond this a number is garbage, and the squares of its products leave the range
// in which a covariance can be distinguished from rounding.
inline constexpr double most_motion_m = 1e4;                      ///< from one scan to the next, in one direction
inline constexpr double most_turn_rad = 1e3;                      ///< likewise
inline constexpr double most_distance_m = 1e5;                    ///< of a landmark from the sensor
inline constexpr double most_coordinate_m = 1e8;                  ///< northings of UTM go up to 1e7
inline constexpr double least_variance = 1e-20;                   ///< (0.1 nm)²
inline constexpr double most_variance = 1e12;                     ///< (1000 km)²
inline constexpr std::int64_t most_name = 1'000'000'000'000'000;  ///< of a pose or a landmark, and its negative
inline constexpr std::size_t most_observations = 50'000;          ///< in one scan

/// What is wrong with a covariance ("is not positive definite"), nothing if it is valid.
std::optional<std::string> fault_of_covariance(const Eigen::Ref<const Eigen::MatrixXd>& covariance);

/// Next field of the line as the name of a pose or a landmark.
inline std::int64_t read_name(TextCursor& cursor, const std::string& what) {
  const std::int64_t name = cursor.integer(what);
  if (name < -most_name || name > most_name) {
    cursor.fail("expected " + what + " of at most 15 digits, found " + std::to_string(name));
  }
  return name;
}

/// Refuses an observation beyond the number that a scan may have.
inline void check_count(const TextCursor& cursor, std::size_t observations) {
  if (observations < most_observations) return;
  cursor.fail("more than " + std::to_string(most_observations) + " observations in one scan");
}

}  // namespace helixnav::logs
