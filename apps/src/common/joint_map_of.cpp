// SPDX-License-Identifier: BSD-3-Clause
#include "joint_map_of.hpp"

#include <vector>

#include "helixnav/logs/field_of_view.hpp"
#include "helixnav/runs/joint_map_file.hpp"
#include "helixnav/supervisor/joint_map.hpp"

namespace helixnav::apps {

std::optional<core::JointMap> joint_map_of(const ChosenNavigator& navigator, const core::Recording& recording) {
  return joint_map_of(navigator.filter(), navigator.map(), logs::field_of_view_of(recording).reach().value_or(0.0));
}

std::optional<core::JointMap> joint_map_of(const cekf::CompressedEkf& filter,
                                           const std::vector<core::MapLandmark>& landmarks, double reach_m) {
  if (landmarks.size() > runs::most_joint_landmarks) return std::nullopt;
  core::JointMap map = supervisor::joint_map(filter, landmarks);
  map.reach_m = reach_m;
  return map;
}

}  // namespace helixnav::apps
