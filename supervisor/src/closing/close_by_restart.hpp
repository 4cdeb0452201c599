// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "closing/closing.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/gaussian.hpp"

namespace helixnav::supervisor {

/// The restart of hybrid_masson2003 §3, for comparison only: the branch is discarded and the vehicle is put where the
/// particle filter has it, independent of the map. What the branch mapped is lost, and the particles' covariance, which
/// leaves out the landmarks' common errors, is taken as it is. Always accepted. Test: supervisor/closing/replay_test.cpp.
Closing close_by_restart(cekf::CompressedEkf& filter, const std::vector<core::LandmarkId>& branch,
                         const core::PoseGaussian& particles);

}  // namespace helixnav::supervisor
