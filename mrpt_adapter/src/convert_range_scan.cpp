// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include <mrpt/obs/CObservation2DRangeScan.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/observation.hpp"
#include "helixnav/logs/acfr_recording.hpp"
#include "helixnav/logs/detect_reflectors.hpp"
#include "helixnav/logs/detect_trees.hpp"
#include "helixnav/mrpt_adapter/conversions.hpp"

namespace helixnav::mrpt_adapter {
namespace {

using mrpt::obs::CObservation2DRangeScan;

constexpr double sick_step_rad = core::pi / 360.0;
constexpr std::uint16_t no_return_cm = 8191;

/// The rays of a scan, counted counter-clockwise from the right end.
struct Rays {
  explicit Rays(const CObservation2DRangeScan& scan)
      : count(scan.getScanSize()),
        aperture_rad(scan.aperture),
        step_rad(count > 1 ? aperture_rad / static_cast<double>(count - 1) : 0.0) {}

  std::size_t count;
  double aperture_rad;
  double step_rad;
};

void check(const Rays& rays, const std::string& whose) {
  if (rays.count > 1 && std::isfinite(rays.aperture_rad) && rays.aperture_rad > 0.0) return;
  throw core::InputError(whose + ": a scan of " + std::to_string(rays.count) + " rays over " +
                         std::to_string(rays.aperture_rad) + " rad");
}

std::uint16_t range_cm(const CObservation2DRangeScan& scan, std::size_t ray) {
  const double range_m = scan.getScanRange(ray);
  if (!scan.getScanRangeValidity(ray) || !(range_m >= 0.0) || !(range_m * 100.0 < no_return_cm)) return no_return_cm;
  return static_cast<std::uint16_t>(std::lround(range_m * 100.0));
}

/// For a scan of the SICK's own geometry this takes ray k for beam k.
logs::SickScan sick_scan_of(const CObservation2DRangeScan& scan, const Rays& rays) {
  logs::SickScan sick;
  sick.t_ns = time_of(scan).value_or(0);
  for (int beam = 0; beam < logs::SickScan::beams; ++beam) {
    const auto k = static_cast<std::size_t>(beam);
    const double from_right_rad = beam * sick_step_rad - core::pi / 2.0 + rays.aperture_rad / 2.0;
    const double nearest = std::round(from_right_rad / rays.step_rad);
    sick.range_cm[k] = no_return_cm;
    if (nearest < 0.0 || nearest > static_cast<double>(rays.count - 1)) continue;
    const auto counted = static_cast<std::size_t>(nearest);
    const std::size_t ray = scan.rightToLeft ? counted : rays.count - 1 - counted;
    sick.range_cm[k] = range_cm(scan, ray);
    if (scan.hasIntensity()) {
      sick.reflectivity[k] = static_cast<std::uint8_t>(std::clamp(scan.getScanIntensity(ray), 0, 255));
    }
  }
  return sick;
}

/// What is known of a detector, unless the options say better.
struct Detector {
  explicit Detector(const MapBuilderOptions& options) : trees(options.detector == "trees") {
    const logs::AcfrSettings measured = trees ? logs::AcfrSettings{} : logs::car_park_settings();
    const auto either = [](double chosen, double own) { return chosen > 0.0 ? chosen : own; };
    sigma_range_m = either(options.std_detector_range, measured.sigma_range_m);
    sigma_bearing_rad = either(options.std_detector_yaw_rad, measured.sigma_bearing_rad);
    view_range_m = either(options.detector_view_range, measured.view_range_m);
    reach_m = measured.reach_m;
  }

  bool trees;
  double sigma_range_m;
  double sigma_bearing_rad;
  double view_range_m;
  double reach_m;
};

core::FieldOfView field_of_view(const Rays& rays, const Detector& detector) {
  const logs::TreeRules rules;
  const double half_rad = std::min(core::pi, rays.aperture_rad) / 2.0 - (detector.trees ? rules.edge_margin_rad : 0.0);
  return {detector.trees ? rules.min_range_m : 0.0, detector.view_range_m, -half_rad, half_rad, detector.reach_m};
}

}  // namespace

NamedScan scan_of(const CObservation2DRangeScan& observation, const MapBuilderOptions& options) {
  const std::string whose = "CObservation2DRangeScan \"" + observation.sensorLabel + "\"";
  const Rays rays(observation);
  check(rays, whose);
  const Detector detector(options);
  const logs::SickScan sick = sick_scan_of(observation, rays);
  NamedScan result;
  result.has_time = time_of(observation).has_value();
  result.scan.t_ns = sick.t_ns;
  result.scan.T_robot_sensor = planar_pose_of(observation.sensorPose, whose);
  result.scan.field_of_view = field_of_view(rays, detector);
  for (const logs::SickDetection& seen : detector.trees ? logs::detect_trees(sick) : logs::detect_reflectors(sick)) {
    result.measurements.push_back(result.measurements.size());
    result.identities.push_back(-1);
    result.scan.observations.push_back(
        core::make_range_bearing(seen.range_m, seen.bearing_rad, detector.sigma_range_m, detector.sigma_bearing_rad));
  }
  return result;
}

}  // namespace helixnav::mrpt_adapter
