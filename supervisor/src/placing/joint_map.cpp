// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/joint_map.hpp"

namespace helixnav::supervisor {

core::JointMap joint_map(const cekf::CompressedEkf& filter, const std::vector<core::MapLandmark>& landmarks) {
  core::JointMap map;
  std::vector<core::LandmarkId> ids;
  for (const core::MapLandmark& landmark : landmarks) {
    ids.push_back(landmark.id);
    map.states.push_back(landmark.state);
    map.observations.push_back(landmark.observations);
  }
  map.joint = filter.joint(ids);
  map.next_name = filter.next_name();
  return map;
}

}  // namespace helixnav::supervisor
