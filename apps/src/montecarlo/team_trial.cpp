// SPDX-License-Identifier: BSD-3-Clause
#include "team_trial.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/errors.hpp"
#include "team/team_drive.hpp"

namespace helixnav::apps {
namespace {

/// Beyond this a join is false: any wrong shift of an orchard is larger.
constexpr double wrong_m = 3.0;
constexpr double wrong_rad = 0.1;

void judge_pair(const TeamTask& task, const TeamDrive& drive, std::size_t a, std::size_t b, TeamVerdict& verdict) {
  const auto& robots = task.recording.robots;
  const core::Pose2 truth = core::between(robots[a].recording.true_poses.back().T_world_robot,
                                          robots[b].recording.true_poses.back().T_world_robot);
  const core::Pose2 estimate =
      core::between(drive.team.pose(static_cast<int>(a)).mean, drive.team.pose(static_cast<int>(b)).mean);
  const double error_m = (estimate.position_m() - truth.position_m()).norm();
  const double error_rad = std::abs(core::wrap_to_pi(estimate.heading_rad - truth.heading_rad));
  verdict.error_m = std::max(verdict.error_m, error_m);
  verdict.error_rad = std::max(verdict.error_rad, error_rad);
  verdict.wrong = verdict.wrong || error_m > wrong_m || error_rad > wrong_rad;
}

/// The true identity of a robot's name: the label that most observations of the name have.
std::map<std::int64_t, core::Label> labels_of(const core::Recording& recording, const TeamDrive::Robot& robot) {
  std::map<std::int64_t, std::map<core::Label, int>> counts;
  for (std::size_t k = 0; k < robot.names.size(); ++k) {
    for (std::size_t i = 0; i < robot.names[k].size(); ++i) ++counts[robot.names[k][i]][recording.labels[k][i]];
  }
  std::map<std::int64_t, core::Label> labels;
  for (const auto& [name, count] : counts) {
    const auto less = [](const auto& a, const auto& b) { return a.second < b.second; };
    if (name >= 0) labels[name] = std::max_element(count.begin(), count.end(), less)->first;
  }
  return labels;
}

void judge_merged(const TeamTask& task, const TeamDrive& drive, TeamVerdict& verdict) {
  std::map<core::LandmarkId, std::map<std::size_t, std::set<core::Label>>> labels;  // by landmark and robot
  for (std::size_t r = 0; r < drive.robots.size(); ++r) {
    for (const auto& [name, label] : labels_of(task.recording.robots[r].recording, drive.robots[r])) {
      const core::LandmarkId id = drive.team.landmark_of(static_cast<int>(r), name);
      if (id != core::no_landmark) labels[id][r].insert(label);
    }
  }
  for (const auto& [id, by_robot] : labels) {
    if (by_robot.size() < 2) continue;
    std::set<core::Label> all;
    for (const auto& [robot, of_robot] : by_robot) all.insert(of_robot.begin(), of_robot.end());
    ++verdict.merged;
    verdict.merged_wrong += all.size() > 1 || *all.begin() == core::no_label ? 1 : 0;
  }
  verdict.wrong = verdict.wrong || 2 * verdict.merged_wrong > verdict.merged;
}

TeamVerdict judge(const TeamTrial& trial, const TeamTask& task, const TeamDrive& drive) {
  TeamVerdict verdict;
  verdict.joined = true;
  for (std::size_t a = 0; a < drive.robots.size(); ++a) {
    verdict.joined = verdict.joined && drive.robots[a].component == 0;
    for (std::size_t b = a + 1; b < drive.robots.size(); ++b) {
      if (drive.robots[a].component == drive.robots[b].component) judge_pair(task, drive, a, b, verdict);
    }
  }
  judge_merged(task, drive, verdict);
  for (const team::TeamJoin& join : drive.team.joins()) verdict.t_s = core::seconds(join.t_ns);
  // They have nothing in common: no place is right.
  if (trial.world.kind == sim::TeamWorldKind::apart) verdict.wrong = !drive.team.joins().empty();
  return verdict;
}

}  // namespace

std::vector<TeamTrial> trials_of(std::uint64_t seed) {
  constexpr std::array<double, 4> pitches_m{4.0, 6.0, 8.0, 12.0};
  constexpr std::array<double, 4> jitters_m{0.0, 0.1, 0.3, 0.6};
  std::vector<TeamTrial> trials(4);
  trials[0].name = "shared";
  trials[1].name = "apart";
  trials[1].world.kind = sim::TeamWorldKind::apart;
  trials[2].name = "chain";
  trials[2].world.robots = 3;
  trials[3].name = "orchard";
  trials[3].world.kind = sim::TeamWorldKind::orchard;
  trials[3].world.pitch_m = pitches_m[seed % 4];
  trials[3].world.jitter_m = jitters_m[seed / 4 % 4];
  return trials;
}

TeamVerdict judge_world(const TeamTrial& trial, std::uint64_t seed) {
  TeamTask task;
  task.recording = sim::simulate_team(trial.world, seed);
  task.unknown_starts = true;
  task.known_association = false;
  task.own_names = true;
  task.quiet = true;
  task.options.join.by_names = false;
  task.options.join.by_sightings = false;
  task.options.join.by_constellation = true;
  try {
    return judge(trial, task, drive_team(task));
  } catch (const core::NumericalError&) {
    TeamVerdict verdict;
    verdict.failed = true;
    return verdict;
  }
}

}  // namespace helixnav::apps
