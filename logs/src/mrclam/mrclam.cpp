// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/mrclam.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "helixnav/core/errors.hpp"
#include "helixnav/logs/handedness.hpp"
#include "input_files.hpp"
#include "mrclam/command_motion.hpp"
#include "mrclam/mrclam_tables.hpp"

namespace helixnav::logs {
namespace {

namespace fs = std::filesystem;
using Robot = MrclamTables::Robot;

std::vector<int> chosen_robots(const fs::path& path, const MrclamTables& tables, const std::vector<int>& wanted) {
  std::vector<int> chosen;
  for (const int number : wanted) {
    if (tables.robots.count(number) == 0) {
      throw core::InputError(path.string() + ": there is no robot " + std::to_string(number));
    }
    if (std::find(chosen.begin(), chosen.end(), number) != chosen.end()) {
      throw core::InputError(path.string() + ": robot " + std::to_string(number) + " is chosen twice");
    }
    chosen.push_back(number);
  }
  if (!wanted.empty()) return chosen;
  for (const auto& [number, robot] : tables.robots) chosen.push_back(number);
  return chosen;
}

std::string span_text(core::Nanoseconds begin_ns, core::Nanoseconds end_ns) {
  return std::to_string(core::seconds(begin_ns)) + " to " + std::to_string(core::seconds(end_ns)) + " s";
}

void check_span(const Robot& robot, int number, core::Nanoseconds begin_ns, core::Nanoseconds end_ns,
                const std::string& of_whom) {
  const core::Nanoseconds first_ns = robot.commands.front().t_ns;
  const core::Nanoseconds last_ns = robot.commands.back().t_ns;
  if (begin_ns <= last_ns && end_ns >= first_ns) return;
  throw core::InputError(robot.file + ": the commands of robot " + std::to_string(number) + " last from " +
                         span_text(first_ns, last_ns) + ", and " + of_whom + " from " + span_text(begin_ns, end_ns) +
                         ": expected one clock");
}

/// A command is held until the next one, but not for hours: increments every half second would fill the memory.
void check_gaps(const Robot& robot, const std::string& name) {
  constexpr core::Nanoseconds most_held_ns = 3'600'000'000'000;
  for (std::size_t k = 1; k < robot.commands.size(); ++k) {
    const core::Nanoseconds from_ns = robot.commands[k - 1].t_ns, to_ns = robot.commands[k].t_ns;
    if (to_ns - from_ns <= most_held_ns) continue;
    throw core::InputError(robot.file + ": " + name + " has no command from " + span_text(from_ns, to_ns) +
                           ": expected one an hour, at least");
  }
}

bool is_seen(const MrclamTables& tables, const std::vector<int>& chosen, int number) {
  return std::any_of(chosen.begin(), chosen.end(), [&](int other) {
    const std::vector<MrclamTables::Sighting>& sightings = tables.robots.at(other).sightings;
    return std::any_of(sightings.begin(), sightings.end(), [&](const auto& one) { return one.subject == number; });
  });
}

/// A robot of which only the commands are known is not part of the team, as long as there are others.
void leave_out_unseen(MrclamTables& tables, std::vector<int>& chosen) {
  const auto is_known = [&](int number) {
    return !tables.robots.at(number).sightings.empty() || is_seen(tables, chosen, number);
  };
  const std::vector<int> all = chosen;
  if (std::none_of(all.begin(), all.end(), is_known)) return;
  std::vector<int> known;
  std::copy_if(all.begin(), all.end(), std::back_inserter(known), is_known);
  for (const int number : all) {
    if (is_known(number)) continue;
    tables.remarks.push_back("warning: robot " + std::to_string(number) +
                             " is left out: it has no sightings, and no other sees it");
  }
  chosen = known;
}

/// The longest time that a command was held for, up to the last sighting, if it is out of all proportion: rows were
/// lost.
void remark_on_longest_gap(const Robot& robot, int number, std::vector<std::string>& remarks) {
  std::vector<core::Nanoseconds> gaps_ns;
  core::Nanoseconds longest_ns = 0, from_ns = 0;
  const auto note = [&](core::Nanoseconds begin_ns, core::Nanoseconds end_ns) {
    if (end_ns - begin_ns <= longest_ns) return;
    longest_ns = end_ns - begin_ns;
    from_ns = begin_ns;
  };
  for (std::size_t k = 1; k < robot.commands.size(); ++k) {
    gaps_ns.push_back(robot.commands[k].t_ns - robot.commands[k - 1].t_ns);
    note(robot.commands[k - 1].t_ns, robot.commands[k].t_ns);
  }
  if (!robot.sightings.empty()) note(robot.commands.back().t_ns, robot.sightings.back().t_ns);
  if (gaps_ns.empty()) return;
  const auto middle = gaps_ns.begin() + static_cast<std::ptrdiff_t>(gaps_ns.size() / 2);
  std::nth_element(gaps_ns.begin(), middle, gaps_ns.end());
  constexpr core::Nanoseconds long_ns = 5'000'000'000, usual = 50;
  if (longest_ns < long_ns || longest_ns < usual * *middle) return;
  remarks.push_back("robot " + std::to_string(number) + " has no command from " +
                    span_text(from_ns, from_ns + longest_ns) + ": the last one is taken to hold");
}

void check(const fs::path& path, const MrclamTables& tables, const std::vector<int>& chosen) {
  const Robot& first = tables.robots.at(chosen.front());
  for (const int number : chosen) {
    const Robot& robot = tables.robots.at(number);
    const std::string name = "robot " + std::to_string(number);
    if (robot.commands.empty()) throw core::InputError(robot.file + ": expected commands of " + name + ", found none");
    check_gaps(robot, name);
    if (!robot.sightings.empty()) {
      check_span(robot, number, robot.sightings.front().t_ns, robot.sightings.back().t_ns, "its sightings");
    } else if (!is_seen(tables, chosen, number)) {
      throw core::InputError(path.string() + ": " + name +
                             " has no sightings, and no other sees it: choose others (--robots N,N)");
    }
    check_span(robot, number, first.commands.front().t_ns, first.commands.back().t_ns, "those of another robot");
    if (robot.truth.empty()) continue;
    check_span(robot, number, robot.truth.front().t_ns, robot.truth.back().t_ns, "its truth");
  }
}

template <class Row>
int sort_by_time(std::vector<Row>& rows) {
  int swapped = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) swapped += rows[i].t_ns < rows[i - 1].t_ns ? 1 : 0;
  std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.t_ns < b.t_ns; });
  return swapped;
}

