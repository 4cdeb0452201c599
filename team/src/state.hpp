// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "helixnav/core/events.hpp"
#include "helixnav/core/odometry.hpp"
#include "helixnav/core/robot_sighting.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/team/robot_slip.hpp"
#include "helixnav/team/same_landmarks.hpp"
#include "helixnav/team/team_join.hpp"
#include "joint_filter.hpp"
#include "moved_landmark.hpp"

namespace helixnav::team {

/// A pose of a robot in the graph.
struct Clone {
  core::Nanoseconds t_ns = 0;
  core::Pose2 T_component_robot;
  core::Odometry motion;  ///< from the clone before
};

/// A robot: poses of the graph, and the motion since the last.
struct Robot {
  std::optional<core::PoseGaussian> start;  ///< in the common frame, if known
  std::vector<Clone> clones;
  core::Odometry since = core::no_motion(0);
  std::size_t component = 0;
  std::size_t slot = 0;  ///< in the filter of the component
  std::int64_t scans = 0;
  SightingCounts named;  ///< of landmarks by name
};

/// A landmark seen from a clone.
struct LandmarkRow {
  std::size_t robot = 0;
  std::size_t clone = 0;
  core::LandmarkId landmark = core::no_landmark;
  core::Pose2 T_clone_sensor;
  core::Observation observation;
  std::int64_t scan = 0;  ///< of the robot
};

/// What began a landmark: unaffected by late arrivals, so that a decision on it can be undone.
struct Birth {
  std::size_t robot = 0;
  core::Nanoseconds t_ns = 0;
  int observation = 0;
  bool named = false;
};

/// A robot seen from a clone of another.
struct SightingRow {
  enum class Use { used, apart, refused };
  std::size_t robot = 0, clone = 0;
  std::size_t seen = 0, seen_clone = 0;
  core::Nanoseconds t_ns = 0;
  core::Pose2 T_robot_sensor;
  core::Observation observation;
  Use use = Use::apart;       ///< apart: between two components
  double nis = 0.0;           ///< of the innovation, if it was in one component
  bool fits_another = false;  ///< refused, and accepted if the robot seen were another one of the component
};

/// A sighting identified independently of late arrivals: time, robot, robot seen.
using SightingKey = std::tuple<core::Nanoseconds, std::size_t, std::size_t>;
inline SightingKey key_of(const SightingRow& row) { return {row.t_ns, row.robot, row.seen}; }

/// Robots in one frame, that of the first of them or the one where starts are known.
struct Component {
  std::vector<std::size_t> robots;  ///< empty: joined into another
  JointFilter filter;
  double chi2 = 0.0;  ///< of the graph at the last solution
  bool news = false;  ///< since then
};

/// Two components became one.
struct JoinEvidence {
  std::vector<std::size_t> into, from;  ///< robots of either
  std::vector<std::size_t> sightings;   ///< rows that it rests on
  std::size_t rows_before = 0;          ///< sightings until then
};

/// Everything that follows from the events so far. A value: a copy is a checkpoint.
struct State {
  core::Nanoseconds begin_ns = 0;
  std::optional<core::Nanoseconds> next_solve_ns;
  std::vector<Robot> robots;
  std::vector<Component> components;
  std::vector<LandmarkRow> landmark_rows;
  std::vector<SightingRow> sighting_rows;
  std::map<std::pair<std::size_t, std::int64_t>, core::LandmarkId> id_of_name;  ///< by (robot, name)
  std::vector<core::LandmarkId> merged_into;                                    ///< [id] itself, or the one it became
  std::vector<int> observations;                                                ///< [id]
  std::vector<int> refusals;                                                    ///< [id] sightings by name
  std::vector<MovedLandmark> moved;                                             ///< [id] likewise
  std::vector<Birth> births;                                                    ///< [id]
  std::size_t born_before_solution = 0;                                         ///< landmarks, by id
  double reach_m = 0.0;                                                         ///< farthest landmark seen
  double widest_rad = 0.0;  ///< largest bearing of a landmark seen, to either side
  std::vector<TeamJoin> joins;
  std::vector<JoinEvidence> evidence;  ///< [join]
  bool news_of_joins = false;          ///< a sighting was refused since it was asked whether a join is wrong
  std::vector<SameLandmarks> same;
  std::vector<RobotSlip> slips;
  std::map<std::pair<std::size_t, std::size_t>, int>
      observations_asked;                                   ///< at the last question, by pair of components
  std::vector<std::pair<std::size_t, std::size_t>> placed;  ///< (robot, join) not yet reported
  std::vector<core::MergedLandmarks> merged;                ///< not yet reported

  Component& of(std::size_t robot) { return components[robots[robot].component]; }
  core::LandmarkId resolve(core::LandmarkId id) const {
    while (merged_into[static_cast<std::size_t>(id)] != id) id = merged_into[static_cast<std::size_t>(id)];
    return id;
  }
};

}  // namespace helixnav::team
