// SPDX-License-Identifier: BSD-3-Clause
#include "search/trigger.hpp"

#include <cmath>

#include "helixnav/core/angle.hpp"

namespace helixnav::supervisor {

std::optional<core::TriggerDecision> find_trigger(const GatedScan& scan, const core::PoseGaussian& pose,
                                                  const SearchOptions& options) {
  const RevisitAmbiguity* worst = most_ambiguous(scan.returns);
  if (worst == nullptr || worst->expected_confusers <= options.expected_confusers) return std::nullopt;
  if (fixes_pose(scan.place, options)) return std::nullopt;
  core::TriggerDecision trigger;
  trigger.landmark = worst->landmark;
  trigger.expected_confusers = worst->expected_confusers;
  trigger.neighbours = worst->neighbours;
  trigger.gate_area = worst->gate_area;
  trigger.pose_sigma_m = std::sqrt(pose.covariance.topLeftCorner<2, 2>().trace());
  trigger.heading_sigma_deg = std::sqrt(pose.covariance(2, 2)) * 180.0 / core::pi;
  trigger.old_in_gate = static_cast<int>(scan.returns.size());
  return trigger;
}

}  // namespace helixnav::supervisor
