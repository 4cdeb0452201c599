// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <set>
#include <string>

#include "helixnav/files/number_text.hpp"
#include "mrclam/mrclam_tables.hpp"
#include "plausible.hpp"
#include "text_cursor.hpp"

namespace helixnav::logs {

// The fields that both forms of the files share, in the same order.

/// Time since the log's own origin, or Unix time; exact, because a double of Unix time is not.
inline core::Nanoseconds read_time(TextCursor& cursor) {
  constexpr core::Nanoseconds most_ns = 4'000'000'000'000'000'000;
  const std::string_view word = cursor.word();
  const std::optional<core::Nanoseconds> t_ns = files::parse_seconds(word);
  if (!t_ns || *t_ns > most_ns || *t_ns < -most_ns) {
    cursor.fail("expected a time [s], found " + (word.empty() ? "none" : "'" + std::string(word) + "'"));
  }
  return *t_ns;
}

inline MrclamTables::Command read_command(TextCursor& cursor) {
  constexpr double most_mps = 100.0;
  constexpr double most_rad_per_s = 100.0;
  MrclamTables::Command command;
  command.t_ns = read_time(cursor);
  command.speed_mps = cursor.number_between(-most_mps, most_mps, "a speed [m/s]");
  command.turn_rad_per_s = cursor.number_between(-most_rad_per_s, most_rad_per_s, "a turn rate [rad/s]");
  return command;
}

inline void read_range_and_bearing(TextCursor& cursor, MrclamTables::Sighting& sighting) {
  constexpr double smallest_m = 1e-3;
  sighting.range_m = cursor.number_between(smallest_m, most_distance_m, "a range [m]");
  sighting.bearing_rad = cursor.number_between(-2.0 * core::pi, 2.0 * core::pi, "a bearing [rad]");
}

inline core::TruePose read_true_pose(TextCursor& cursor) {
  core::TruePose pose;
  pose.t_ns = read_time(cursor);
  const double x_m = cursor.number_between(-most_coordinate_m, most_coordinate_m, "x [m]");
  const double y_m = cursor.number_between(-most_coordinate_m, most_coordinate_m, "y [m]");
  pose.T_world_robot = core::Pose2(x_m, y_m, cursor.number_between(-1e3, 1e3, "a heading [rad]"));
  return pose;
}

inline core::TrueLandmark read_landmark(TextCursor& cursor) {
  core::TrueLandmark landmark;
  landmark.label = static_cast<core::Label>(cursor.number_between(most_robots + 1, 1e9, "the subject of a landmark"));
  landmark.point_m.x() = cursor.number_between(-most_coordinate_m, most_coordinate_m, "x [m]");
  landmark.point_m.y() = cursor.number_between(-most_coordinate_m, most_coordinate_m, "y [m]");
  cursor.number("sigma of x [m]");
  cursor.number("sigma of y [m]");
  return landmark;
}

/// What a sighting may be of: nobody, a robot, a landmark of the list (any, if there is no list).
class Subjects {
 public:
  explicit Subjects(const std::vector<core::TrueLandmark>& landmarks) {
    for (const core::TrueLandmark& landmark : landmarks) landmarks_.insert(landmark.label);
  }

  int read(TextCursor& cursor) const {
    const auto subject = static_cast<int>(cursor.number_between(0, 1e9, "the number of a subject"));
    if (subject > most_robots && !landmarks_.empty() && landmarks_.count(subject) == 0) {
      cursor.fail("subject " + std::to_string(subject) + " is neither a robot nor one of the landmarks");
    }
    return subject;
  }

 private:
  std::set<core::Label> landmarks_;
};

}  // namespace helixnav::logs
