// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace helixnav::apps {

/// The constants that make a log right, by their keys in vehicle.toml, and the factors by which its noise is too small.
struct SpoiltLog {
  std::map<std::string, double> right;
  double noise_scale = 1.5;  ///< of odometry and of detections
};

/// Writes a simulated cart's log into `folder`, made with scale errors of 1 to 3 % in distance and in turns, a turn bias, a sensor
/// that looks 1 to 2 degrees aside and is mounted 0.1 to 0.3 m elsewhere, a delay of 0.05 to 0.15 s, ranges 0.1 to 0.25 m too short, and noise 1.5 times what its
/// vehicle.toml states; that file contains none of these errors. Another seed gives another drive and draws other errors.
SpoiltLog write_spoilt_log(std::uint64_t seed, const std::filesystem::path& folder);

}  // namespace helixnav::apps
