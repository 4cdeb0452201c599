// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "smoothing/drive_map.hpp"
#include "smoothing/smooth_drive.hpp"

namespace helixnav::supervisor {

/// The same as smooth_drive by the atlas: `map` takes in the tape and is settled; what was solved before is not solved again. The
/// filter is the joint estimate of the pose and of all landmarks that `filter` has. Cost: the phases that the closing turned,
/// and N² times the largest separator of the map. Errors: core::NumericalError, with `map` to be thrown away.
/// Test: supervisor/drive_map_test.cpp.
Smoothing solve_on_atlas(const cekf::CompressedEkf& filter, const Tape& tape, DriveMap& map);

}  // namespace helixnav::supervisor
