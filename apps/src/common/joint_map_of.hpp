// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "chosen_navigator.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/joint_map.hpp"
#include "helixnav/core/recording.hpp"

namespace helixnav::apps {

/// What the drive leaves to the next session; nothing where it is too large to be saved.
std::optional<core::JointMap> joint_map_of(const ChosenNavigator& navigator, const core::Recording& recording);

/// The same of a filter and the landmarks of its navigator; reach_m of the sensor, 0 where it is unknown.
std::optional<core::JointMap> joint_map_of(const cekf::CompressedEkf& filter,
                                           const std::vector<core::MapLandmark>& landmarks, double reach_m);

}  // namespace helixnav::apps
