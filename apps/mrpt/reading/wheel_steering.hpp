// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <mrpt/obs/CObservationRawDAQ.h>
#include <mrpt/serialization/CSerializable.h>

#include "helixnav/core/ackermann.hpp"
#include "helixnav/logs/acfr_log.hpp"
#include "helixnav/logs/acfr_recording.hpp"

namespace helixnav::apps {

/// Speed of the wheel [m/s] and steering angle [rad, left positive] in a rawlog: a CObservationRawDAQ with this label
/// and two analog inputs. MRPT's own CObservationOdometry has no place for the steering of a car that stands.
inline constexpr const char* wheel_steering_label = "WHEEL_STEERING";
mrpt::obs::CObservationRawDAQ::Ptr wheel_steering(const logs::DeadReckoning& reading);

using RawlogEntries = std::vector<mrpt::serialization::CSerializable::Ptr>;

/// Where a rawlog has such readings: the same entries with, before each observation of landmarks (range scan, bearings
/// and ranges), one movement with its covariance, that of logs::make_recording without its laser_delay_s; readings and CObservationOdometry are
/// gone. Otherwise the entries as they are. InputError for readings without two inputs or without time.
/// Test: mrpt_apps/convert_test.cpp (equal to the increments of the log itself).
RawlogEntries with_movements(RawlogEntries entries, const logs::AcfrSettings& settings);

}  // namespace helixnav::apps
