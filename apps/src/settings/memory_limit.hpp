// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "settings.hpp"

namespace helixnav::apps {

/// For every drive without a run folder that could be closed at the limit. Throws CLI::ValidationError.
/// Test: apps/run_folder_test.cpp.
inline void refuse_memory_limit(const Settings& settings, const std::string& why) {
  if (settings.memory_mb > 0.0) throw CLI::ValidationError("--map.memory_mb", "is for replay and simulate: " + why);
}

}  // namespace helixnav::apps
