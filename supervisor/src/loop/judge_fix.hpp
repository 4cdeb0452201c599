// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/decision.hpp"

namespace helixnav::supervisor {

/// Updates the pose with the fix if its NIS passes the χ² gate of this probability, and reports the decision either way.
/// Test: supervisor/absolute_fix_test.cpp.
core::FixDecision judge_fix(cekf::CompressedEkf& filter, const core::AbsoluteFix& fix, double probability);

}  // namespace helixnav::supervisor
