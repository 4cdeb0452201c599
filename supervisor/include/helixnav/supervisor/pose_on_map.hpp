// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/landmark_id.hpp"

namespace helixnav::supervisor {

/// The pose with its covariance relative to the nearest dozen landmarks of an earlier map, those with a name below
/// `next_name` of it: without the errors that they share, of which the frame of the map is the largest. The pose as it is
/// if the filter holds fewer than two of them. O(landmarks held). Test: supervisor/placing/begun_at_test.cpp.
core::PoseGaussian pose_on_map(const cekf::CompressedEkf& filter, core::LandmarkId next_name);

}  // namespace helixnav::supervisor
