// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "helixnav/core/recording.hpp"
#include "settings/settings.hpp"

namespace helixnav::apps {

/// A log made ready for a navigator as the settings say, but for sensor and covariances (apply_log_settings).
struct LogToReplay {
  core::Recording recording;
  std::optional<double> estimated_range_scale;  ///< where ranges were made right by one
};

/// Reads the log at `path`, by the vehicle that apply_vehicle has read; makes ranges that read long right and fixes of the
/// GPS where that is asked for. core::InputError names file, line and column. Test: apps/fusing_test.cpp,
/// python/test_same_result.py.
LogToReplay read_to_replay(const std::string& path, Settings& settings);

}  // namespace helixnav::apps
