// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "helixnav/runs/run.hpp"

namespace helixnav::reports {

/// One slip: the consecutive scans at which it was decided, with at most two others between them.
struct SlipSpan {
  std::size_t first = 0, last = 0;  ///< indices of steps
  int scans = 0;
  double moved_m = 0.0;  ///< over all of them together
};

/// All slips of the run, in order. Wheels that spin for seconds are decided scan by scan, and are one slip. Test:
/// reports/slip_spans_test.cpp.
std::vector<SlipSpan> slip_spans(const runs::Run& run);

/// "from 300.2 to 302 s"; "at 300.2 s" for a single scan.
std::string when_slipped(const runs::Run& run, const SlipSpan& slip);

/// A paragraph for `explain`, with a line for each of the first; empty if the vehicle did not slip.
std::string slips_text(const runs::Run& run);

}  // namespace helixnav::reports
