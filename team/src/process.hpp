// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "helixnav/core/events.hpp"
#include "helixnav/core/robot_sighting.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/team/team_options.hpp"
#include "state.hpp"

namespace helixnav::team {

/// The observations of a robot with their names; without names: to be associated by place.
struct NamedScan {
  core::Scan scan;
  std::vector<std::int64_t> names;
};

/// Something that came in, by a robot.
struct Entry {
  std::size_t robot = 0;
  std::variant<core::Odometry, core::RobotSighting, NamedScan> what;

  core::Nanoseconds t_ns() const;
};

/// The order of processing: by time; at equal times motions, then sightings of robots, then scans; then by robot, then by
/// the robot seen.
bool before(const Entry& a, const Entry& b);

/// Robots at their starts.
State begin(const std::vector<std::optional<core::PoseGaussian>>& starts);

/// Processes one entry; returns the report of a scan.
std::optional<core::StepReport> process(const Entry& entry, const TeamOptions& options, State& state);

/// Drops landmarks without a name that were there at the last solution and have still been seen only once: mostly clutter,
/// and one look at a place that nothing else knows says nothing about anything else.
void drop_seen_once(State& state);

/// Forgets a landmark, all that was seen of it and the names that refer to it: it is begun anew with the next sighting.
void forget_named(core::LandmarkId id, State& state);

/// The robot's current pose as a pose of the graph, a new one unless it has not moved since the last.
std::size_t clone_now(std::size_t robot, State& state);

}  // namespace helixnav::team
