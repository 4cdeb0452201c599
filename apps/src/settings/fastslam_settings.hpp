// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <set>
#include <string>

#include "helixnav/fastslam/options.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace helixnav::apps {

/// --filter fastslam and its options --fastslam.KEY.
struct FastSlamSettings {
  bool chosen = false;
  fastslam::Options options;
  std::uint64_t seed = 1;
};

using GivenOptions = std::set<const CLI::Option*>;  ///< as returned by options_given

/// Refuses settings that the chosen filter does not have, if the command line gives them or a file, which may hold all
/// keys, has them at other than their defaults; and those of FastSLAM that contradict each other. To be called after the
/// configuration file, before the vehicle. CLI::ValidationError.
void check_filter(const CLI::App& command, const GivenOptions& given, const FastSlamSettings& settings);

/// For commands that support the compressed EKF only: FastSLAM is refused, `why` after its name.
void require_compressed_ekf(const CLI::App& command, const GivenOptions& given, const FastSlamSettings& settings,
                            const std::string& why);

/// The settings that matter most, in a line.
std::string text_of(const FastSlamSettings& settings);

}  // namespace helixnav::apps
