// SPDX-License-Identifier: BSD-3-Clause
#include "loop/judge_fix.hpp"

#include <cmath>

#include "helixnav/core/chi2.hpp"

namespace helixnav::supervisor {

core::FixDecision judge_fix(cekf::CompressedEkf& filter, const core::AbsoluteFix& fix, double probability) {
  core::FixDecision decision;
  decision.nis = filter.position_innovation(fix).nis;
  decision.gate = core::chi2_quantile(probability, 2);
  decision.accepted = decision.nis <= decision.gate;
  if (decision.accepted) filter.update_position(fix);
  decision.position_world_m = fix.position_world_m;
  decision.pose_sigma_m = std::sqrt(filter.pose().covariance.topLeftCorner<2, 2>().trace());
  return decision;
}

}  // namespace helixnav::supervisor
