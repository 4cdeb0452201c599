// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/decision.hpp"
#include "noise/fix_noise.hpp"

namespace helixnav::supervisor {

FixInnovation innovation_of(const core::PoseGaussian& pose, const core::AbsoluteFix& fix);

/// A fix as it is used with what is known of the noise of fixes.
struct WidenedFix {
  core::AbsoluteFix fix;  ///< its covariance widened
  double widened = 1.0;   ///< in units of the covariance it stated: in_update() of FixNoise
  double of_one = 1.0;    ///< likewise, of its own error
};
WidenedFix widened(const core::AbsoluteFix& fix, const FixNoise& noise);

/// Updates the pose with the fix if its NIS passes the χ² gate of this probability, and reports the decision either way. The
/// gate asks about the error of this one fix. Test: supervisor/absolute_fix_test.cpp.
core::FixDecision judge_fix(cekf::CompressedEkf& filter, const WidenedFix& fix, double probability);

}  // namespace helixnav::supervisor
