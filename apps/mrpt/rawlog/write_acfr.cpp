// SPDX-License-Identifier: BSD-3-Clause
#include "rawlog/write_acfr.hpp"

#include <algorithm>
#include <memory>
#include <optional>

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/topography/conversions.h>

#include "helixnav/core/ackermann.hpp"
#include "rawlog/rawlog_sink.hpp"
#include "reading/rawlog_time.hpp"
#include "reading/wheel_steering.hpp"

namespace helixnav::apps {
namespace {

const mrpt::topography::TGeodeticCoords nominal_place(-33.886, 151.194, 0.0);
constexpr int first_error_code_cm = 8183;  // SickScan: values from here on are not ranges

bool is_shiny(const logs::SickScan& scan) {
  return std::any_of(scan.reflectivity.begin(), scan.reflectivity.end(), [](int code) { return code > 0; });
}

mrpt::poses::CPose3D in_space(const core::Pose2& pose) { return {pose.x_m, pose.y_m, 0.0, pose.heading_rad, 0.0, 0.0}; }

mrpt::obs::CObservation2DRangeScan::Ptr range_scan(const logs::SickScan& scan, const core::Pose2& T_robot_laser,
                                                   bool with_reflectivity) {
  auto observation = std::make_shared<mrpt::obs::CObservation2DRangeScan>();
  observation->timestamp = rawlog_time(scan.t_ns);
  observation->sensorLabel = "LASER";
  observation->aperture = static_cast<float>(core::pi);
  observation->rightToLeft = true;
  observation->maxRange = 0.01F * first_error_code_cm;
  observation->sensorPose =
      mrpt::poses::CPose3D(T_robot_laser.x_m, T_robot_laser.y_m, 0.0, T_robot_laser.heading_rad, 0.0, 0.0);
  observation->setScanHasIntensity(with_reflectivity);
  observation->resizeScan(scan.range_cm.size());
  for (std::size_t beam = 0; beam < scan.range_cm.size(); ++beam) {
    observation->setScanRange(beam, static_cast<float>(0.01 * scan.range_cm[beam]));
    observation->setScanRangeValidity(beam, scan.range_cm[beam] < first_error_code_cm);
    if (with_reflectivity) observation->setScanIntensity(beam, scan.reflectivity[beam]);
  }
  return observation;
}

mrpt::obs::CObservationGPS::Ptr gps_fix(const logs::GpsFix& fix, const logs::GpsFix& first,
                                        const core::Pose2& T_robot_antenna) {
  const Eigen::Vector2d from_first_m = fix.position_m - first.position_m;
  mrpt::topography::TGeocentricCoords centred;
  mrpt::topography::ENUToGeocentric({from_first_m.x(), from_first_m.y(), 0.0}, nominal_place, centred,
                                    mrpt::topography::TEllipsoid::Ellipsoid_WGS84());
  mrpt::topography::TGeodeticCoords place;
  mrpt::topography::geocentricToGeodetic(centred, place);
  mrpt::obs::gnss::Message_NMEA_GGA message;
  message.fields.latitude_degrees = place.lat.decimal_value;
  message.fields.longitude_degrees = place.lon.decimal_value;
  message.fields.altitude_meters = place.height;
  message.fields.fix_quality = 1;
  auto observation = std::make_shared<mrpt::obs::CObservationGPS>();
  observation->timestamp = rawlog_time(fix.t_ns);
  observation->sensorLabel = "GPS";
  observation->sensorPose = in_space(T_robot_antenna);
  observation->setMsg(message);
  return observation;
}

/// Dead reckoning as other programs read it.
class Odometer {
 public:
  explicit Odometer(const logs::AcfrSettings& settings) : settings_(settings) {}

  mrpt::obs::CObservationOdometry read(const logs::DeadReckoning& reading) {
    if (last_) pose_ = core::compose(pose_, moved(*last_, core::seconds(reading.t_ns - last_->t_ns)).T_before_after);
    last_ = reading;
    constexpr double short_s = 1e-3;
    const core::Pose2 soon = moved(reading, short_s).T_before_after;
    mrpt::obs::CObservationOdometry observation;
    observation.timestamp = rawlog_time(reading.t_ns);
    observation.sensorLabel = "ODOMETRY";
    observation.odometry = {pose_.x_m, pose_.y_m, pose_.heading_rad};
    observation.hasVelocities = true;
    observation.velocityLocal = {soon.x_m / short_s, 0.0, soon.heading_rad / short_s};
    return observation;
  }

 private:
  core::Odometry moved(const logs::DeadReckoning& reading, double duration_s) const {
    return core::ackermann_increment(
        settings_.geometry, settings_.noise,
        {reading.wheel_speed_mps, settings_.steering_scale * reading.steering_rad + settings_.steering_offset_rad,
         duration_s});
  }

  const logs::AcfrSettings& settings_;
  core::Pose2 pose_;
  std::optional<logs::DeadReckoning> last_;
};

}  // namespace

RawlogCounts write_acfr(const logs::AcfrLog& as_recorded, const logs::AcfrSettings& settings, const std::string& path) {
  const logs::AcfrLog log = logs::without_laser_delay(as_recorded, settings.laser_delay_s);
  RawlogSink sink(path);
  RawlogCounts counts;
  Odometer odometer(settings);
  const bool with_reflectivity = std::any_of(log.scans.begin(), log.scans.end(), is_shiny);
  for (const logs::AcfrLog::Reading& reading : log.order) {
    if (reading.sensor == logs::AcfrLog::Sensor::laser) {
      sink.write(*range_scan(log.scans[reading.index], settings.T_robot_laser, with_reflectivity));
      ++counts.scans;
    } else if (reading.sensor == logs::AcfrLog::Sensor::gps) {
      sink.write(*gps_fix(log.gps[reading.index], log.gps.front(), settings.T_robot_laser));
      ++counts.observations;
    } else {
      const logs::DeadReckoning& wheels = log.dead_reckoning[reading.index];
      sink.write(*wheel_steering(wheels));
      sink.write(odometer.read(wheels));
      ++counts.movements;
    }
  }
  sink.finish();
  return counts;
}

}  // namespace helixnav::apps
