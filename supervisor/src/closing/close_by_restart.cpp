// SPDX-License-Identifier: BSD-3-Clause
#include "closing/close_by_restart.hpp"

namespace helixnav::supervisor {

Closing close_by_restart(cekf::CompressedEkf& filter, const std::vector<core::LandmarkId>& branch,
                         const core::PoseGaussian& particles) {
  Closing closing;
  closing.accepted = true;
  for (const core::LandmarkId id : branch) filter.remove(id);
  closing.forgotten = branch;
  filter.replace_pose(particles);
  return closing;
}

}  // namespace helixnav::supervisor
