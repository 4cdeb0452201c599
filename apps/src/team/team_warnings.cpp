// SPDX-License-Identifier: BSD-3-Clause
#include "team/team_warnings.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "team/mapped_anew.hpp"

namespace helixnav::apps {
namespace {

struct Refused {
  std::size_t seen = 0, refused = 0;
};

/// Sightings of landmarks in a row, all refused, by time and landmark.
struct AllRefused {
  core::Nanoseconds from_ns = 0, to_ns = 0;
  std::size_t count = 0;
  std::set<core::LandmarkId> landmarks;
};

AllRefused longest_refused(const TeamDrive::Robot& robot) {
  AllRefused longest, now;
  for (const core::StepReport& step : robot.steps) {
    for (const core::AssociationReport& one : step.associations) {
      if (one.landmark == core::no_landmark) continue;
      if (one.outcome != core::Outcome::rejected) {
        now = AllRefused();
        continue;
      }
      if (now.count++ == 0) now.from_ns = step.t_ns;
      now.to_ns = step.t_ns;
      now.landmarks.insert(one.landmark);
      if (now.count > longest.count) longest = now;
    }
  }
  return longest;
}

/// Landmarks that have a name, and robots: not what is labelled as no landmark.
Refused refused_of(const TeamDrive& drive, std::size_t robot) {
  Refused count;
  for (const core::StepReport& step : drive.robots[robot].steps) {
    for (const core::AssociationReport& one : step.associations) {
      if (one.landmark == core::no_landmark) continue;
      ++count.seen;
      count.refused += one.outcome == core::Outcome::rejected ? 1 : 0;
    }
  }
  for (const team::JudgedSighting& sighting : drive.team.sightings()) {
    if (static_cast<std::size_t>(sighting.robot) != robot || !sighting.residual) continue;
    ++count.seen;
    count.refused += sighting.used ? 0 : 1;
  }
  return count;
}

/// Sightings of one another by each two robots, by their places in the recording: among those of landmarks they are few.
std::map<std::pair<int, int>, Refused> refused_by_pair(const TeamDrive& drive) {
  std::map<std::pair<int, int>, Refused> counts;
  for (const team::JudgedSighting& sighting : drive.team.sightings()) {
    if (!sighting.residual) continue;
    Refused& count = counts[std::minmax(sighting.robot, sighting.seen)];
    ++count.seen;
    count.refused += sighting.used ? 0 : 1;
  }
  return counts;
}

/// Names that robots of a component told.
std::set<std::int64_t> names_of(const TeamDrive& drive, int component) {
  std::set<std::int64_t> names;
  for (const TeamDrive::Robot& robot : drive.robots) {
    if (robot.component != component) continue;
    for (const std::vector<std::int64_t>& scan : robot.names) names.insert(scan.begin(), scan.end());
  }
  return names;
}

std::size_t common_names(const TeamDrive& drive, int one, int other) {
  const std::set<std::int64_t> ours = names_of(drive, one), theirs = names_of(drive, other);
  return static_cast<std::size_t>(std::count_if(
      theirs.begin(), theirs.end(), [&](std::int64_t name) { return name != core::no_label && ours.count(name) > 0; }));
}

template <class... Values>
std::string sentence(const char* format, Values... values) {
  char text[400];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

using Sentences = std::vector<std::string>;
constexpr std::size_t one_in = 5;

int number_of(const TeamTask& task, int robot) { return task.recording.robots[static_cast<std::size_t>(robot)].number; }

void warn_of_refused(const TeamTask& task, const TeamDrive& drive, Sentences& warnings) {
  constexpr std::size_t enough = 50, enough_of_robots = 20;
  for (std::size_t r = 0; r < drive.robots.size(); ++r) {
    const Refused count = refused_of(drive, r);
    if (count.seen < enough || one_in * count.refused <= count.seen) continue;
    warnings.push_back(
        sentence("robot %d: %zu of its %zu sightings of landmarks and robots were refused: its odometry, clock, "
                 "barcodes or pose are wrong",
                 number_of(task, static_cast<int>(r)), count.refused, count.seen));
  }
  for (const auto& [pair, count] : refused_by_pair(drive)) {
    if (count.seen < enough_of_robots || one_in * count.refused <= count.seen) continue;
    warnings.push_back(
        sentence("robots %d and %d: %zu of their %zu sightings of each other were refused: the clock or the odometry "
                 "of one of them is wrong, robots were taken for others, or a start given is wrong",
                 number_of(task, pair.first), number_of(task, pair.second), count.refused, count.seen));
  }
}

/// A landmark that was moved, or a name that is misread, is one; a robot that is not where it believes itself to be sees several where
/// they should not be.
void warn_of_all_refused(const TeamTask& task, const TeamDrive& drive, Sentences& warnings) {
  constexpr std::size_t enough = 10, enough_landmarks = 3;
  for (std::size_t r = 0; r < drive.robots.size(); ++r) {
    const AllRefused refused = longest_refused(drive.robots[r]);
    if (refused.count < enough || refused.landmarks.size() < enough_landmarks) continue;
    warnings.push_back(
        sentence("robot %d: from %.1f to %.1f s all of its %zu sightings of %zu landmarks were refused: it slipped, "
                 "turned or was moved unnoticed, or they were",
                 number_of(task, static_cast<int>(r)), core::seconds(refused.from_ns), core::seconds(refused.to_ns),
                 refused.count, refused.landmarks.size()));
  }
}

/// Innovations larger than assumed, by chance for one robot in 10 000.
void warn_of_innovations(const TeamTask& task, const TeamDrive& drive, Sentences& warnings) {
  constexpr double sigmas = 3.7, least_ratio = 1.1;
  for (std::size_t r = 0; r < drive.robots.size(); ++r) {
    double nis = 0.0, dof = 0.0;
    for (const core::StepReport& step : drive.robots[r].steps) {
      nis += step.joint_nis;
      dof += step.joint_dof;
    }
    if (dof <= 0.0 || nis < least_ratio * dof || nis < dof + sigmas * std::sqrt(2.0 * dof)) continue;
    warnings.push_back(sentence(
        "robot %d: its sightings are farther from where they are expected than the assumed noise explains (mean "
        "NIS %.2f per degree of freedom, %.0f of them): its noise is larger, or its speed or its turns are off by "
        "a constant. Its pose is less certain than stated",
        number_of(task, static_cast<int>(r)), nis / dof, dof));
  }
}

/// Of joins that were taken back, and of which nothing took the place.
void warn_of_joins_taken_back(const TeamTask& task, const TeamDrive& drive, Sentences& warnings) {
  std::set<std::pair<int, int>> told;
  for (const team::TakenBackJoin& one : drive.team.joins_taken_back()) {
    const auto component = [&](int robot) { return drive.robots[static_cast<std::size_t>(robot)].component; };
    const std::pair<int, int> pair = std::minmax(one.join.robot, one.join.other);
    if (one.seen == 0 || component(pair.first) == component(pair.second) || !told.insert(pair).second) continue;
    warnings.push_back(
        sentence("robots %d and %d are in two frames: their join was taken back, since %d of the %d sightings between "
                 "the two sides afterwards contradict it. It was wrong, or robots were taken for others",
                 number_of(task, pair.first), number_of(task, pair.second), one.refused, one.seen));
  }
}

void warn_of_mapped_anew(const TeamTask& task, const TeamDrive& drive, Sentences& warnings) {
  for (std::size_t r = 0; r < drive.robots.size(); ++r) {
    const std::optional<MappedAnew> anew = mapped_anew(drive, r);
    if (!anew) continue;
    constexpr double percent = 100.0;
    warnings.push_back(sentence(
        "robot %d: from %.1f to %.1f s it missed %.0f %% of the landmarks it knew there, and %.0f %% of its "
        "sightings started new ones: it slipped unnoticed or matched wrongly. Its path since then is wrong, and "
        "landmarks are on the map twice",
        number_of(task, static_cast<int>(r)), core::seconds(anew->from_ns), core::seconds(anew->to_ns),
        percent * anew->missed, percent * anew->begun));
  }
}

void warn_of_names_in_two_frames(const TeamTask& task, const TeamDrive& drive, Sentences& warnings) {
  constexpr std::size_t enough = 4;
  std::set<int> components;
  for (const TeamDrive::Robot& robot : drive.robots) components.insert(robot.component);
  for (auto one = components.begin(); one != components.end(); ++one) {
    for (auto other = std::next(one); other != components.end(); ++other) {
      const std::size_t common = common_names(drive, *one, *other);
      if (common < enough) continue;
      warnings.push_back(
          sentence("robots %d and %d stay in two frames although they share %zu landmark names: the positions of the "
                   "landmarks contradict that they are the same, or are known too poorly",
                   number_of(task, *one), number_of(task, *other), common));
    }
  }
}

}  // namespace

std::vector<std::string> team_warnings(const TeamTask& task, const TeamDrive& drive) {
  Sentences warnings;
  warn_of_refused(task, drive, warnings);
  warn_of_all_refused(task, drive, warnings);
  warn_of_innovations(task, drive, warnings);
  warn_of_joins_taken_back(task, drive, warnings);
  if (task.known_association) {
    warn_of_names_in_two_frames(task, drive, warnings);
  } else {
    warn_of_mapped_anew(task, drive, warnings);
  }
  return warnings;
}

}  // namespace helixnav::apps
