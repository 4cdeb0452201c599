// SPDX-License-Identifier: BSD-3-Clause
#include "slip/should_be_seen.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "association/association_report.hpp"
#include "association/view_area.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/core/in_view.hpp"
#include "slip/relative_geometry.hpp"

namespace helixnav::supervisor {
namespace {

using core::LandmarkId;
using core::Outcome;

bool may_have_been_seen_unused(LandmarkId id, const std::vector<core::AssociationReport>& fate) {
  return std::any_of(fate.begin(), fate.end(), [id](const core::AssociationReport& one) {
    return one.landmark == id && (one.outcome == Outcome::ambiguous || one.outcome == Outcome::rejected);
  });
}

core::FieldOfView as_far_as_it_reaches(core::FieldOfView view) {
  view.max_range_m = view.reach().value_or(view.max_range_m);
  return view;
}

bool is_well_inside(const Eigen::Vector2d& point_m, const core::FieldOfView& view, double margin_m) {
  const double range_m = point_m.norm();
  const double margin_rad = margin_m / std::max(range_m, margin_m);
  return range_m > view.min_range_m + margin_m && range_m <= view.max_range_m - margin_m &&
         core::is_between_bearings(view, std::atan2(point_m.y(), point_m.x()), margin_rad);
}

/// Sum over the observations of the area of the gate that each has for a landmark known to this covariance.
double gates_m2(const Eigen::Matrix2d& relative_m2, const std::vector<SeenPoint>& seen, double nis) {
  double sum_m2 = 0.0;
  for (const SeenPoint& one : seen)
    sum_m2 += core::pi * nis * std::sqrt(std::max(0.0, (relative_m2 + one.covariance_m2).determinant()));
  return sum_m2;
}

}  // namespace

InView should_be_seen(const cekf::CompressedEkf& filter, const core::Scan& scan, double margin_m,
                      const std::vector<LandmarkId>& ids, const std::vector<core::AssociationReport>& fate) {
  InView in_view;
  const core::FieldOfView& reliable = scan.field_of_view;
  if (!std::isfinite(reliable.max_range_m)) return in_view;
  const core::FieldOfView widest = as_far_as_it_reaches(reliable);
  const core::Pose2 T_sensor_world = core::inverse(core::compose(filter.pose().mean, scan.T_robot_sensor));
  for (const LandmarkId id : ids) {
    if (!filter.contains(id) || may_have_been_seen_unused(id, fate)) continue;
    const Eigen::Vector2d point_m = core::transform(T_sensor_world, filter.landmark_mean(id));
    if (is_well_inside(point_m, reliable, margin_m)) {
      in_view.surely.push_back(id);
    } else if (is_well_inside(point_m, widest, margin_m)) {
      in_view.perhaps.push_back(id);
    }
  }
  return in_view;
}

double chance_of_match(const cekf::CompressedEkf& filter, const core::Scan& scan, const std::vector<LandmarkId>& ids,
                       double gate_probability) {
  const double view_m2 = view_area_m2(as_far_as_it_reaches(scan.field_of_view));
  if (ids.empty() || !std::isfinite(view_m2) || !(view_m2 > 0.0)) return 0.0;
  constexpr int rows = 2;
  const double nis = core::chi2_quantile(gate_probability, rows);
  const std::vector<SeenPoint> seen = seen_points(scan, scan.observations.size());
  const RelativeGeometry relative(filter.joint(ids));
  double sum = 0.0;
  for (std::size_t k = 0; k < relative.ids.size(); ++k)
    sum += 1.0 - std::exp(-gates_m2(relative.covariance_of(k, k), seen, nis) / view_m2);
  return sum / static_cast<double>(relative.ids.size());
}

}  // namespace helixnav::supervisor
