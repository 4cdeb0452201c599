// SPDX-License-Identifier: BSD-3-Clause
#include "team/team_drive.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <tuple>
#include <utility>
#include <variant>

#include "common/interrupt.hpp"
#include "common/progress_bar.hpp"
#include "helixnav/core/errors.hpp"
#include "team/last_frames.hpp"
#include "team/own_names.hpp"

namespace helixnav::apps {
namespace {

/// One event of one robot, in the order in which Team expects them: motions, sightings of robots, scans.
struct Fed {
  enum Kind { motion, sighting, scan };
  core::Nanoseconds t_ns;
  Kind kind;
  int robot;
  std::size_t index;  ///< of the event, or of the sighting
  std::size_t step;   ///< of a scan
};

std::vector<Fed> in_order(const core::TeamRecording& recording) {
  std::vector<Fed> all;
  for (std::size_t r = 0; r < recording.robots.size(); ++r) {
    const core::TeamMember& member = recording.robots[r];
    const int robot = static_cast<int>(r);
    std::size_t step = 0;
    for (std::size_t i = 0; i < member.recording.events.size(); ++i) {
      const core::Event& event = member.recording.events[i];
      const bool is_scan = std::holds_alternative<core::Scan>(event);
      all.push_back({core::time_of(event), is_scan ? Fed::scan : Fed::motion, robot, i, is_scan ? step++ : 0});
    }
    for (std::size_t i = 0; i < member.sightings.size(); ++i) {
      all.push_back({member.sightings[i].t_ns, Fed::sighting, robot, i, 0});
    }
  }
  const auto key = [](const Fed& fed) { return std::make_tuple(fed.t_ns, fed.kind, fed.robot); };
  std::stable_sort(all.begin(), all.end(), [&](const Fed& a, const Fed& b) { return key(a) < key(b); });
  return all;
}

team::Team make_team(const TeamTask& task) {
  std::vector<std::optional<core::PoseGaussian>> starts;
  for (const core::TeamMember& member : task.recording.robots) {
    starts.push_back(task.unknown_starts ? std::nullopt : std::optional(member.recording.start));
  }
  return team::Team(starts, task.options);
}

void bring_into_last_frames(const LastFrames& frames, const std::vector<std::vector<std::size_t>>& told_in,
                            TeamDrive& drive) {
  for (std::size_t r = 0; r < drive.robots.size(); ++r) {
    const int robot = static_cast<int>(r);
    for (std::size_t k = 0; k < drive.robots[r].steps.size(); ++k) {
      core::StepReport& step = drive.robots[r].steps[k];
      const core::Pose2 T = frames.T_end_then(robot, told_in[r][k]);
      Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
      turn.topLeftCorner<2, 2>() = core::rotation(T.heading_rad);
      step.pose.mean = core::compose(T, step.pose.mean);
      const Eigen::Matrix3d turned = turn * step.pose.covariance * turn.transpose();
      step.pose.covariance = 0.5 * (turned + turned.transpose());
      drive.robots[r].wrongly_placed += frames.was_taken_back(robot, told_in[r][k]) ? 1 : 0;
    }
    drive.robots[r].component = drive.team.component(robot);
    drive.robots[r].in_frame_since_ns = frames.since_ns(robot);
  }
}

/// The slips that hold at the end: a scan that was processed again since may have been told otherwise.
void tell_slips(TeamDrive& drive) {
  const auto is_slip = [](const core::Decision& one) { return std::holds_alternative<core::SlipDecision>(one); };
  for (TeamDrive::Robot& robot : drive.robots) {
    for (core::StepReport& step : robot.steps) {
      step.decisions.erase(std::remove_if(step.decisions.begin(), step.decisions.end(), is_slip), step.decisions.end());
    }
  }
  for (const team::RobotSlip& slip : drive.team.slips()) {
    std::vector<core::StepReport>& steps = drive.robots[static_cast<std::size_t>(slip.robot)].steps;
    const auto step =
        std::find_if(steps.begin(), steps.end(), [&](const core::StepReport& one) { return one.t_ns == slip.t_ns; });
    if (step != steps.end()) step->decisions.emplace_back(slip.decision);
  }
}

}  // namespace

TeamTask task_of(core::TeamRecording recording, bool unknown_starts, bool known_association) {
  if (!unknown_starts && !recording.starts_known) {
    throw core::InputError(recording.name +
                           ": not all robots have a true pose at their first command: give "
                           "--unknown-starts (in Python: unknown_starts=True)");
  }
  TeamTask task;
  task.unknown_starts = unknown_starts;
  task.known_association = known_association;
  task.options.looks_as_one = recording.looks_as_one;
  task.options.join.by_names = known_association;
  task.options.join.by_constellation = task.options.join.by_place = !known_association;
  task.recording = std::move(recording);
  return task;
}

TeamDrive drive_team(const TeamTask& task) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  const auto since = [](Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); };
  const std::vector<core::TeamMember>& members = task.recording.robots;
  TeamDrive drive{std::vector<TeamDrive::Robot>(members.size()), make_team(task), 0.0};
  std::vector<int> first_component;
  for (std::size_t r = 0; r < members.size(); ++r) first_component.push_back(drive.team.component(static_cast<int>(r)));
  LastFrames frames(first_component);
  std::vector<std::vector<std::size_t>> told_in(members.size());
  std::vector<OwnNames> own(task.own_names ? members.size() : 0);
  std::vector<core::Nanoseconds> last_sighting_ns(members.size(), -1);
  const std::vector<Fed> all = in_order(task.recording);
  ProgressBar progress("navigating", all.size(), task.quiet);
  for (std::size_t k = 0; k < all.size() && !interrupted(); ++k) {
    if (task.before_each_event) task.before_each_event();
    const Fed& fed = all[k];
    const auto r = static_cast<std::size_t>(fed.robot);
    const core::TeamMember& member = members[r];
    const Clock::time_point began = Clock::now();
    if (fed.kind == Fed::sighting) {
      drive.team.sight(fed.robot, member.sightings[fed.index]);
      last_sighting_ns[r] = fed.t_ns;
      continue;
    }
    const core::Event& event = member.recording.events[fed.index];
    std::vector<std::int64_t> names;
    if (task.own_names) names = own[r].take(event);
    if (task.known_association && fed.kind == Fed::scan) names = member.recording.labels[fed.step];
    if (fed.kind == Fed::scan) drive.robots[r].names.push_back(names);
    std::optional<core::StepReport> report = drive.team.take(fed.robot, event, names);
    progress.advance_to(k);
    if (!report) continue;
    drive.robots[r].at.push_back(!report->associations.empty() || last_sighting_ns[r] == fed.t_ns ? 1 : 0);
    told_in[r].push_back(frames.note(drive.team.joins()));
    drive.robots[r].steps.push_back(std::move(*report));
    drive.robots[r].microseconds.push_back(1e6 * since(began));
  }
  drive.team.solve();
  frames.note(drive.team.joins());
  bring_into_last_frames(frames, told_in, drive);
  tell_slips(drive);
  drive.seconds = since(begin);
  return drive;
}

}  // namespace helixnav::apps
