// SPDX-License-Identifier: BSD-3-Clause
#include "team/team_folder.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "helixnav/files/append_cells.hpp"
#include "helixnav/files/file.hpp"
#include "helixnav/files/number_text.hpp"
#include "helixnav/reports/finish_run.hpp"
#include "helixnav/runs/run_recorder.hpp"
#include "helixnav/runs/run_writer.hpp"
#include "helixnav/runs/words.hpp"

namespace helixnav::apps {
namespace {

using Json = nlohmann::ordered_json;

int number_of(const TeamTask& task, int robot) { return task.recording.robots[static_cast<std::size_t>(robot)].number; }

void append_join(std::string& text, const TeamTask& task, const team::TeamJoin& join) {
  const core::Pose2& T = join.T_component_other;
  files::append_seconds(text, join.t_ns);
  text += std::string(",") + team::name_of(join.by) + ',' + std::to_string(number_of(task, join.robot)) + ',' +
          std::to_string(number_of(task, join.other));
  files::append_cells(
      text, {T.x_m, T.y_m, T.heading_rad, static_cast<double>(join.merged), static_cast<double>(join.sightings),
             join.cost, static_cast<double>(join.dof), join.limit, static_cast<double>(join.left_out)});
}

std::string joins_text(const TeamTask& task, const TeamDrive& drive) {
  std::string text;
  char line[200];
  for (const team::TeamJoin& join : drive.team.joins()) {
    std::snprintf(line, sizeof line,
                  "at %.1f s robot %d came into the frame of robot %d by %s (chi2 %.1f of at most %.1f)",
                  core::seconds(join.t_ns), number_of(task, join.other), number_of(task, join.robot),
                  team::name_of(join.by), join.cost, join.limit);
    text += line;
    if (join.left_out > 0) {
      std::snprintf(line, sizeof line, "; %d common names contradict the others and were left out", join.left_out);
      text += line;
    }
    text += '\n';
  }
  return text;
}

std::string slips_text(const TeamTask& task, const TeamDrive& drive) {
  std::string text;
  for (std::size_t r = 0; r < drive.robots.size(); ++r) {
    std::string times;
    for (const team::RobotSlip& slip : drive.team.slips()) {
      if (static_cast<std::size_t>(slip.robot) != r) continue;
      char time[40];
      std::snprintf(time, sizeof time, "%s%.1f", times.empty() ? "" : ", ", core::seconds(slip.t_ns));
      times += time;
    }
    if (times.empty()) continue;
    const std::string number = std::to_string(task.recording.robots[r].number);
    text += "robot " + number + " slipped, at " + times + " s: see 'helixnav explain' of robot_" + number + '\n';
  }
  return text;
}

/// One line for all evidence on which the same two were joined, and separated at the same time.
std::string taken_back_text(const TeamTask& task, const TeamDrive& drive) {
  std::string text;
  const std::vector<team::TakenBackJoin>& all = drive.team.joins_taken_back();
  for (std::size_t first = 0; first < all.size();) {
    const team::TakenBackJoin& one = all[first];
    const auto is_same = [&](const team::TakenBackJoin& other) {
      return other.join.robot == one.join.robot && other.join.other == one.join.other && other.t_ns == one.t_ns;
    };
    std::size_t end = first;
    while (end < all.size() && is_same(all[end])) ++end;
    char line[200];
    std::snprintf(line, sizeof line, "at %.1f s a join of robots %d and %d by %s at %.1f s was taken back",
                  core::seconds(one.t_ns), number_of(task, one.join.robot), number_of(task, one.join.other),
                  team::name_of(one.join.by), core::seconds(one.join.t_ns));
    text += line;
    if (end - first > 1) text += " (and on other evidence, " + std::to_string(end - first) + " times in all)";
    std::snprintf(line, sizeof line, ": %d of %d sightings since contradict it\n", one.refused, one.seen);
    text += line;
    first = end;
  }
  return text;
}

std::string joins_table(const TeamTask& task, const TeamDrive& drive) {
  std::string text =
      "t_s,by,robot,other,x,y,heading,merged,sightings,cost,dof,limit,left_out,state,taken_back_s,refused,refused_of\n";
  for (const team::TeamJoin& join : drive.team.joins()) {
    append_join(text, task, join);
    text += ",holds,,,\n";
  }
  for (const team::TakenBackJoin& one : drive.team.joins_taken_back()) {
    append_join(text, task, one.join);
    text += ",taken back,";
    files::append_seconds(text, one.t_ns);
    text += ',' + std::to_string(one.refused) + ',' + std::to_string(one.seen) + '\n';
  }
  return text;
}

std::string sightings_table(const TeamTask& task, const TeamDrive& drive) {
  std::string text = "t_s,robot,seen,used,residual_0,residual_1\n";
  for (const team::JudgedSighting& sighting : drive.team.sightings()) {
    files::append_seconds(text, sighting.t_ns);
    text += ',' + std::to_string(number_of(task, sighting.robot)) + ',' +
            std::to_string(number_of(task, sighting.seen)) + ',' + (sighting.used ? '1' : '0');
    if (sighting.residual) {
      files::append_cells(text, {sighting.residual->x(), sighting.residual->y()});
    } else {
      text += ",,";
    }
    text += '\n';
  }
  return text;
}

/// Steps at which the log has sightings, without those between that only say where the robot was.
std::int64_t scans_of(const TeamDrive::Robot& robot) { return std::count(robot.at.begin(), robot.at.end(), 1); }

std::set<int> components_of(const TeamDrive& drive) {
  std::set<int> components;
  for (const TeamDrive::Robot& robot : drive.robots) components.insert(robot.component);
  return components;
}

std::string names_text(const std::set<std::int64_t>& names) {
  std::string text;
  for (const std::int64_t name : names) text += (text.empty() ? "" : " ") + std::to_string(name);
  return text;
}

/// What the robots of a component call their landmarks.
std::map<core::LandmarkId, std::set<std::int64_t>> names_in(const TeamDrive& drive, int component) {
  std::map<core::LandmarkId, std::set<std::int64_t>> names;
  for (std::size_t r = 0; r < drive.robots.size(); ++r) {
    if (drive.robots[r].component != component) continue;
    std::set<std::int64_t> own;
    for (const std::vector<std::int64_t>& scan : drive.robots[r].names) own.insert(scan.begin(), scan.end());
    for (const std::int64_t name : own) {
      const core::LandmarkId id = drive.team.landmark_of(static_cast<int>(r), name);
      if (id != core::no_landmark) names[id].insert(name);
    }
  }
  return names;
}

std::string map_table(const TeamTask& task, const TeamDrive& drive) {
  std::string text = "component,landmark,x,y,xx,xy,yy,observations,state,names\n";
  for (const int component : components_of(drive)) {
    const std::map<core::LandmarkId, std::set<std::int64_t>> names = names_in(drive, component);
    for (const core::MapLandmark& landmark : drive.team.map(component)) {
      const Eigen::Matrix2d& P = landmark.point.covariance_m2;
      text += std::to_string(number_of(task, component)) + ',' + std::to_string(landmark.id);
      files::append_cells(text, {landmark.point.mean_m.x(), landmark.point.mean_m.y(), P(0, 0), P(0, 1), P(1, 1),
                                 static_cast<double>(landmark.observations)});
      text += ',' + std::string(runs::word_of(runs::state_words, landmark.state)) + ',';
      const auto own = names.find(landmark.id);
      if (own != names.end()) text += names_text(own->second);
      text += '\n';
    }
  }
  return text;
}

/// Whether the robot, in a team, has a frame to itself at the end.
bool is_alone(const TeamDrive& drive, std::size_t r) {
  const auto mates = std::count_if(drive.robots.begin(), drive.robots.end(), [&](const TeamDrive::Robot& robot) {
    return robot.component == drive.robots[r].component;
  });
  return drive.robots.size() > 1 && mates == 1;
}

Json json_of(const evaluation::ErrorStatistics& errors) {
  return {{"count", errors.count},
          {"rmse", errors.rmse},
          {"median", errors.median},
          {"p95", errors.p95},
          {"max", errors.max}};
}

/// The robot's truth in the frame of its component.
core::Recording with_truth_moved(const TeamTask& task, const core::Recording& recording, int component) {
  core::Recording moved = recording;
  moved.events.clear();
  const std::optional<core::Pose2> T = frame_of_truth(task, component);
  if (!T) {
    moved.true_poses.clear();
    moved.true_landmarks.clear();
    return moved;
  }
  for (core::TruePose& pose : moved.true_poses) pose.T_world_robot = core::compose(*T, pose.T_world_robot);
  for (core::TrueLandmark& landmark : moved.true_landmarks) landmark.point_m = core::transform(*T, landmark.point_m);
  return moved;
}

void write_robot(const std::string& folder, bool overwrite, runs::RunManifest manifest, const TeamTask& task,
                 const TeamDrive& drive, std::size_t r) {
  const TeamDrive::Robot& robot = drive.robots[r];
  const core::Recording recording = with_truth_moved(task, task.recording.robots[r].recording, robot.component);
  manifest.recording = recording.name;
  using IfNotEmpty = runs::RunWriter::IfNotEmpty;
  runs::RunWriter writer(folder, manifest, recording, overwrite ? IfNotEmpty::overwrite : IfNotEmpty::refuse);
  runs::RunRecorder recorder(folder, manifest, recording);
  for (std::size_t k = 0; k < robot.steps.size(); ++k) {
    writer.write(robot.steps[k], robot.microseconds[k]);
    recorder.add(robot.steps[k], robot.microseconds[k]);
  }
  const runs::Run run = recorder.finish(drive.team.map(static_cast<int>(r)));
  reports::finish_run(run, writer);
}

}  // namespace

std::string team_summary(const TeamTask& task, const TeamDrive& drive, const TeamEvaluation& evaluation) {
  Json json;
  int used = 0;
  const std::vector<team::JudgedSighting> sightings = drive.team.sightings();
  for (const team::JudgedSighting& sighting : sightings) used += sighting.used ? 1 : 0;
  json["misread"] = task.recording.misread;
  json["joins"] = drive.team.joins().size();
  json["joins_taken_back"] = drive.team.joins_taken_back().size();
  json["sightings"] = {{"count", sightings.size()}, {"used", used}};
  for (std::size_t r = 0; r < drive.robots.size(); ++r) {
    Json robot{{"robot", task.recording.robots[r].number},
               {"component", number_of(task, drive.robots[r].component)},
               {"alone", is_alone(drive, r)},
               {"scans", scans_of(drive.robots[r])}};
    if (drive.robots[r].wrongly_placed > 0) robot["scans_in_wrong_frame"] = drive.robots[r].wrongly_placed;
    const core::Nanoseconds since_ns = drive.robots[r].in_frame_since_ns;
    if (since_ns > std::numeric_limits<core::Nanoseconds>::min()) robot["in_frame_since_s"] = core::seconds(since_ns);
    if (evaluation.robots[r]) {
      robot["position_error_m"] = json_of(evaluation.robots[r]->raw_m);
      robot["aligned_position_error_m"] = json_of(evaluation.robots[r]->aligned_m);
      robot["nees_mean"] = evaluation.robots[r]->nees_mean;
    }
    json["robots"].push_back(robot);
  }
  for (const LandmarkErrors& errors : evaluation.landmarks) {
    json["landmarks"].push_back({{"component", number_of(task, errors.component)},
                                 {"count", errors.landmarks},
                                 {"rmse_m", errors.raw_rmse_m},
                                 {"aligned_rmse_m", errors.aligned_rmse_m}});
  }
  json["timing"] = {{"navigating_s", drive.seconds}};
  return json.dump(2) + '\n';
}

namespace {

/// Robots of a run that is overwritten would seem to be of this one.
void remove_other_robots(const std::string& folder, const TeamTask& task) {
  std::set<std::string> robots;
  for (const auto& robot : task.recording.robots) robots.insert("robot_" + std::to_string(robot.number));
  std::vector<std::filesystem::path> others;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const bool is_run = name.rfind("robot_", 0) == 0 && std::filesystem::exists(entry.path() / "manifest.json");
    if (is_run && robots.count(name) == 0) others.push_back(entry.path());
  }
  for (const std::filesystem::path& other : others) std::filesystem::remove_all(other);
}

}  // namespace

