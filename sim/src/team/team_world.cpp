// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/sim/team_world.hpp"

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "team_driver.hpp"

namespace helixnav::sim {
namespace {

void check(const TeamWorldOptions& options) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw core::PreconditionError(std::string("sim: of a team's world, ") + what);
  };
  require(options.robots >= 2 && options.robots <= 100, "robots must be 2 to 100");
  require(options.landmarks_each >= 1 && options.landmarks_each <= 100, "landmarks_each must be 1 to 100");
  require(options.common >= 1, "common must be 1 or more");
  const int neighbours = options.robots > 2 ? 2 : 1;
  require(options.kind != TeamWorldKind::shared || neighbours * options.common <= options.landmarks_each,
          "common must leave a robot its landmarks_each with all neighbours");
  require(options.pitch_m >= nearest_trees_m, "pitch_m must be 2 m or more");
  require(options.jitter_m >= 0.0, "jitter_m must not be negative");
}

World world_of(const TeamScene& scene) {
  const Route nowhere({Eigen::Vector2d::Zero(), Eigen::Vector2d::UnitX()});  // robots drive circles of their own
  World world{nowhere, 0.0, {}, {}, std::nullopt};
  for (const Eigen::Vector2d& point_m : scene.landmarks_m) {
    world.trees.push_back({point_m, {0.0, std::numeric_limits<double>::infinity()}});
  }
  return world;
}

core::TeamRecording begin(const TeamWorldOptions& options, const TeamScene& scene,
                          const std::vector<TeamDriver>& drivers) {
  core::TeamRecording team;
  team.name = std::string("team ") + name_of(options.kind);
  team.starts_known = true;
  for (const Eigen::Vector2d& point_m : scene.landmarks_m) {
    team.true_landmarks.push_back({static_cast<core::Label>(team.true_landmarks.size()), point_m});
  }
  for (const TeamDriver& driver : drivers) {
    core::TeamMember& member = team.robots.emplace_back();
    member.number = static_cast<int>(team.robots.size());
    member.recording.name = team.name + ", robot " + std::to_string(member.number);
    member.recording.start.mean = driver.pose();
    member.recording.true_landmarks = team.true_landmarks;
  }
  return team;
}

void drive_on(core::Nanoseconds t_ns, bool see_each_other, std::vector<TeamDriver>& drivers,
              core::TeamRecording& team) {
  for (std::size_t r = 0; r < drivers.size(); ++r) {
    team.robots[r].recording.events.emplace_back(drivers[r].move(t_ns));
    team.robots[r].recording.true_poses.push_back({t_ns, drivers[r].pose()});
  }
  for (std::size_t r = 0; r < drivers.size(); ++r) {
    LabelledScan seen = drivers[r].scan(t_ns);
    team.robots[r].recording.events.emplace_back(std::move(seen.scan));
    team.robots[r].recording.labels.push_back(std::move(seen.labels));
    for (std::size_t other = 0; see_each_other && other < drivers.size(); ++other) {
      if (other == r) continue;
      const std::optional<core::Observation> robot = drivers[r].look_at(drivers[other].pose().position_m());
      if (robot) team.robots[r].sightings.push_back({t_ns, static_cast<int>(other), core::Pose2(), *robot});
    }
  }
}

}  // namespace

const char* name_of(TeamWorldKind kind) {
  switch (kind) {
    case TeamWorldKind::shared:
      return "shared";
    case TeamWorldKind::apart:
      return "apart";
    default:
      return "orchard";
  }
}

core::TeamRecording simulate_team(const TeamWorldOptions& options, std::uint64_t seed) {
  check(options);
  core::RandomStream random(seed, "sim.team.world");
  const TeamScene scene = scene_of(options, random);
  const World world = world_of(scene);
  const Scenario scanner = team_scanner(scene, options.clutter_per_scan);
  std::vector<TeamDriver> drivers;
  for (std::size_t r = 0; r < scene.circles.size(); ++r) drivers.emplace_back(scene, r, scanner, world, seed);
  core::TeamRecording team = begin(options, scene, drivers);
  constexpr double seconds = 190.0;
  for (int k = 1; k * team_period_s <= seconds; ++k) {
    drive_on(core::nanoseconds_from_seconds(k * team_period_s), options.see_each_other, drivers, team);
  }
  return team;
}

}  // namespace helixnav::sim
