// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <mrpt/obs/CObservationRawDAQ.h>
#include <mrpt/serialization/CSerializable.h>

#include "helixnav/core/ackermann.hpp"
#include "helixnav/logs/acfr_log.hpp"
#include "helixnav/logs/acfr_recording.hpp"

namespace helixnav::apps {

/// Wheel speed [m/s] and steering angle [rad, left positive] in a rawlog: a CObservationRawDAQ with this label and two
/// analog inputs. MRPT's own CObservationOdometry cannot hold the steering of a stationary car.
inline constexpr const char* wheel_steering_label = "WHEEL_STEERING";
mrpt::obs::CObservationRawDAQ::Ptr wheel_steering(const logs::DeadReckoning& reading);

using RawlogEntries = std::vector<mrpt::serialization::CSerializable::Ptr>;

/// If a rawlog has such readings: the same entries with, before each observation of landmarks (range scan, bearings and ranges), one movement
/// with its covariance, that of logs::make_recording without its laser_delay_s; the readings and CObservationOdometry are removed. Otherwise
/// the entries unchanged. InputError for readings without two inputs or without time.
/// Test: mrpt_apps/convert_test.cpp (equal to the increments of the log itself).
RawlogEntries with_movements(RawlogEntries entries, const logs::AcfrSettings& settings);

}  // namespace helixnav::apps