void write_team(const std::string& folder, bool overwrite, const runs::RunManifest& manifest, const TeamTask& task,
                const TeamDrive& drive, const TeamEvaluation& evaluation) {
  for (std::size_t r = 0; r < drive.robots.size(); ++r) {
    const std::string name = "/robot_" + std::to_string(task.recording.robots[r].number);
    write_robot(folder + name, overwrite, manifest, task, drive, r);
  }
  if (overwrite) remove_other_robots(folder, task);
  files::write_whole_file(folder + "/map.csv", map_table(task, drive));
  files::write_whole_file(folder + "/joins.csv", joins_table(task, drive));
  files::write_whole_file(folder + "/sightings.csv", sightings_table(task, drive));
  files::write_whole_file(folder + "/report.html", team_page(manifest.command, task, drive, evaluation));
  files::write_whole_file(folder + "/summary.json", team_summary(task, drive, evaluation));
}

namespace {

std::size_t seen_once(const TeamDrive& drive, int component) {
  const std::vector<core::MapLandmark> map = drive.team.map(component);
  return static_cast<std::size_t>(std::count_if(map.begin(), map.end(), [](const core::MapLandmark& landmark) {
    return landmark.state == core::LandmarkState::tentative;
  }));
}

std::string seen_once_text(const TeamDrive& drive, int component) {
  const std::size_t count = seen_once(drive, component);
  return count == 0 ? "" : " (not counted: " + std::to_string(count) + " seen only once)";
}

}  // namespace

