// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/association/likelihood_ratio.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "helixnav/core/errors.hpp"

namespace helixnav::association {
namespace {

/// Distance of the furthest observation that gives one; zero when none does.
double furthest_m(const core::Scan& scan) {
  double reach_m = 0.0;
  for (const core::Observation& observation : scan.observations) {
    const bool is_point = observation.kind == core::ObservationKind::cartesian;
    if (is_point) reach_m = std::max(reach_m, observation.z.norm());
    const bool is_ranged =
        observation.kind == core::ObservationKind::range_bearing || observation.kind == core::ObservationKind::range;
    if (is_ranged) reach_m = std::max(reach_m, observation.z[0]);
  }
  return reach_m;
}

double area_of_m2(const core::FieldOfView& view) {
  const double width_rad = view.max_bearing_rad - view.min_bearing_rad;
  return 0.5 * width_rad * (view.max_range_m - view.min_range_m) * (view.max_range_m + view.min_range_m);
}

/// A view that yields a density: neither a line nor a point, nor implausibly large.
bool has_area(const core::FieldOfView& view) {
  constexpr double least_m2 = 1e-12;
  constexpr double most_m2 = 1e18;
  return area_of_m2(view) >= least_m2 && area_of_m2(view) <= most_m2;
}

}  // namespace

double ExtraneousDensity::of(core::ObservationKind kind) const {
  switch (kind) {
    case core::ObservationKind::range_bearing:
      return range_bearing_per_m_rad;
    case core::ObservationKind::cartesian:
      return cartesian_per_m2;
    case core::ObservationKind::bearing:
      return bearing_per_rad;
    default:
      return range_per_m;
  }
}

ExtraneousDensity uniform_density(const core::FieldOfView& field_of_view, double expected_per_scan) {
  const double depth_m = field_of_view.max_range_m - field_of_view.min_range_m;
  const double width_rad = field_of_view.max_bearing_rad - field_of_view.min_bearing_rad;
  const double area_m2 = area_of_m2(field_of_view);
  if (!(area_m2 > 0.0) || !std::isfinite(area_m2) || !(expected_per_scan > 0.0)) {
    throw core::PreconditionError(
        "uniform_density: a bounded field of view with an area and a positive number per scan "
        "expected");
  }
  return {expected_per_scan / (depth_m * width_rad), expected_per_scan / area_m2, expected_per_scan / width_rad,
          expected_per_scan / depth_m};
}

ExtraneousDensity density_in_view(const core::Scan& scan, double expected_per_scan,
                                  const ExtraneousDensity& unbounded) {
  core::FieldOfView view = scan.field_of_view;
  if (!std::isfinite(view.max_range_m)) return unbounded;
  if (!(view.max_range_m > 0.0)) {
    view.min_range_m = 0.0;
    view.max_range_m = furthest_m(scan);
  }
  return has_area(view) ? uniform_density(view, expected_per_scan) : unbounded;
}

AssignmentProblem likelihood_ratio_costs(const InnovationProblem& problem, double detection_probability,
                                         const ExtraneousDensity& extraneous) {
  if (!(detection_probability > 0.0 && detection_probability < 1.0)) {
    throw core::PreconditionError("detection_probability must lie in (0, 1), got " +
                                  std::to_string(detection_probability));
  }
  const double detection_nats = std::log(detection_probability / (1.0 - detection_probability));
  AssignmentProblem assignment;
  assignment.columns = static_cast<int>(problem.ids.size());
  assignment.column.reserve(problem.pairs.size());
  assignment.cost.reserve(problem.pairs.size());
  for (const GatedPair& pair : problem.pairs) {
    assignment.column.push_back(pair.candidate);
    assignment.cost.push_back(-pair.log_likelihood - detection_nats - pair.appearance_nats);
  }
  assignment.row_begin.reserve(problem.observations.size() + 1);
  assignment.unassigned_cost.reserve(problem.observations.size());
  for (const GatedObservation& observation : problem.observations) {
    const double density = extraneous.of(observation.kind);
    if (!(density > 0.0) || !std::isfinite(density)) {
      throw core::PreconditionError("extraneous density must be positive and finite, got " + std::to_string(density));
    }
    assignment.row_begin.push_back(observation.end);
    assignment.unassigned_cost.push_back(-std::log(density));
  }
  return assignment;
}

}  // namespace helixnav::association
