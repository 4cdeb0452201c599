// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/core/observation.hpp"
#include "helixnav/logs/own_log.hpp"
#include "helixnav/logs/vehicle.hpp"

namespace helixnav::logs {

/// The vehicle's sensor of that name; a log that names none, and a vehicle that has only one, need no names. The
/// default if the vehicle has none at all; core::InputError if it only has others.
SensorModel sensor_called(const std::string& name, const std::string& log, const Vehicle& vehicle);

/// As the sensor measures it, with the noise of the row, else of the sensor; core::InputError if neither gives it.
core::Observation observation_of(const OwnDetection& row, const SensorModel& sensor, const Vehicle& vehicle);

}  // namespace helixnav::logs
