// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace helixnav::apps {

/// The constants that make a log right, by their keys in vehicle.toml, and the factors that its noise lacks.
struct SpoiltLog {
  std::map<std::string, double> right;
  double noise_scale = 1.5;  ///< of odometry and of detections
};

/// Writes a simulated cart's log into `folder`, made with a scale of 1 to 3 % on ways and on turns, a bias of turns, a sensor
/// that looks 1 to 2 degrees aside and stands 0.1 to 0.3 m elsewhere, a delay of 0.05 to 0.15 s, ranges 0.1 to 0.25 m too short, and noise half as large again as its
/// vehicle.toml says, which knows nothing of all that. Another seed is another drive and draws others.
SpoiltLog write_spoilt_log(std::uint64_t seed, const std::filesystem::path& folder);

}  // namespace helixnav::apps
