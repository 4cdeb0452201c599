// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/field_of_view.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>
#include <vector>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/observation.hpp"

namespace helixnav::logs {
namespace {

template <class Action>
void for_each_scan(core::Recording& recording, Action&& action) {
  for (core::Event& event : recording.events) {
    if (auto* scan = std::get_if<core::Scan>(&event)) action(*scan);
  }
}

double quantile(const std::vector<double>& sorted, double share) {
  const auto at = static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1) + 0.5);
  return sorted[at];
}

struct Polar {
  std::vector<double> ranges_m, bearings_rad;  ///< ascending
};

Polar polar_observations(const core::Recording& recording) {
  Polar polar;
  for (const core::Event& event : recording.events) {
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    for (const core::Observation& observation : scan->observations) {
      if (core::dimension(observation.kind) != 2) continue;
      const bool is_polar = observation.kind == core::ObservationKind::range_bearing;
      const core::ObsVector& z = observation.z;
      polar.ranges_m.push_back(is_polar ? z[0] : z.norm());
      polar.bearings_rad.push_back(is_polar ? core::wrap_to_pi(z[1]) : std::atan2(z[1], z[0]));
    }
  }
  std::sort(polar.ranges_m.begin(), polar.ranges_m.end());
  std::sort(polar.bearings_rad.begin(), polar.bearings_rad.end());
  return polar;
}

}  // namespace

core::FieldOfView estimate_field_of_view(const core::Recording& recording) {
  const Polar polar = polar_observations(recording);
  core::FieldOfView view;
  if (polar.ranges_m.empty()) return view;
  view.min_range_m = quantile(polar.ranges_m, 0.01);
  view.max_range_m = quantile(polar.ranges_m, 0.75);
  view.reach_m = quantile(polar.ranges_m, 0.95);
  if (!(view.max_range_m > view.min_range_m)) view.min_range_m = 0.0;  // all at one distance
  constexpr double nearly_behind_rad = 0.97 * core::pi;                // 1 % of bearings all around exceed 0.98 π
  const bool all_around =
      quantile(polar.bearings_rad, 0.01) < -nearly_behind_rad && quantile(polar.bearings_rad, 0.99) > nearly_behind_rad;
  if (all_around) return view;
  const double rightmost_rad = quantile(polar.bearings_rad, 0.05);
  const double leftmost_rad = quantile(polar.bearings_rad, 0.95);
  if (!(leftmost_rad > rightmost_rad)) return view;  // all in one direction
  view.min_bearing_rad = rightmost_rad;
  view.max_bearing_rad = leftmost_rad;
  return view;
}

void estimate_missing_field_of_view(core::Recording& recording) {
  const core::FieldOfView estimate = estimate_field_of_view(recording);
  if (!estimate.reach()) return;  // no observation fixes a point
  for_each_scan(recording, [&](core::Scan& scan) {
    if (!std::isfinite(scan.field_of_view.max_range_m)) scan.field_of_view = estimate;
  });
}

void set_field_of_view(core::Recording& recording, const GivenFieldOfView& given) {
  for_each_scan(recording, [&](core::Scan& scan) {
    core::FieldOfView& view = scan.field_of_view;
    if (given.max_range_m > 0.0) {
      view.min_range_m = std::min(view.min_range_m, 0.5 * given.max_range_m);
      view.max_range_m = given.max_range_m;
      view.reach_m = 0.0;
    }
    if (given.width_rad > 0.0) {
      view.min_bearing_rad = -0.5 * given.width_rad;
      view.max_bearing_rad = 0.5 * given.width_rad;
    }
  });
}

void tell_view(const SensorModel& sensor, core::FieldOfView& view) {
  if (sensor.reach_m || sensor.reliable_range_m) {
    const double least_m = sensor.reliable_range_m.value_or(0.0);
    view.reach_m = sensor.reach_m.value_or(std::max(view.reach().value_or(0.0), least_m));
    view.max_range_m = sensor.reliable_range_m.value_or(view.reach_m);
    view.min_range_m = sensor.min_range_m;
  }
  if (sensor.min_range_m > 0.0) view.min_range_m = sensor.min_range_m;
  if (sensor.min_bearing_rad) view.min_bearing_rad = *sensor.min_bearing_rad;
  if (sensor.max_bearing_rad) view.max_bearing_rad = *sensor.max_bearing_rad;
}

core::FieldOfView field_of_view_of(const core::Recording& recording) {
  const core::FieldOfView* first = nullptr;
  for (const core::Event& event : recording.events) {
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    if (scan->field_of_view.reach()) return scan->field_of_view;
    if (first == nullptr) first = &scan->field_of_view;
  }
  return first == nullptr ? core::FieldOfView() : *first;
}

}  // namespace helixnav::logs
