// SPDX-License-Identifier: BSD-3-Clause
#include "systematic_motion.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include "has_match.hpp"
#include "helixnav/core/odometry.hpp"
#include "range_offset.hpp"
#include "sensors_apart.hpp"
#include "taken_out.hpp"

namespace helixnav::apps {
namespace {

/// From a scan to the next one, in the frame of the vehicle before.
struct StepMotion {
  double way_m = 0.0;                      ///< forwards, by odometry
  Eigen::Vector2d correction_m{0.0, 0.0};  ///< added by the scan
};

std::vector<StepMotion> motions_of(const core::Recording& recording, const runs::Run& run) {
  std::vector<StepMotion> motions;
  core::Odometry since = core::no_motion(0);
  std::size_t k = 0;
  for (const core::Event& event : recording.events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) since = core::chain(since, *odometry);
    if (!std::holds_alternative<core::Scan>(event)) continue;
    if (k >= run.steps.size()) break;
    if (k > 0 && has_match(run.steps[k])) {
      const core::Pose2 moved = core::between(run.steps[k - 1].pose.mean, run.steps[k].pose.mean);
      motions.push_back({since.T_before_after.x_m, moved.position_m() - since.T_before_after.position_m()});
    }
    since = core::no_motion(0);
    ++k;
  }
  return motions;
}

/// Without those that hardly move: per metre their jitter outweighs their information.
std::vector<StepMotion> moving(std::vector<StepMotion> motions) {
  double sum_m = 0.0;
  for (const StepMotion& m : motions) sum_m += std::abs(m.way_m);
  const double least_m = 0.1 * sum_m / static_cast<double>(std::max<std::size_t>(1, motions.size()));
  motions.erase(std::remove_if(motions.begin(), motions.end(),
                               [&](const StepMotion& m) { return !(std::abs(m.way_m) > least_m); }),
                motions.end());
  return motions;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Share {
  double mean = 0.0, sigma = 0.0;
};

/// Corrections along an axis as a share of the distance. Their variance grows with distance, hence the weights.
Share share_of_way(const std::vector<StepMotion>& motions, int axis) {
  std::vector<double> scaled, deviations;
  for (const StepMotion& m : motions) {
    scaled.push_back(std::copysign(1.0, m.way_m) * m.correction_m[axis] / std::sqrt(std::abs(m.way_m)));
  }
  const double middle = median(scaled);
  for (const double value : scaled) deviations.push_back(std::abs(value - middle));
  constexpr double outlier_sigmas = 6.0, sigma_of_median = 1.4826;
  const double most = outlier_sigmas * sigma_of_median * median(deviations);
  double way_m = 0.0, corrected_m = 0.0, variance_m2 = 0.0;
  const auto sum = [&](const auto& add) {
    for (std::size_t i = 0; i < motions.size(); ++i) {
      if (std::abs(scaled[i] - middle) <= most) add(std::abs(motions[i].way_m), scaled[i]);
    }
  };
  sum([&](double way, double value) { way_m += way, corrected_m += value * std::sqrt(way); });
  if (!(way_m > 0.0)) return {};
  const double mean = corrected_m / way_m;
  sum([&](double way, double value) { variance_m2 += way * std::pow(value - mean * std::sqrt(way), 2); });
  return {mean, std::sqrt(variance_m2) / way_m};
}

/// What the log says of a sensor whose heading may have been corrected while driving.
core::Pose2 mounting_as_stated(const core::Pose2& corrected, const core::Recording& recording,
                               const core::Recording& measured) {
  for (std::size_t i = 0; i < recording.events.size() && i < measured.events.size(); ++i) {
    const auto* scan = std::get_if<core::Scan>(&recording.events[i]);
    const auto* stated = std::get_if<core::Scan>(&measured.events[i]);
    if (scan == nullptr || stated == nullptr) continue;
    if (scan->T_robot_sensor.vector() == corrected.vector()) return stated->T_robot_sensor;
  }
  return corrected;
}

void note(const core::Pose2& mounting, const std::string& sensor, runs::Run& run) {
  run.numbers.emplace_back("sensors_apart." + sensor + ".x_m", mounting.x_m);
  run.numbers.emplace_back("sensors_apart." + sensor + ".y_m", mounting.y_m);
  run.numbers.emplace_back("sensors_apart." + sensor + ".heading_rad", mounting.heading_rad);
}

void note(const SensorsApart& apart, runs::Run& run) {
  note(apart.T_robot_one, "one", run);
  note(apart.T_robot_other, "other", run);
  run.numbers.emplace_back("sensors_apart.farther_m", apart.farther_m);
  run.numbers.emplace_back("sensors_apart.farther_sigma_m", apart.farther_sigma_m);
  run.numbers.emplace_back("sensors_apart.left_rad", apart.left_rad);
  run.numbers.emplace_back("sensors_apart.left_sigma_rad", apart.left_sigma_rad);
}

/// Bearings do not change if the world and the drive grow by the same factor.
bool has_bearings_only(const core::Recording& recording) {
  bool any = false, only = true;
  for (const core::Event& event : recording.events) {
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    for (const core::Observation& observation : scan->observations) {
      any = true;
      only = only && observation.kind == core::ObservationKind::bearing;
    }
  }
  return any && only;
}

/// In standard deviations; 0 if there is none.
double sigmas(double value, double sigma) { return sigma > 0.0 ? std::abs(value) / sigma : 0.0; }

}  // namespace

std::optional<SystematicMotion> systematic_motion_of(const core::Recording& recording, const runs::Run& run) {
  const std::vector<StepMotion> motions = moving(motions_of(recording, run));
  constexpr std::size_t enough = 50;
  if (motions.size() < enough) return std::nullopt;
  const Share along = has_bearings_only(recording) ? Share() : share_of_way(motions, 0);
  const Share across = share_of_way(motions, 1);
  return SystematicMotion{-along.mean, along.sigma, across.mean, across.sigma};
}

void note_systematic_errors(const core::Recording& measured, runs::Run& run) {
  const core::Recording recording = without_taken_out(run, measured);
  const RangeOffset offset = range_offset_of(recording, run).value_or(RangeOffset());
  const SystematicMotion motion = systematic_motion_of(recording, run).value_or(SystematicMotion());
  const double offset_z = sigmas(offset.offset_m, offset.sigma_m);
  const double scale_z = sigmas(motion.too_long, motion.too_long_sigma);
  // Each leaves a trace in the other's number: a scale alone gives 0.1 of its sigmas in the offset's, an offset alone 0.7 in the
  // scale's (docs/your_own_log.md).
  constexpr double offset_sigmas = 5.0;  // 2.6 in forests without an offset, 6.2 and more where one spoils the path
  if (offset_z > offset_sigmas && offset_z > 0.3 * scale_z) {
    run.numbers.emplace_back("range_offset.missing_m", offset.offset_m);
    run.numbers.emplace_back("range_offset.sigma_m", offset.sigma_m);
  }
  constexpr double motion_sigmas = 8.0;
  constexpr double least_scale = 0.005, least_rad = 0.004;  // the filter's covariances cover smaller ones
  if (scale_z > std::max(motion_sigmas, offset_z) && std::abs(motion.too_long) > least_scale) {
    run.numbers.emplace_back("odometry.too_long", motion.too_long);
    run.numbers.emplace_back("odometry.too_long_sigma", motion.too_long_sigma);
  }
  if (sigmas(motion.sideways_rad, motion.sideways_sigma_rad) > motion_sigmas &&
      std::abs(motion.sideways_rad) > least_rad) {
    run.numbers.emplace_back("odometry.sideways_rad", motion.sideways_rad);
    run.numbers.emplace_back("odometry.sideways_sigma_rad", motion.sideways_sigma_rad);
  }
  if (auto apart = sensors_apart_of(recording, run); apart && surely_apart(*apart)) {
    apart->T_robot_one = mounting_as_stated(apart->T_robot_one, recording, measured);
    apart->T_robot_other = mounting_as_stated(apart->T_robot_other, recording, measured);
    note(*apart, run);
  }
}

}  // namespace helixnav::apps
