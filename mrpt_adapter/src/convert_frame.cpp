// SPDX-License-Identifier: BSD-3-Clause
#include "convert_frame.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationOdometry.h>

#include "helixnav/core/errors.hpp"

namespace helixnav::mrpt_adapter {
namespace {

using mrpt::obs::CObservation;

struct Timed {
  core::Nanoseconds t_ns;
  const CObservation* observation;
};

std::vector<Timed> in_order_of_time(const mrpt::obs::CSensoryFrame& frame) {
  std::vector<Timed> ordered;
  core::Nanoseconds last_ns = std::numeric_limits<core::Nanoseconds>::min();
  for (const CObservation::Ptr& observation : frame) {
    if (!observation) continue;
    last_ns = time_of(*observation).value_or(last_ns);
    ordered.push_back({last_ns, observation.get()});
  }
  std::stable_sort(ordered.begin(), ordered.end(), [](const Timed& a, const Timed& b) { return a.t_ns < b.t_ns; });
  return ordered;
}

class Converter {
 public:
  Converter(FrameInput& to, bool has_action, const MapBuilderOptions& options)
      : to_(to), has_action_(has_action), options_(options) {}

  void convert(const CObservation& observation) {
    if (const auto* odometry = dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation)) {
      take(*odometry);
    } else if (const auto* landmarks = dynamic_cast<const mrpt::obs::CObservationBearingRange*>(&observation)) {
      take(scan_of(*landmarks, options_));
    } else if (const auto* laser = dynamic_cast<const mrpt::obs::CObservation2DRangeScan*>(&observation)) {
      if (options_.detector != "none") take(scan_of(*laser, options_));
    } else if (const auto* gps = dynamic_cast<const mrpt::obs::CObservationGPS*>(&observation)) {
      if (options_.gps_use) take(*gps);
    }
  }

 private:
  void take(const mrpt::obs::CObservationOdometry& observation) {
    const mrpt::poses::CPose2D& reading = observation.odometry;
    if (!std::isfinite(reading.x()) || !std::isfinite(reading.y()) || !std::isfinite(reading.phi())) {
      throw core::InputError("CObservationOdometry \"" + observation.sensorLabel + "\": its pose is not finite");
    }
    MotionState& motion = to_.motion;
    const std::optional<core::Nanoseconds> t_ns = time_of(observation);
    if (t_ns && motion.last_reading_ns && *t_ns < *motion.last_reading_ns) {
      to_.warnings.push_back("CObservationOdometry \"" + observation.sensorLabel +
                             "\" is older than the last one and was passed over");
      return;
    }
    if (motion.last_reading && !has_action_ && !options_.force_ignore_odometry) {
      core::Odometry increment = increment_between(*motion.last_reading, reading, options_);
      increment.t_ns = t_ns.value_or(0);
      to_.inputs.emplace_back(increment);
    }
    motion.last_reading = reading;
    if (t_ns) motion.last_reading_ns = t_ns;
  }

  void take(NamedScan&& scan) {
    to_.warnings.insert(to_.warnings.end(), scan.dropped.begin(), scan.dropped.end());
    to_.inputs.emplace_back(std::move(scan));
  }

  void take(const mrpt::obs::CObservationGPS& observation) {
    const std::optional<GpsReference> position = position_of(observation);
    if (!position) return;
    if (!to_.motion.reference) to_.motion.reference = position;
    to_.inputs.emplace_back(fix_of(observation, *position, *to_.motion.reference, options_));
  }

  FrameInput& to_;
  bool has_action_;
  const MapBuilderOptions& options_;
};

}  // namespace

FrameInput convert_frame(const mrpt::obs::CSensoryFrame& frame, bool has_action, const MotionState& before,
                         const MapBuilderOptions& options) {
  FrameInput result;
  result.motion = before;
  Converter converter(result, has_action, options);
  for (const Timed& timed : in_order_of_time(frame)) converter.convert(*timed.observation);
  return result;
}

}  // namespace helixnav::mrpt_adapter
