// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "helixnav/core/recording.hpp"
#include "settings/settings.hpp"

namespace helixnav::apps {

/// A log made ready for a navigator by the settings, except for sensor and covariances (apply_log_settings).
struct LogToReplay {
  core::Recording recording;
  std::optional<double> estimated_range_scale;  ///< if ranges were corrected by one
};

/// Reads the log at `path`, with the vehicle that apply_vehicle has read; corrects ranges that read long, and makes fixes
/// from the GPS, if requested. core::InputError names file, line and column. Test: apps/fusing_test.cpp,
/// python/test_same_result.py.
LogToReplay read_to_replay(const std::string& path, Settings& settings);

}  // namespace helixnav::apps
