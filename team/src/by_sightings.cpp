// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdlib>

#include "candidates.hpp"
#include "helixnav/core/angle.hpp"
#include "solve.hpp"

namespace helixnav::team {
namespace {

const Clone& sees(const SightingRow& row, const State& state) { return state.robots[row.robot].clones[row.clone]; }
const Clone& is_seen(const SightingRow& row, const State& state) {
  return state.robots[row.seen].clones[row.seen_clone];
}

/// The later robot pose in the frame of the earlier component, from a sighting each way. With o the one robot's sighting of
/// the other, and p the other's of the one, both as positions: the line between the robots has a direction in each frame.
core::Pose2 pose_from(const SightingRow& there, const SightingRow& back, const State& state) {
  const Eigen::Vector2d seen_a_m = core::transform(sees(there, state).T_component_robot,
                                                   seen_position(there.T_robot_sensor, there.observation).position_m);
  const Eigen::Vector2d seen_b_m = core::transform(sees(back, state).T_component_robot,
                                                   seen_position(back.T_robot_sensor, back.observation).position_m);
  // Two points known in both frames: the robot of `into` and the robot of `from`.
  const Eigen::Vector2d a_in_into_m = is_seen(back, state).T_component_robot.position_m();
  const Eigen::Vector2d b_in_from_m = is_seen(there, state).T_component_robot.position_m();
  const Eigen::Vector2d line_into_m = seen_a_m - a_in_into_m;
  const Eigen::Vector2d line_from_m = b_in_from_m - seen_b_m;
  const double heading_rad =
      core::wrap_to_pi(std::atan2(line_into_m.y(), line_into_m.x()) - std::atan2(line_from_m.y(), line_from_m.x()));
  const Eigen::Vector2d at_m =
      0.5 * (a_in_into_m + seen_a_m) - core::rotation(heading_rad) * (0.5 * (seen_b_m + b_in_from_m));
  return {at_m.x(), at_m.y(), heading_rad};
}

}  // namespace

std::vector<Candidate> by_sightings(std::size_t into, std::size_t from, core::Nanoseconds t_ns,
                                    const JoinOptions& options, const std::set<SightingKey>& refused,
                                    const State& state) {
  constexpr std::size_t most = 3;
  const core::Nanoseconds since_ns = t_ns - core::nanoseconds_from_seconds(options.window_s);
  const core::Nanoseconds pair_ns = core::nanoseconds_from_seconds(options.pair_s);
  const std::vector<SightingRow>& rows = state.sighting_rows;
  std::set<std::size_t> taken;
  const auto leads = [&](std::size_t i, std::size_t a, std::size_t b) {
    const SightingRow& row = rows[i];
    return row.use == SightingRow::Use::apart && state.robots[row.robot].component == a &&
           state.robots[row.seen].component == b && taken.count(i) == 0 && refused.count(key_of(row)) == 0;
  };
  std::vector<Candidate> candidates;
  for (std::size_t i = rows.size(); i-- > 0 && sees(rows[i], state).t_ns >= since_ns;) {
    if (!leads(i, into, from)) continue;
    for (std::size_t k = rows.size(); k-- > 0 && sees(rows[k], state).t_ns >= since_ns - pair_ns;) {
      const bool back = rows[k].robot == rows[i].seen && rows[k].seen == rows[i].robot && leads(k, from, into);
      if (!back || std::abs(sees(rows[k], state).t_ns - sees(rows[i], state).t_ns) > pair_ns) continue;
      candidates.push_back({into, from, TeamJoin::By::sightings, {}, {}, {i, k}, {}});
      candidates.back().T_into_from.mean = pose_from(rows[i], rows[k], state);
      taken.insert({i, k});
      break;
    }
    if (candidates.size() == most) break;
  }
  return candidates;
}

}  // namespace helixnav::team
