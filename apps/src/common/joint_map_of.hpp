// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "chosen_navigator.hpp"
#include "helixnav/core/joint_map.hpp"
#include "helixnav/core/recording.hpp"

namespace helixnav::apps {

/// What the drive leaves to the next session; nothing where it is too large to be saved.
std::optional<core::JointMap> joint_map_of(const ChosenNavigator& navigator, const core::Recording& recording);

}  // namespace helixnav::apps
