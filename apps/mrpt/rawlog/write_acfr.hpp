// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/logs/acfr_log.hpp"
#include "helixnav/logs/acfr_recording.hpp"
#include "rawlog/write_recording.hpp"

namespace helixnav::apps {

/// Writes a log of the ACFR truck as single observations in their original order: each scan raw as
/// CObservation2DRangeScan (reflectivity as intensity), GPS as CObservationGPS (GGA), each wheel and steering reading
/// as described in wheel_steering.hpp and, for other programs, as CObservationOdometry: pose and velocity of the rear
/// axle by the vehicle of `settings`. A scan has the time at which it was taken (settings.laser_delay_s). Nothing is
/// detected or averaged; reading the rawlog gives the log's events again. The GPS of these logs is metric and local:
/// its first fix is put at a nominal place in Sydney, the antenna at the laser, as the data say. Lost: surveyed beacons
/// and times finer than 100 ns. Test: mrpt_apps/convert_test.cpp.
RawlogCounts write_acfr(const logs::AcfrLog& as_recorded, const logs::AcfrSettings& settings, const std::string& path);

}  // namespace helixnav::apps
