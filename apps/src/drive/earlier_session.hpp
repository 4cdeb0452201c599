// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "helixnav/core/joint_map.hpp"
#include "helixnav/core/recording.hpp"

namespace helixnav::apps {

/// Where a session begins on an earlier map.
struct SessionStart {
  enum class Kind {
    unknown,  ///< to be determined
    end,      ///< where the session that made the map ended, known as well as it was then
    pose,     ///< as given, on the map
  };
  Kind kind = Kind::unknown;
  core::Pose2 T_map_robot;  ///< for `pose`
};

/// "unknown", "end" or "x,y,heading" in metres and radians; for any other word `objection` reports what is wrong.
SessionStart session_start_from(const std::string& word, std::string& objection);

/// An earlier session to continue from.
struct EarlierSession {
  core::JointMap map;
  std::map<core::Label, core::LandmarkId> landmark_of;  ///< by label; empty when that run had no labels
  SessionStart start;
  std::vector<std::string> missing;           ///< of that run: lost since it was written
  std::optional<core::Nanoseconds> ended_ns;  ///< its last scan, if it has one
  std::optional<core::Pose2> T_truth_map;     ///< frame of its map in that of its truth, if that run knows
};

/// From the map itself, `name` in messages. InputError if it has too few mature landmarks to begin this way, or has no
/// end.
EarlierSession earlier_session(core::JointMap map, const SessionStart& start, const std::string& name);

/// Reads the folder of a completed run. InputError naming the file if there is no map.bin in it, it cannot be used, or it
/// holds too few mature landmarks to begin this way.
EarlierSession read_earlier_session(const std::string& folder, const SessionStart& start);

/// The map that a run left in its folder. InputError naming the file if there is none or it cannot be used.
core::JointMap read_joint_map_in(const std::string& folder);

/// The same with a joint covariance, for what needs one. InputError naming the file, and what needs it, if the map is too
/// large to have one.
core::JointMap read_dense_map_in(const std::string& folder, const std::string& what);
/// InputError likewise.
void check_has_covariance(const core::JointMap& map, const std::string& name, const std::string& what);

/// The map.bin in it.
std::string joint_map_file_in(const std::string& folder);

/// A pose on a map that the user gave: known to a 60th of the reach and 3°.
core::PoseGaussian given_start(const core::Pose2& T_map_robot, double reach_m);

}  // namespace helixnav::apps
