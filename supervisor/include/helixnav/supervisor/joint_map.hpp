// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/joint_map.hpp"

namespace helixnav::supervisor {

/// What a session leaves to the next one: its landmarks, as its navigator's map() lists them, and its pose with all
/// correlations. O(N²).
core::JointMap joint_map(const cekf::CompressedEkf& filter, const std::vector<core::MapLandmark>& landmarks);
/// The same of any navigator that has joint() and filter().
core::JointMap joint_map(core::JointGaussian joint, core::LandmarkId next_name,
                         const std::vector<core::MapLandmark>& landmarks);
/// In the order of `landmarks`.
std::vector<core::LandmarkId> ids_of(const std::vector<core::MapLandmark>& landmarks);

}  // namespace helixnav::supervisor
