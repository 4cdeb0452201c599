// SPDX-License-Identifier: BSD-3-Clause
#include "run_interpolation.hpp"

#include <algorithm>

#include "helixnav/core/interpolate.hpp"

namespace helixnav::evaluation {

std::optional<core::PoseGaussian> estimate_at(const std::vector<core::StepReport>& steps, core::Nanoseconds t_ns) {
  const auto after = std::upper_bound(steps.begin(), steps.end(), t_ns,
                                      [](core::Nanoseconds t, const core::StepReport& step) { return t < step.t_ns; });
  if (after == steps.begin()) return std::nullopt;
  const core::StepReport& before = *(after - 1);
  if (before.t_ns == t_ns) return before.pose;
  if (after == steps.end()) return std::nullopt;
  const double fraction = static_cast<double>(t_ns - before.t_ns) / static_cast<double>(after->t_ns - before.t_ns);
  return core::PoseGaussian{core::interpolate(before.pose.mean, after->pose.mean, fraction), before.pose.covariance};
}

}  // namespace helixnav::evaluation
