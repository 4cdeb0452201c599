// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/core/observation.hpp"
#include "helixnav/logs/own_log.hpp"
#include "helixnav/logs/vehicle.hpp"

namespace helixnav::logs {

/// The vehicle's sensor of that name; a log that names none, and a vehicle that has but one, need no names. The default
/// where the vehicle has none at all; core::InputError where it has others only.
SensorModel sensor_called(const std::string& name, const std::string& log, const Vehicle& vehicle);

/// As the sensor measures it, with the noise of the row, else of the sensor; core::InputError where neither gives it.
core::Observation observation_of(const OwnDetection& row, const SensorModel& sensor, const Vehicle& vehicle);

}  // namespace helixnav::logs
