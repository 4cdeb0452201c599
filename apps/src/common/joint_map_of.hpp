// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "chosen_navigator.hpp"
#include "helixnav/core/joint_map.hpp"
#include "helixnav/core/recording.hpp"
#include "helixnav/runs/joint_map_file.hpp"
#include "helixnav/supervisor/joint_map.hpp"

namespace helixnav::apps {

/// What the drive leaves to the next session; nothing if it is too large to be saved.
std::optional<core::JointMap> joint_map_of(const ChosenNavigator& navigator, const core::Recording& recording);

/// The same for a navigator of either kind; reach_m of the sensor, 0 if unknown. A large map has factors, and up to
/// runs::most_joint_landmarks a joint covariance as well.
template <class Navigator>
std::optional<core::JointMap> joint_map_of(const Navigator& navigator, double reach_m) {
  const std::vector<core::MapLandmark> landmarks = navigator.sketch();  // the joint estimate has places and covariances
  std::optional<core::JointMap> map = supervisor::map_to_go_on_in(navigator, landmarks, runs::most_joint_landmarks);
  if (map) map->reach_m = reach_m;
  return map;
}

}  // namespace helixnav::apps