/// Times at which increments end: sightings by the robot and of it, and at intervals in between.
std::vector<core::Nanoseconds> ends_of_increments(const MrclamTables& tables, const std::vector<int>& chosen,
                                                  int number) {
  const Robot& robot = tables.robots.at(number);
  const core::Nanoseconds begin_ns = robot.commands.front().t_ns;
  std::set<core::Nanoseconds> ends;
  for (const auto& sighting : robot.sightings) ends.insert(sighting.t_ns);
  for (const int other : chosen) {
    for (const auto& sighting : tables.robots.at(other).sightings) {
      if (sighting.subject == number) ends.insert(sighting.t_ns);
    }
  }
  constexpr core::Nanoseconds once_in_ns = 500'000'000;
  for (core::Nanoseconds t_ns = begin_ns + once_in_ns; t_ns <= robot.commands.back().t_ns; t_ns += once_in_ns) {
    ends.insert(t_ns);
  }
  return {ends.upper_bound(begin_ns), ends.end()};
}

core::Observation observation_of(const MrclamTables::Sighting& sighting, const MrclamSettings& settings) {
  return core::make_range_bearing(sighting.range_m, sighting.bearing_rad, settings.sigma_range_m,
                                  settings.sigma_bearing_rad);
}

/// All sightings of one instant in one scan. If nothing was seen for a while, an empty scan lets a run report where the
/// robot is.
class RobotWeaver {
 public:
  RobotWeaver(const std::vector<int>& chosen, const MrclamSettings& settings, core::TeamRecording& team)
      : chosen_(chosen), settings_(settings), team_(team) {}

  void add(const Robot& robot, core::Nanoseconds t_ns, core::TeamMember& member) {
    const bool sees = next_ < robot.sightings.size() && robot.sightings[next_].t_ns == t_ns;
    constexpr core::Nanoseconds blind_ns = 400'000'000;
    if (!sees && t_ns - last_ns_ < blind_ns) return;
    last_ns_ = t_ns;
    core::Scan scan;
    scan.t_ns = t_ns;
    std::vector<core::Label> labels;
    for (; next_ < robot.sightings.size() && robot.sightings[next_].t_ns == t_ns; ++next_) {
      add(robot.sightings[next_], scan, labels, member);
    }
    member.recording.events.emplace_back(scan);
    member.recording.labels.push_back(labels);
  }

  /// Sightings before the first command.
  void pass_over(const Robot& robot, core::Nanoseconds begin_ns) {
    last_ns_ = begin_ns;
    while (next_ < robot.sightings.size() && robot.sightings[next_].t_ns <= begin_ns) ++next_;
  }

 private:
  void add(const MrclamTables::Sighting& sighting, core::Scan& scan, std::vector<core::Label>& labels,
           core::TeamMember& member) {
    if (sighting.subject == nobody || sighting.subject == member.number) {
      ++team_.misread;
    } else if (!is_robot(sighting.subject)) {
      scan.observations.push_back(observation_of(sighting, settings_));
      labels.push_back(sighting.subject);
    } else {
      const auto seen = std::find(chosen_.begin(), chosen_.end(), sighting.subject);
      if (seen == chosen_.end()) return;
      core::RobotSighting& other = member.sightings.emplace_back();
      other.t_ns = sighting.t_ns;
      other.seen = static_cast<int>(seen - chosen_.begin());
      other.observation = observation_of(sighting, settings_);
    }
  }

  const std::vector<int>& chosen_;
  const MrclamSettings& settings_;
  core::TeamRecording& team_;
  std::size_t next_ = 0;
  core::Nanoseconds last_ns_ = 0;  ///< of the last scan
};

