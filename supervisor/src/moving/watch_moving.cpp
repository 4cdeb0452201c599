// SPDX-License-Identifier: BSD-3-Clause
// Things that move in a scan: they are not landmarks.
#include <algorithm>
#include <cmath>
#include <vector>

#include "association/view_area.hpp"
#include "loop/navigation_loop.hpp"

namespace helixnav::supervisor {

/// Before the scan is used. Landmarks found to move are dropped at the end of the scan.
std::vector<Mover> NavigationLoop::watch_moving(const core::Scan& scan, const std::vector<SeenPoint>& seen,
                                                core::StepReport& report) {
  if (seen.empty()) return {};
  const double per_scan = std::max(options_.extraneous_per_scan, belief_.existence.born_per_scan());
  SightingRates rates{options_.association.detection_probability, per_scan / view_area_m2(scan.field_of_view),
                      scan.field_of_view, scan.T_robot_sensor};
  rates.sure_view.max_range_m -= options_.view_margin_m;
  return belief_.moving.watch(scan.t_ns, seen, rates, options_.moving, report.associations);
}

/// The observations as points, if moving things are watched for and the view is bounded, so that clutter has a density.
std::vector<SeenPoint> NavigationLoop::points_to_watch(const core::Scan& scan) const {
  const double view_m2 = view_area_m2(scan.field_of_view);
  if (!options_.moving.enabled || !std::isfinite(view_m2) || !(view_m2 > 0.0)) return {};
  return seen_points(scan, scan.observations.size());
}

}  // namespace helixnav::supervisor
