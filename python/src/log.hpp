// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "helixnav/core/recording.hpp"
#include "helixnav/supervisor/navigator_options.hpp"

namespace helixnav::python {

/// A recording with the navigator's options for it.
struct Log {
  core::Recording recording;
  supervisor::NavigatorOptions navigator;
  bool known_association = false;
  std::string config;  ///< in force, for manifests
  std::uint64_t seed = 0;
};

}  // namespace helixnav::python
