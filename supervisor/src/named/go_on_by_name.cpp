// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include "helixnav/core/errors.hpp"
#include "helixnav/supervisor/joint_map.hpp"
#include "helixnav/supervisor/lengths.hpp"
#include "helixnav/supervisor/named_navigator.hpp"
#include "named/named_drive.hpp"

namespace helixnav::supervisor {

NamedNavigator::NamedNavigator(const core::JointMap& earlier,
                               const std::map<std::int64_t, core::LandmarkId>& landmark_of,
                               const NavigatorOptions& options)
    : options_(options),
      reach_m_(reference_reach_m),
      filter_(earlier.joint, earlier.next_name, options.filter),
      delayed_(options.delayed),
      landmark_of_identity_(landmark_of),
      drive_(NamedDrive({}, 0)) {
  check_has_end(earlier);
  for (const auto& [identity, id] : landmark_of) {
    if (filter_.contains(id)) continue;
    throw core::PreconditionError("named navigator: the map has no landmark " + std::to_string(id));
  }
  for (std::size_t i = 0; i < earlier.joint.ids.size(); ++i) {
    observations_[earlier.joint.ids[i]] = earlier.observations.at(i);
  }
}

}  // namespace helixnav::supervisor
