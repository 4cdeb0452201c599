// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "helixnav/core/recording.hpp"
#include "helixnav/supervisor/navigator_options.hpp"
#include "settings/fastslam_settings.hpp"

namespace helixnav::python {

/// A recording with the navigator's options for it.
struct Log {
  core::Recording recording;
  supervisor::NavigatorOptions navigator;
  apps::FastSlamSettings fastslam;  ///< in place of the navigator, where it is chosen
  bool known_association = false;
  bool is_own_log = false;         ///< in the user's own format
  std::vector<bool> withheld;      ///< [scan] not to be fed; empty: none is
  std::vector<std::string> files;  ///< that it was read from
  std::string config;              ///< in force, for manifests
  std::uint64_t seed = 0;
};

}  // namespace helixnav::python
