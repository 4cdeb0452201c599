// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/sim/simulate.hpp"

#include <utility>

#include "carried.hpp"
#include "movers.hpp"
#include "odometer.hpp"
#include "scanner.hpp"
#include "vehicle.hpp"

namespace helixnav::sim {
namespace {

std::vector<core::TrueLandmark> true_landmarks(const World& world) {
  std::vector<core::TrueLandmark> landmarks;
  landmarks.reserve(world.trees.size());
  for (const Tree& tree : world.trees) {
    landmarks.push_back({static_cast<core::Label>(landmarks.size()), tree.point_m});
  }
  return landmarks;
}

void record(LabelledScan seen, const core::Pose2& T_world_robot, core::Recording& recording) {
  recording.true_poses.push_back({seen.scan.t_ns, T_world_robot});
  recording.labels.push_back(std::move(seen.labels));
  seen.scan.observations.shrink_to_fit();
  recording.events.emplace_back(std::move(seen.scan));
}

}  // namespace

core::Recording simulate(const Scenario& scenario, std::uint64_t seed) {
  check_scenario(scenario);
  return simulate_in(build_world(scenario.world, seed), scenario, seed);
}

core::Recording simulate_in(const World& world, const Scenario& scenario, std::uint64_t seed) {
  check_scenario(scenario);
  core::Recording recording;
  recording.name = scenario.name;
  recording.true_landmarks = true_landmarks(world);
  recording.truth_frame.T_truth_map = core::Pose2();

  Odometer odometer(scenario, seed);
  Scanner scanner(scenario, world, seed);
  const std::vector<DriveStep> steps = drive(world.route, world.drive_m, scenario.vehicle);
  const Movers movers(scenario, world.route, steps, seed);
  record(scanner.look({}, 0.0, 0, movers.at(0.0)), {}, recording);
  const std::vector<Stretch> carried = draw_carried(scenario.carried, world.drive_m, seed);
  auto next = carried.begin();
  int sample = 0;
  bool is_carried = false;
  for (const DriveStep& step : steps) {
    ++sample;
    while (next != carried.end() && step.along_m > next->to_m) ++next;
    const core::Nanoseconds t_ns = core::nanoseconds_from_seconds(sample * scenario.vehicle.odometry_period_s);
    const bool was_carried = std::exchange(is_carried, next != carried.end() && step.along_m > next->from_m);
    if (is_carried) continue;
    if (was_carried) recording.true_carries_ns.push_back(t_ns);
    if (was_carried && scenario.carried.announced) recording.events.emplace_back(core::Lost{t_ns});
    recording.events.emplace_back(odometer.measure(step.sample, t_ns));
    if (sample % scenario.vehicle.samples_per_scan == 0) {
      const std::vector<Eigen::Vector2d> moving_m = movers.at(core::seconds(t_ns));
      record(scanner.look(step.T_world_robot, step.along_m, t_ns, moving_m), step.T_world_robot, recording);
    }
  }
  recording.true_slips_ns = odometer.slips();
  recording.events.shrink_to_fit();
  return recording;
}

}  // namespace helixnav::sim
