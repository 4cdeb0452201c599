// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/recording.hpp"

namespace helixnav::logs {

/// Contents of the files of one run, in either form. Subjects: robots 1 to 5, landmarks from 6, 0 nobody.
struct MrclamTables {
  struct Command {
    core::Nanoseconds t_ns = 0;
    double speed_mps = 0.0;
    double turn_rad_per_s = 0.0;
  };
  struct Sighting {
    core::Nanoseconds t_ns = 0;
    int subject = 0;
    double range_m = 0.0;
    double bearing_rad = 0.0;
  };
  struct Robot {
    std::vector<Command> commands;    ///< in time order
    std::vector<Sighting> sightings;  ///< in time order
    std::vector<core::TruePose> truth;
    std::string
        file;         ///< that its commands stand in, with the line of the first in a table of all robots; for messages
    int swapped = 0;  ///< commands that came after a later one
  };
  std::map<int, Robot> robots;
  std::vector<core::TrueLandmark> landmarks;
  std::vector<std::string> remarks;  ///< what was left out, one sentence each
};

inline constexpr int most_robots = 5;
inline constexpr int nobody = 0;
constexpr bool is_robot(int subject) { return subject >= 1 && subject <= most_robots; }

MrclamTables read_mrclam_csv(const std::filesystem::path& folder);
MrclamTables read_mrclam_dat(const std::filesystem::path& folder_or_archive);

/// The file of that name, or of that name with .gz; empty when neither exists.
std::filesystem::path plain_or_packed(const std::filesystem::path& folder, const std::string& name);

}  // namespace helixnav::logs
