// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "closing/closing.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/gaussian.hpp"

namespace helixnav::supervisor {

/// The restart of hybrid_masson2003 §3, for comparison only: the branch is forgotten and the vehicle stands where the
/// particle filter says, independent of the map. What the branch learnt is lost, and the particles' covariance, which
/// leaves out what their landmarks have in common, is believed. Always accepted. Test: supervisor/replay_test.cpp.
Closing close_by_restart(cekf::CompressedEkf& filter, const std::vector<core::LandmarkId>& branch,
                         const core::PoseGaussian& particles);

}  // namespace helixnav::supervisor
