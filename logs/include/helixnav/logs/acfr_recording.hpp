// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "helixnav/core/ackermann.hpp"
#include "helixnav/core/recording.hpp"
#include "helixnav/core/se2.hpp"
#include "helixnav/logs/acfr_log.hpp"
#include "helixnav/logs/detect_reflectors.hpp"
#include "helixnav/logs/detect_trees.hpp"

namespace helixnav::logs {

/// How a raw log of the ACFR truck becomes increments and observations. Defaults: the truck, and noise for its trees.
struct AcfrSettings {
  enum class Detector { trees, reflectors };

  core::AckermannGeometry geometry;                  ///< L = 2.83 m, H = 0.76 m
  core::AckermannNoise noise{0.29, 0.012};           ///< of each dead-reckoning sample, white
  double sigma_sideways_m_per_sqrt_m = 0.022;        ///< of side slip, which a wheel model alone excludes
  double speed_scale = 1.0041;                       ///< times the recorded wheel speed
  double steering_scale = 0.9786;                    ///< times the recorded angle; docs/adr/0007-victoria-park.md, and
  double steering_offset_rad = 0.0012;               ///< added to that
  double laser_delay_s = 0.0619;                     ///< a scan was taken this long before its stamp
  core::Pose2 T_robot_laser{3.736, 0.595, -0.0191};  ///< from the centre of the rear axle

  Detector detector = Detector::trees;
  TreeRules trees;
  ReflectorRules reflectors;

  double sigma_range_m = 0.7;
  double sigma_bearing_rad = 0.03;
  /// Field of view: a landmark nearer than this is expected to be seen. Far shorter than the detector's reach; with
  /// that, negative information would kill the map: of the mapped trees in front, 67 % are seen at 5 … 20 m, 40 % at 25
  /// … 30 m, 14 % at 35 … 40 m, 1 % beyond 50 m.
  double view_range_m = 22.0;
  std::optional<double> extraneous_per_scan;  ///< Recording::extraneous_per_scan
  double reach_m = 30.0;  ///< two of five trees in front are still seen there; the limit of the rules for reflectors
};

/// For ACFR's car park: poles with reflecting tape, of which 44 % are seen within 5 m and 22 % at 5 … 10 m. The
/// steering offset is the one with the smallest innovations of the filter (NIS, offsets of −0.01 … 0.01 rad tried); the
/// noise was compared on this one log by the error of the beacons, about 30 combinations, so expect less elsewhere.
AcfrSettings car_park_settings();

/// The log with its scans stamped, and ordered, by the time they were taken.
AcfrLog without_laser_delay(AcfrLog log, double delay_s);

/// Dead reckoning as increments, scans as observations, GPS and beacons as truth (the antenna is assumed to be at the
/// laser, as the data suggest). A sample of speed and steering holds from its time until the next one (before the first
/// there is no motion; the last holds until the last scan); an increment is split exactly at the scans, its covariance
/// in proportion to time, so that splitting changes nothing. Events come in the order of log.order; the start is the
/// identity with zero covariance. Cost: detection, 5 µs per scan, and 0.3 µs per sample. Test:
/// logs/acfr_recording_test.cpp.
core::Recording make_recording(const AcfrLog& as_recorded, const AcfrSettings& settings);

}  // namespace helixnav::logs
