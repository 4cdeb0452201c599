// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "smoothing/drive_map.hpp"
#include "smoothing/smooth_drive.hpp"

namespace helixnav::supervisor {

/// As smooth_drive, but on the atlas: `map` takes in the tape and is settled; what was solved before is not solved again. `solved`
/// is left to the caller, who knows which landmarks the filter is to hold: `accepted` says whether it may.
/// Cost: the phases that the closing turned and their paths to the root. Errors: core::NumericalError, with `map` to be
/// thrown away. Test: supervisor/smoothing/drive_map_test.cpp.
struct AtlasSolution {
  Smoothing figures;
  bool accepted = false;
};
AtlasSolution solve_on_atlas(const cekf::CompressedEkf& filter, const Tape& tape, DriveMap& map);

}  // namespace helixnav::supervisor
