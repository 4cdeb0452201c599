// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "helixnav/core/joint_map.hpp"
#include "session_views.hpp"

namespace helixnav::apps {

/// The looks of the run in a folder, in the frame of its map. Nothing for a folder without a drive, such as that of joined runs, or
/// whose drive left parts on maps of their own.
std::optional<SessionViews> views_in(const std::string& folder, const core::JointMap& map);

}  // namespace helixnav::apps
