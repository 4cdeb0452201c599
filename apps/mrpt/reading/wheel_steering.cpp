// SPDX-License-Identifier: BSD-3-Clause
#include "reading/wheel_steering.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CObservationOdometry.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/odometry.hpp"
#include "reading/rawlog_movement.hpp"
#include "reading/rawlog_time.hpp"

namespace helixnav::apps {
namespace {

using mrpt::obs::CObservationRawDAQ;
using mrpt::serialization::CSerializable;

const CObservationRawDAQ* as_wheel_steering(const CSerializable::Ptr& entry) {
  const auto* reading = dynamic_cast<const CObservationRawDAQ*>(entry.get());
  return reading != nullptr && reading->sensorLabel == wheel_steering_label ? reading : nullptr;
}

const mrpt::obs::CObservation* as_landmarks(const CSerializable::Ptr& entry) {
  const bool seen = dynamic_cast<const mrpt::obs::CObservation2DRangeScan*>(entry.get()) != nullptr ||
                    dynamic_cast<const mrpt::obs::CObservationBearingRange*>(entry.get()) != nullptr;
  return seen ? dynamic_cast<const mrpt::obs::CObservation*>(entry.get()) : nullptr;
}

logs::DeadReckoning reading_of(const CObservationRawDAQ& reading, std::size_t entry) {
  if (reading.AIN_double.size() != 2 || !has_time(reading.timestamp)) {
    throw core::InputError("entry " + std::to_string(entry) + " (" + wheel_steering_label +
                           "): expected a time and two analog inputs, wheel speed [m/s] and steering [rad]");
  }
  return {time_of_rawlog(reading.timestamp), reading.AIN_double[0], reading.AIN_double[1]};
}

/// The log as make_recording expects it, its scans without returns: only the times at which they were taken
/// matter.
logs::AcfrLog blind_log(const RawlogEntries& entries) {
  logs::AcfrLog log;
  logs::SickScan blind;
  blind.range_cm.fill(8191);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (const auto* reading = as_wheel_steering(entries[i])) {
      log.order.push_back({logs::AcfrLog::Sensor::dead_reckoning, log.dead_reckoning.size()});
      log.dead_reckoning.push_back(reading_of(*reading, i));
    } else if (const auto* landmarks = as_landmarks(entries[i])) {
      if (!has_time(landmarks->timestamp)) {
        throw core::InputError("entry " + std::to_string(i) +
                               ": an observation without time beside readings of wheels");
      }
      log.order.push_back({logs::AcfrLog::Sensor::laser, log.scans.size()});
      blind.t_ns = time_of_rawlog(landmarks->timestamp);
      log.scans.push_back(blind);
    }
  }
  return log;
}

/// The motion before each scan.
std::vector<core::Odometry> motions(const core::Recording& recording) {
  std::vector<core::Odometry> before_scan;
  std::optional<core::Odometry> motion;
  for (const core::Event& event : recording.events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
      motion = motion ? core::chain(*motion, *odometry) : *odometry;
    } else {
      before_scan.push_back(motion ? *motion : core::no_motion(core::time_of(event)));
      motion.reset();
    }
  }
  return before_scan;
}

}  // namespace

CObservationRawDAQ::Ptr wheel_steering(const logs::DeadReckoning& reading) {
  auto observation = std::make_shared<CObservationRawDAQ>();
  observation->timestamp = rawlog_time(reading.t_ns);
  observation->sensorLabel = wheel_steering_label;
  observation->AIN_double = {reading.wheel_speed_mps, reading.steering_rad};
  observation->AIN_channel_count = 2;
  return observation;
}

RawlogEntries with_movements(RawlogEntries entries, const logs::AcfrSettings& settings) {
  const bool has_wheels = std::any_of(entries.begin(), entries.end(), as_wheel_steering);
  if (!has_wheels) return entries;
  logs::AcfrSettings vehicle = settings;
  vehicle.laser_delay_s = 0.0;  // a rawlog states when a scan was taken
  const std::vector<core::Odometry> before_scan = motions(make_recording(blind_log(entries), vehicle));
  RawlogEntries result;
  std::size_t scan = 0;
  for (CSerializable::Ptr& entry : entries) {
    if (as_wheel_steering(entry) != nullptr) continue;
    if (dynamic_cast<const mrpt::obs::CObservationOdometry*>(entry.get()) != nullptr) continue;
    if (as_landmarks(entry) != nullptr) {
      result.push_back(std::make_shared<mrpt::obs::CActionCollection>(movement_of(before_scan[scan++])));
    }
    result.push_back(std::move(entry));
  }
  return result;
}

}  // namespace helixnav::apps
