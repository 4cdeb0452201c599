// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/localization/lost_monitor.hpp"

#include <algorithm>
#include <cmath>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/in_view.hpp"

namespace helixnav::localization {
namespace {

const double missed_nats =
    std::log(0.9 / 0.3);  ///< one that is there is missed in three of ten looks, clutter hits one
constexpr double lost_nats = 20.0;
constexpr double surely_seen = 0.8;  ///< of the reach
constexpr int few = 3;
constexpr int enough_unknown = 5;

/// Well inside what the sensor sees.
bool is_in_view(const Eigen::Vector2d& point_sensor_m, const core::FieldOfView& view, double reach_m) {
  const double range_m = point_sensor_m.norm();
  if (range_m < view.min_range_m || range_m > surely_seen * reach_m) return false;
  const double margin_rad = 0.05 * (view.max_bearing_rad - view.min_bearing_rad);
  const double bearing_rad = std::atan2(point_sensor_m.y(), point_sensor_m.x());
  return core::is_between_bearings(view, bearing_rad, margin_rad);
}

}  // namespace

LostMonitor::LostMonitor(const std::vector<core::MapLandmark>& map, double reach_m)
    : reach_m_(reach_m), since_look_m_(reach_m) {
  if (!(reach_m > 0.0 && std::isfinite(reach_m))) throw core::PreconditionError("lost monitor: reach_m > 0 expected");
  for (const core::MapLandmark& landmark : map) points_m_.push_back(landmark.point.mean_m);
}

void LostMonitor::observe(const core::Scan& scan, const core::StepReport& report, double driven_m) {
  since_look_m_ += driven_m;
  since_confirmed_m_ += driven_m;
  if (since_look_m_ < reach_m_ / 30.0) return;
  since_look_m_ = 0.0;
  const auto seen = static_cast<int>(
      std::count_if(report.associations.begin(), report.associations.end(),
                    [](const core::AssociationReport& a) { return a.outcome == core::Outcome::matched; }));
  const int expected = std::max(seen, count_expected(scan, report.pose.mean));
  if (seen >= 2 && 2 * seen >= expected) {
    reset();
    is_confirmed_ = true;
    return;
  }
  if (expected >= few && 5 * seen <= expected) missing_nats_ += missed_nats * (expected - seen);
  if (static_cast<int>(report.associations.size()) - seen >= few) ++looks_at_unknown_;
}

bool LostMonitor::is_lost() const {
  const bool all_missing = missing_nats_ >= lost_nats && since_confirmed_m_ >= reach_m_ / 3.0;
  const bool elsewhere = since_confirmed_m_ >= 2.0 * reach_m_ && looks_at_unknown_ >= enough_unknown;
  return all_missing || elsewhere;
}

void LostMonitor::reset() {
  since_look_m_ = since_confirmed_m_ = missing_nats_ = 0.0;
  looks_at_unknown_ = 0;
  is_confirmed_ = false;
}

int LostMonitor::count_expected(const core::Scan& scan, const core::Pose2& T_world_robot) const {
  const core::Pose2 T_sensor_world = core::inverse(core::compose(T_world_robot, scan.T_robot_sensor));
  return static_cast<int>(std::count_if(points_m_.begin(), points_m_.end(), [&](const Eigen::Vector2d& point_m) {
    return is_in_view(core::transform(T_sensor_world, point_m), scan.field_of_view, reach_m_);
  }));
}

}  // namespace helixnav::localization