/// The true pose at t_ns, on the straight line between those around it, at most half a second apart.
std::optional<core::Pose2> true_pose_at(const std::vector<core::TruePose>& truth, core::Nanoseconds t_ns) {
  constexpr core::Nanoseconds most_ns = 500'000'000;
  const auto after = std::lower_bound(truth.begin(), truth.end(), t_ns,
                                      [](const core::TruePose& pose, core::Nanoseconds t) { return pose.t_ns < t; });
  if (after == truth.end()) return std::nullopt;
  if (after->t_ns == t_ns || (after == truth.begin() && after->t_ns - t_ns <= most_ns)) return after->T_world_robot;
  if (after == truth.begin()) return std::nullopt;
  const core::TruePose& before = *std::prev(after);
  if (after->t_ns - before.t_ns > most_ns) return std::nullopt;
  const double share = core::seconds(t_ns - before.t_ns) / core::seconds(after->t_ns - before.t_ns);
  const Eigen::Vector3d way = core::between(before.T_world_robot, after->T_world_robot).vector();
  return core::compose(before.T_world_robot, core::Pose2(Eigen::Vector3d(share * way)));
}

core::TeamMember member_of(const MrclamTables& tables, const std::vector<int>& chosen, int number,
                           const MrclamSettings& settings, core::TeamRecording& team) {
  const Robot& robot = tables.robots.at(number);
  core::TeamMember member;
  member.number = number;
  member.recording.name = team.name + ", robot " + std::to_string(number);
  CommandMotion motion(robot.commands, settings);
  RobotWeaver weaver(chosen, settings, team);
  weaver.pass_over(robot, robot.commands.front().t_ns);
  for (const core::Nanoseconds t_ns : ends_of_increments(tables, chosen, number)) {
    member.recording.events.emplace_back(motion.until(t_ns));
    weaver.add(robot, t_ns, member);
  }
  const std::optional<core::Pose2> start = true_pose_at(robot.truth, robot.commands.front().t_ns);
  team.starts_known = team.starts_known && start.has_value();
  if (start) {
    member.recording.start.mean = *start;
    member.recording.true_poses = robot.truth;
    member.recording.true_landmarks = tables.landmarks;
  }
  if (robot.swapped > 0) {
    team.remarks.push_back(robot.file + ": robot " + std::to_string(number) + ": " + std::to_string(robot.swapped) +
                           " commands stood after a later one and were put in order");
  }
  return member;
}

}  // namespace

bool is_mrclam(const fs::path& path) {
  if (!fs::exists(path)) return false;
  const auto is_commands = [](const std::string& name) {
    return ends_with(name, "_Odometry.dat") && name.substr(0, 5) == "Robot";
  };
  if (!fs::is_directory(path)) {
    const std::vector<std::string> names = names_in_archive(path);
    return std::any_of(names.begin(), names.end(), is_commands);
  }
  const bool own = fs::exists(path / "vehicle.toml") || fs::exists(path / "detections.csv");
  const auto has = [&](const char* name) { return !plain_or_packed(path, name).empty(); };
  if (!own && (has("measurements.csv") || (has("odometry.csv") && has("landmarks_true.csv")))) return true;
  for (const auto& entry : fs::directory_iterator(path)) {
    if (is_commands(entry.path().filename().string())) return true;
  }
  return false;
}

core::TeamRecording read_mrclam(const fs::path& path, const std::vector<int>& robots, const MrclamSettings& settings) {
  const bool tables_there = fs::is_directory(path) && (!plain_or_packed(path, "odometry.csv").empty() ||
                                                       !plain_or_packed(path, "measurements.csv").empty());
  MrclamTables tables = tables_there ? read_mrclam_csv(path) : read_mrclam_dat(path);
  for (auto& [number, robot] : tables.robots) {
    robot.swapped = sort_by_time(robot.commands);
    sort_by_time(robot.sightings);
    sort_by_time(robot.truth);
  }
  std::vector<int> chosen = chosen_robots(path, tables, robots);
  if (chosen.empty()) throw core::InputError(path.string() + ": expected commands of robots, found none");
  if (robots.empty()) leave_out_unseen(tables, chosen);
  check(path, tables, chosen);
  core::TeamRecording team;
  team.name = (path.has_filename() ? path : path.parent_path()).filename().string();
  team.true_landmarks = tables.landmarks;
  if (robots.empty()) team.remarks = tables.remarks;  // otherwise it is left out by choice
  team.starts_known = true;
  team.looks_as_one = settings.looks_as_one;
  for (const int number : chosen) {
    remark_on_longest_gap(tables.robots.at(number), number, team.remarks);
    team.robots.push_back(member_of(tables, chosen, number, settings, team));
    if (const std::optional<std::string> doubt = doubt_handedness(team.robots.back().recording))
      team.remarks.push_back("warning: robot " + std::to_string(number) + ": " + *doubt);
  }
  return team;
}

}  // namespace helixnav::logs
