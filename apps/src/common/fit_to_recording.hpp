// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/core/recording.hpp"
#include "settings/settings.hpp"

namespace helixnav::apps {

/// Factors on the covariances of every increment and of every observation.
void scale_covariances(core::Recording& recording, double of_odometry, double of_observations);

/// Applies the sensor and covariance settings to the recording.
void apply_log_settings(core::Recording& recording, const Settings& settings);

/// The navigator's options for a sensor: lengths by its reach except those given explicitly.
supervisor::NavigatorOptions fit_to_sensor(const Settings& settings, const core::FieldOfView& view);

/// Those for the recording's sensor, and the density of unmapped objects as the log states it, or to be learnt from it.
/// Test: apps/lengths_test.cpp.
supervisor::NavigatorOptions fit_to_recording(const Settings& settings, const core::Recording& recording);

/// The sensor's field of view and all lengths in force, as comment lines for the configuration in a manifest.
std::string lengths_text(const supervisor::NavigatorOptions& options, const core::FieldOfView& view);

/// The part of this that the chosen filter has: FastSLAM has no lengths.
std::string in_force_text(const Settings& settings, const supervisor::NavigatorOptions& options,
                          const core::Recording& recording);

}  // namespace helixnav::apps
