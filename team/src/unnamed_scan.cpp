// SPDX-License-Identifier: BSD-3-Clause
#include "unnamed_scan.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "associate_scan.hpp"
#include "helixnav/core/odometry.hpp"
#include "helixnav/supervisor/lengths.hpp"
#include "looked_from.hpp"

namespace helixnav::team {
namespace {

using core::AssociationReport;
using core::LandmarkId;

std::vector<AssociationReport> fate_of(const association::Assignment& assignment) {
  std::vector<AssociationReport> fate;
  for (const association::ObservationOutcome& one : assignment.observations) {
    AssociationReport& report = fate.emplace_back();
    report.observation = static_cast<int>(fate.size()) - 1;
    report.margin_nats = one.margin_nats;
    if (one.outcome == association::Outcome::ambiguous) continue;
    const bool is_new = one.outcome == association::Outcome::new_landmark;
    report.outcome = is_new ? core::Outcome::augmented : core::Outcome::matched;
    if (!is_new) report.landmark = one.landmark;
  }
  return fate;
}

std::vector<supervisor::SlipLandmark> landmarks_near(const Eigen::Vector2d& sensor_m, double range_m,
                                                     const JointFilter& filter, const State& state) {
  std::vector<supervisor::SlipLandmark> near;
  for (std::size_t i = 0; i < filter.ids().size(); ++i) {
    const Eigen::Vector2d& at_m = filter.points_m()[i];
    const LandmarkId id = filter.ids()[i];
    if ((at_m - sensor_m).norm() > range_m) continue;
    near.push_back({id, at_m, state.observations[static_cast<std::size_t>(id)]});
  }
  return near;
}

std::optional<supervisor::Slip> slip_before(std::size_t robot, const core::Scan& given,
                                            const std::vector<AssociationReport>& fate, const State& state) {
  const core::Scan scan = with_view(given, state);
  const std::optional<double> reach_m = scan.field_of_view.reach();
  if (!reach_m) return std::nullopt;
  const supervisor::NavigatorOptions as_navigator = supervisor::fit_lengths({}, scan.field_of_view);
  const JointFilter& filter = state.components[state.robots[robot].component].filter;
  const std::size_t slot = state.robots[robot].slot;
  const core::Pose2 at = filter.pose(slot).mean;
  const Eigen::Vector2d sensor_m = core::transform(at, scan.T_robot_sensor.position_m());
  const supervisor::SlipContext context{
      scan,
      at,
      fate,
      [&] { return landmarks_near(sensor_m, *reach_m + as_navigator.view_margin_m, filter, state); },
      [&](const std::vector<LandmarkId>& ids) { return filter.joint_of(slot, ids); },
      [&] { return looked_from(state.robots[robot].component, as_navigator.search.coverage_spacing_m, state); },
      as_navigator.extraneous_per_scan,
      as_navigator.association.detection_probability};
  return supervisor::find_slip(context, as_navigator.slip);
}

/// Observations of the slip's pairs, the farthest first, then the others.
std::vector<int> pairs_first(const core::Scan& scan, const std::vector<supervisor::SlipPair>& pairs) {
  std::vector<double> key(scan.observations.size(), 0.0);  // [observation]
  for (const supervisor::SlipPair& pair : pairs) {
    const auto i = static_cast<std::size_t>(pair.observation);
    key[i] = -core::locate_landmark(scan.observations[i], {}, scan.T_robot_sensor).point_world_m.norm();
  }
  std::vector<int> order(scan.observations.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return key[static_cast<std::size_t>(a)] < key[static_cast<std::size_t>(b)]; });
  return order;
}

/// The filter as the pairs leave it.
JointFilter moved_by(const UnnamedScan& read, std::size_t slot, const core::Scan& scan, JointFilter filter) {
  core::Odometry unmeasured = core::no_motion(scan.t_ns);
  unmeasured.covariance = read.slip->covariance;
  filter.predict(slot, unmeasured);
  for (const int i : read.order) {
    const auto pair = std::find_if(read.slip->pairs.begin(), read.slip->pairs.end(),
                                   [i](const supervisor::SlipPair& one) { return one.observation == i; });
    if (pair == read.slip->pairs.end()) break;
    filter.observe(slot, pair->landmark, scan.T_robot_sensor, scan.observations[static_cast<std::size_t>(i)],
                   std::numeric_limits<double>::infinity());
  }
  return filter;
}

}  // namespace

UnnamedScan read_unnamed(std::size_t robot, const core::Scan& scan, const TeamOptions& options, const State& state) {
  const JointFilter& filter = state.components[state.robots[robot].component].filter;
  const std::size_t slot = state.robots[robot].slot;
  UnnamedScan read;
  read.fate = fate_of(associate_scan(slot, scan, options, filter, state));
  read.order = pairs_first(scan, {});
  if (options.slips) read.slip = slip_before(robot, scan, read.fate, state);
  if (!read.slip) return read;
  read.order = pairs_first(scan, read.slip->pairs);
  read.fate = fate_of(associate_scan(slot, scan, options, moved_by(read, slot, scan, filter), state));
  supervisor::match_pairs(read.slip->pairs, read.fate);
  return read;
}

}  // namespace helixnav::team
