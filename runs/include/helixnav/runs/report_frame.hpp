// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "helixnav/runs/run.hpp"

namespace helixnav::runs {

/// Which frame the covariance of a step's pose refers to. A session that looks for its place on an earlier map, and
/// each part of a drive after the vehicle was carried, reports its steps in a frame of its own, which starts with it.
/// The means of Run::steps have since been brought into the map frame if its relation to that is known; the covariances
/// are as known at the time.
struct ReportFrame {
  std::size_t begin = 0;  ///< the first step that was reported in the same frame
  bool is_own = false;    ///< not the frame of the run's truth
  bool is_placed = true;  ///< the mean is in the frame of the run's truth
  bool is_moved = false;  ///< reported in the frame of the truth, and moved within it since: at the time it was wrong
  double moved_m = 0.0;   ///< how far, if so
};

/// [step] Test: evaluation/evaluation_test.cpp.
std::vector<ReportFrame> report_frames(const Run& run);

}  // namespace helixnav::runs
