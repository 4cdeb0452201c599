// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/core/recording.hpp"
#include "settings.hpp"

namespace helixnav::apps {

/// What the settings tell of the sensor and its covariances, into the recording.
void tell_recording(core::Recording& recording, const Settings& settings);

/// The navigator's options for a sensor: lengths by its reach except those given.
supervisor::NavigatorOptions fit_to_sensor(const Settings& settings, const core::FieldOfView& view);

/// Those for the sensor that the recording speaks of, and objects that are in no map as the log states them, or to be learnt from it.
/// Test: apps/lengths_test.cpp.
supervisor::NavigatorOptions fit_to_recording(const Settings& settings, const core::Recording& recording);

/// The sensor's field of view and all lengths in force, as lines of comment for the configuration in a manifest.
std::string lengths_text(const supervisor::NavigatorOptions& options, const core::FieldOfView& view);

}  // namespace helixnav::apps
