// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/step_report.hpp"
#include "loop/tape.hpp"
#include "smoothing/drive_map.hpp"

namespace helixnav::supervisor {

/// The result of solving the drive as a whole.
struct Smoothing {
  bool accepted = false;
  std::vector<core::StampedPose> path;  ///< at the solution, of every scan and fix used; empty when not accepted
  double chi2 = 0.0;                    ///< least squares' cost at its solution
  double limit = 0.0;                   ///< what it must not exceed
  int poses = 0;                        ///< at the ends of the phases
  int iterations = 0;                   ///< fronts eliminated
};

/// Solves the whole drive with the associations known now: `map` takes in what the tape holds since it was last solved,
/// and is settled. After a closing that turned a part of the map by many degrees, the filter is linearised where that
/// part was drawn, and no retraction of its own undoes that (docs/adr/0010-solving-the-drive.md). Not accepted: a
/// solution that costs more than the filter's own and also exceeds, by more than the closing may cost, what it costs
/// solved without the closing at the end of the tape. Cost: the phases that the closing turned and their paths to the
/// root. Errors: core::NumericalError; `map` then has to be discarded. Test: supervisor/smoothing/smooth_drive_test.cpp
/// (least squares over all poses of the recording).
Smoothing smooth_drive(const cekf::CompressedEkf& filter, const Tape& tape, DriveMap& map);

/// The filter begun anew with the pose and the landmarks that it holds, as `map` has them: their joint estimate,
/// everything else eliminated. Landmarks keep their ids. Errors: core::NumericalError. Test: as smooth_drive.
cekf::CompressedEkf filter_at_solution(const DriveMap& map, const cekf::CompressedEkf& filter);

}  // namespace helixnav::supervisor
