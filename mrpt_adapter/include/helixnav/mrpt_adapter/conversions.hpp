// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "helixnav/core/events.hpp"
#include "helixnav/mrpt_adapter/map_builder_options.hpp"

namespace mrpt::obs {
class CActionCollection;
class CObservation;
class CObservation2DRangeScan;
class CObservationBearingRange;
class CObservationGPS;
class CObservationOdometry;
}  // namespace mrpt::obs
namespace mrpt::poses {
class CPose2D;
class CPose3D;
}  // namespace mrpt::poses

namespace helixnav::mrpt_adapter {

/// Time stamp in nanoseconds since 1970 (MRPT counts 100 ns); none when the observation has none.
std::optional<core::Nanoseconds> time_of(const mrpt::obs::CObservation& observation);

/// The motion that actions state: the best CActionRobotMovement2D (in MRPT's sense: least uncertain), else the first
/// CActionRobotMovement3D in the plane; covariance in (x, y, heading), in the frame of the pose before, with its
/// correlations. None without either. `t_ns` is 0: actions do not state when they end. InputError when mean or
/// covariance is not finite or the covariance is not positive semidefinite.
std::optional<core::Odometry> odometry_of(const mrpt::obs::CActionCollection& actions);

/// The increment between two readings of CObservationOdometry, its covariance by MRPT's Gaussian motion model with
/// options.odo_*.
core::Odometry increment_between(const mrpt::poses::CPose2D& before, const mrpt::poses::CPose2D& after,
                                 const MapBuilderOptions& options);

/// Pose in the plane of a sensor that may be at any height; InputError when it is tilted (roll, pitch).
core::Pose2 planar_pose_of(const mrpt::poses::CPose3D& pose, const std::string& whose);

/// A scan with names alongside it.
struct NamedScan {
  core::Scan scan;                        ///< t_ns is 0 when has_time is false
  bool has_time = false;                  ///< the observation has a time stamp
  std::vector<std::int64_t> identities;   ///< landmarkID of each observation, −1 without
  std::vector<std::size_t> measurements;  ///< where in sensedData each observation was
  std::vector<std::string> dropped;       ///< why measurements were left out, one sentence each
};

/// Measurements of one instant. Yaw is wrapped, pitch projected out (the range becomes the planar one). R is the
/// measurement's covariance where validCovariances is set, else options.std_sensor_*, else the observation's own
/// standard deviations; InputError when all are zero.
NamedScan scan_of(const mrpt::obs::CObservationBearingRange& observation, const MapBuilderOptions& options);

/// What options.detector finds. The detectors know a SICK scanner of 361 beams over 180°; a scan of another geometry is
/// resampled to that, each beam taking the nearest ray, and what is more than 90° to the side is ignored.
NamedScan scan_of(const mrpt::obs::CObservation2DRangeScan& observation, const MapBuilderOptions& options);

/// Geodetic reference of the map frame: x east, y north, WGS84.
struct GpsReference {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double altitude_m = 0.0;
};

/// Position in an NMEA GGA message; none without one or when it is invalid (fix_quality 0).
std::optional<GpsReference> position_of(const mrpt::obs::CObservationGPS& observation);

/// The fix in metres east and north of the reference.
core::AbsoluteFix fix_of(const mrpt::obs::CObservationGPS& observation, const GpsReference& position,
                         const GpsReference& reference, const MapBuilderOptions& options);

}  // namespace helixnav::mrpt_adapter