std::string team_text(const TeamTask& task, const TeamDrive& drive, const TeamEvaluation& evaluation) {
  std::string text;
  char line[200];
  double mean = 0.0;
  int with_truth = 0;
  for (std::size_t r = 0; r < drive.robots.size(); ++r) {
    const TeamDrive::Robot& robot = drive.robots[r];
    std::snprintf(line, sizeof line, "robot %d: %lld scans, in the frame of robot %d", task.recording.robots[r].number,
                  static_cast<long long>(scans_of(robot)), number_of(task, robot.component));
    text += line;
    if (is_alone(drive, r)) {
      text += robot.wrongly_placed > 0 ? ", which it has to itself: what joined it to another was taken back"
                                       : ", which it has to itself: nothing joined it to another";
    } else if (robot.wrongly_placed > 0) {
      std::snprintf(line, sizeof line, " (%zu scans before a join was taken back)", robot.wrongly_placed);
      text += line;
    }
    if (evaluation.robots[r]) {
      const RobotErrors& errors = *evaluation.robots[r];
      std::snprintf(line, sizeof line, "; position RMSE %.3f m, aligned %.3f m", errors.raw_m.rmse,
                    errors.aligned_m.rmse);
      text += line;
      std::snprintf(line, sizeof line, ", NEES %.1f (3)", errors.nees_mean);
      text += std::isnan(errors.nees_mean) ? ", NEES of no scan (it came into its frame at the end)" : line;
      mean += errors.raw_m.rmse;
      ++with_truth;
    }
    text += '\n';
  }
  if (with_truth > 0) {
    std::snprintf(line, sizeof line, "mean position RMSE %.3f m\n", mean / with_truth);
    text += line;
  }
  for (const LandmarkErrors& errors : evaluation.landmarks) {
    std::snprintf(line, sizeof line, "frame of robot %d: %zu landmarks, ", number_of(task, errors.component),
                  errors.landmarks);
    text += line;
    if (std::isfinite(errors.raw_rmse_m)) {
      std::snprintf(line, sizeof line, "RMSE %.3f m, ", errors.raw_rmse_m);
      text += line;
    }
    std::snprintf(line, sizeof line, "aligned %.3f m", errors.aligned_rmse_m);
    text += line + seen_once_text(drive, errors.component) + '\n';
  }
  for (const int component : components_of(drive)) {
    const bool told = std::any_of(evaluation.landmarks.begin(), evaluation.landmarks.end(),
                                  [&](const LandmarkErrors& errors) { return errors.component == component; });
    if (told) continue;
    const std::size_t tentative = seen_once(drive, component);
    std::snprintf(line, sizeof line, "frame of robot %d: %zu landmarks", number_of(task, component),
                  drive.team.map(component).size() - tentative);
    text += line + seen_once_text(drive, component) + '\n';
  }
  text += slips_text(task, drive);
  text += joins_text(task, drive);
  text += taken_back_text(task, drive);
  return text;
}

}  // namespace helixnav::apps
