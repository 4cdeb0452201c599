// SPDX-License-Identifier: BSD-3-Clause
#include "team/team_warnings.hpp"

#include <cstdio>

namespace helixnav::apps {
namespace {

struct Refused {
  std::size_t seen = 0, refused = 0;
};

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

template <class... Values>
std::string sentence(const char* format, Values... values) {
  char text[300];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

}  // namespace

std::vector<std::string> team_warnings(const TeamTask& task, const TeamDrive& drive) {
  constexpr std::size_t enough = 50;
  constexpr std::size_t one_in = 5;
  std::vector<std::string> warnings;
  for (std::size_t r = 0; r < drive.robots.size(); ++r) {
    const core::TeamMember& member = task.recording.robots[r];
    const Refused count = refused_of(drive, r);
    if (count.seen >= enough && one_in * count.refused > count.seen) {
      warnings.push_back(sentence(
          "robot %d: %zu of its %zu sightings of landmarks and robots were refused: its odometry, its clock or "
          "barcodes are wrong, or what it knows of where it is",
          member.number, count.refused, count.seen));
    }
  }
  return warnings;
}

}  // namespace helixnav::apps
