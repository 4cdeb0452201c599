// SPDX-License-Identifier: BSD-3-Clause
#include "joint_map_of.hpp"

#include "helixnav/logs/field_of_view.hpp"

namespace helixnav::apps {

std::optional<core::JointMap> joint_map_of(const ChosenNavigator& navigator, const core::Recording& recording) {
  return joint_map_of(navigator, logs::field_of_view_of(recording).reach().value_or(0.0));
}

}  // namespace helixnav::apps
