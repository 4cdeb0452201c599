// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/topography/conversions.h>

#include "helixnav/mrpt_adapter/conversions.hpp"

namespace helixnav::mrpt_adapter {

std::optional<GpsReference> position_of(const mrpt::obs::CObservationGPS& observation) {
  using mrpt::obs::gnss::Message_NMEA_GGA;
  if (!observation.hasMsgClass<Message_NMEA_GGA>()) return std::nullopt;
  const auto& gga = observation.getMsgByClass<Message_NMEA_GGA>().fields;
  if (gga.fix_quality == 0) return std::nullopt;
  const GpsReference position{gga.latitude_degrees, gga.longitude_degrees, gga.altitude_meters};
  const bool finite = std::isfinite(position.latitude_deg) && std::isfinite(position.longitude_deg) &&
                      std::isfinite(position.altitude_m);
  if (!finite) return std::nullopt;
  return position;
}

core::AbsoluteFix fix_of(const mrpt::obs::CObservationGPS& observation, const GpsReference& position,
                         const GpsReference& reference, const MapBuilderOptions& options) {
  const mrpt::topography::TGeodeticCoords here(position.latitude_deg, position.longitude_deg, position.altitude_m);
  const mrpt::topography::TGeodeticCoords origin(reference.latitude_deg, reference.longitude_deg, reference.altitude_m);
  mrpt::math::TPoint3D east_north_up;
  mrpt::topography::geodeticToENU_WGS84(here, east_north_up, origin);
  core::AbsoluteFix fix;
  fix.t_ns = time_of(observation).value_or(0);
  fix.position_world_m = {east_north_up.x, east_north_up.y};
  fix.covariance_m2 = options.gps_std_xy * options.gps_std_xy * Eigen::Matrix2d::Identity();
  fix.antenna_robot_m = {observation.sensorPose.x(), observation.sensorPose.y()};
  return fix;
}

}  // namespace helixnav::mrpt_adapter
