// SPDX-License-Identifier: BSD-3-Clause
#include "loop/coverage_trace.hpp"

namespace helixnav::supervisor {

void CoverageTrace::pass(double path_m, const core::Pose2& T_world_sensor) {
  if (!points_.empty() && path_m - points_.back().path_m < spacing_m_) return;
  points_.push_back({path_m, T_world_sensor});
}

void CoverageTrace::back_to(double path_m) {
  while (!points_.empty() && points_.back().path_m > path_m) points_.pop_back();
}

void CoverageTrace::change_frame(const core::Pose2& T_new_old) {
  for (Point& point : points_) point.T_world_sensor = core::compose(T_new_old, point.T_world_sensor);
}

std::vector<core::Pose2> CoverageTrace::between(double from_m, double to_m) const {
  std::vector<core::Pose2> poses;
  for (const Point& point : points_) {
    if (point.path_m >= from_m && point.path_m < to_m) poses.push_back(point.T_world_sensor);
  }
  return poses;
}

}  // namespace helixnav::supervisor
