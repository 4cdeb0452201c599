// SPDX-License-Identifier: BSD-3-Clause
#include "run_interpolation.hpp"

#include <algorithm>
#include <cstddef>

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

core::Nanoseconds most_apart_ns(const std::vector<core::StepReport>& steps) {
  if (steps.size() < 2) return 0;
  std::vector<core::Nanoseconds> intervals;
  for (std::size_t k = 1; k < steps.size(); ++k) intervals.push_back(steps[k].t_ns - steps[k - 1].t_ns);
  const auto most = intervals.begin() + static_cast<std::ptrdiff_t>((intervals.size() - 1) * 9 / 10);
  std::nth_element(intervals.begin(), most, intervals.end());
  return 3 * *most;
}

bool is_in_gap(const std::vector<core::StepReport>& steps, core::Nanoseconds t_ns, core::Nanoseconds most_apart_ns) {
  const auto after = std::upper_bound(steps.begin(), steps.end(), t_ns,
                                      [](core::Nanoseconds t, const core::StepReport& step) { return t < step.t_ns; });
  if (after == steps.begin() || after == steps.end()) return false;
  const core::Nanoseconds before_ns = (after - 1)->t_ns;
  return before_ns != t_ns && after->t_ns - before_ns > most_apart_ns;
}

}  // namespace helixnav::evaluation
