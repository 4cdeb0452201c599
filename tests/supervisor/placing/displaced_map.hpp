// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "circuits.hpp"
#include "helixnav/supervisor/joint_map.hpp"

namespace helixnav::supervisor {

/// A day's drive, and the map of the day before with what is about its beginning 700 m from where it stands: the session is placed there, and
/// later comes to the rest of the map.
struct DisplacedMap {
  core::Recording today;
  core::JointMap earlier;
};

inline DisplacedMap displaced_map(std::uint64_t seed) {
  const sim::Scenario scenario = sim::named_scenario("large-loop");
  const sim::World world = sim::build_world(scenario.world, seed);
  const core::Recording yesterday = sim::simulate_in(world, scenario, 71);
  Navigator navigator(yesterday.start);
  drive(yesterday, navigator, [&](const core::Scan& scan, std::size_t) { navigator.observe(scan); });
  DisplacedMap made{sim::simulate_in(world, scenario, 72), joint_map(navigator.filter(), navigator.map())};
  const Eigen::Vector2d about_m =
      yesterday.true_poses[3 * yesterday.true_poses.size() / 100].T_world_robot.position_m();
  for (Eigen::Vector2d& point_m : made.earlier.joint.points_m) {
    if ((point_m - about_m).norm() < 60.0) point_m.x() += 700.0;
  }
  return made;
}

}  // namespace helixnav::supervisor
