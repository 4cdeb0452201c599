// SPDX-License-Identifier: BSD-3-Clause
#include "associate_scan.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "doubtful_matches.hpp"
#include "helixnav/association/innovation_problem.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/supervisor/navigator_options.hpp"

namespace helixnav::team {
namespace {

/// The scan with the noise of one look, by which things are told apart.
core::Scan as_one_look(core::Scan look, double looks_as_one) {
  for (core::Observation& observation : look.observations) observation.R /= looks_as_one;
  return look;
}

/// Places in the filter of landmarks that the robot may see or that may be rivals of those, by a bound on the distance.
std::vector<std::size_t> within_reach(std::size_t slot, const core::Scan& look, double gate,
                                      const JointFilter& filter) {
  const core::PoseGaussian pose = filter.pose(slot);
  double range_m = 0.0;
  double turn_m2 = 0.0;
  double noise_m2 = 0.0;
  for (const core::Observation& observation : look.observations) {
    const core::LocatedLandmark located = core::locate_landmark(observation, core::Pose2(), look.T_robot_sensor);
    range_m = std::max(range_m, located.point_world_m.norm());
    turn_m2 = std::max(turn_m2, located.point_world_m.squaredNorm() * pose.covariance(2, 2));
    noise_m2 = std::max(noise_m2, (located.G_z * observation.R * located.G_z.transpose()).trace());
  }
  const double own_m2 = pose.covariance.topLeftCorner<2, 2>().trace() + turn_m2;
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < filter.ids().size(); ++i) {
    const double distance_m = (filter.points_m()[i] - pose.mean.position_m()).norm();
    const double state_m2 = 2.0 * (own_m2 + filter.variance_m2(i));  // correlations at their worst
    const double spread_m2 = rival_variance_factor * state_m2 + noise_m2;
    if (distance_m <= range_m + std::sqrt(gate * spread_m2)) near.push_back(i);
  }
  return near;
}

}  // namespace

core::Scan with_view(const core::Scan& scan, const State& state) {
  core::Scan seen = scan;
  const bool is_known = std::isfinite(seen.field_of_view.max_range_m);
  if (!is_known && state.reach_m > 0.0 && state.widest_rad > 0.0) {
    seen.field_of_view = {0.0, state.reach_m, -state.widest_rad, state.widest_rad};
  }
  return seen;
}

association::Assignment associate_scan(std::size_t slot, const core::Scan& scan, const TeamOptions& options,
                                       const JointFilter& filter, const State& state) {
  const supervisor::NavigatorOptions as_navigator;
  const core::Scan look = as_one_look(with_view(scan, state), options.looks_as_one);
  const double gate = core::chi2_quantile(as_navigator.gates.new_probability, 2);
  const core::JointGaussian joint = filter.joint(slot, within_reach(slot, look, gate, filter));
  const association::InnovationProblem problem = association::make_innovation_problem(joint, look, as_navigator.gates);
  association::Options how = as_navigator.association;
  how.extraneous = association::density_in_view(look, as_navigator.extraneous_per_scan, how.extraneous);
  association::Assignment assignment = association::associate(as_navigator.method, problem, how);
  leave_doubtful(scan, look, joint, as_navigator.gates, how, assignment);
  return assignment;
}

}  // namespace helixnav::team
