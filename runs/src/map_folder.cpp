// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/runs/map_folder.hpp"

#include <vector>

#include "helixnav/files/file.hpp"
#include "helixnav/runs/joint_map_file.hpp"
#include "tables/map_text.hpp"
#include "tables/run_tables.hpp"

namespace helixnav::runs {

std::vector<core::MapLandmark> landmarks_of(const core::JointMap& map) {
  std::vector<core::MapLandmark> landmarks(map.joint.ids.size());
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const auto row = 3 + 2 * static_cast<Eigen::Index>(i);
    landmarks[i].id = map.joint.ids[i];
    landmarks[i].point = {map.joint.points_m[i], map.joint.covariance.block<2, 2>(row, row)};
    landmarks[i].observations = map.observations[i];
    landmarks[i].state = map.states[i];
    if (!map.appearances.empty()) landmarks[i].appearance = map.appearances[i];
  }
  return landmarks;
}

void write_map(const std::string& folder, const core::JointMap& map) {
  const std::vector<core::MapLandmark> landmarks = landmarks_of(map);
  files::write_whole_file(folder + '/' + std::string(map_table.file), map_text(landmarks));
  if (landmarks.size() > most_joint_landmarks) return;
  files::write_whole_file(folder + '/' + joint_map_file, joint_map_bytes(map));
}

}  // namespace helixnav::runs
