// SPDX-License-Identifier: BSD-3-Clause
#include "taken_out.hpp"

#include <utility>
#include <variant>

namespace helixnav::apps {

supervisor::SystematicErrors taken_out_of(const runs::Run& run) {
  supervisor::SystematicErrors errors;
  for (const core::StepReport& step : run.steps) {
    for (const core::Decision& decision : step.decisions) {
      const auto* d = std::get_if<core::SystematicDecision>(&decision);
      if (d == nullptr) continue;
      errors.too_long = d->too_long;
      errors.turn_rad_per_s = d->turn_rad_per_s;
      errors.turn_rad_per_m = d->turn_rad_per_m;
      errors.heading_rad = d->heading_rad;
      errors.short_m = d->short_m;
    }
  }
  return errors;
}

core::Recording without_taken_out(const runs::Run& run, core::Recording recording) {
  const supervisor::SystematicErrors errors = taken_out_of(run);
  if (errors.are_zero()) return recording;
  supervisor::OdometryRhythm rhythm;
  for (core::Event& event : recording.events) {
    if (auto* odometry = std::get_if<core::Odometry>(&event)) {
      *odometry = supervisor::without(errors, *odometry, rhythm.until(odometry->t_ns));
    }
    if (std::holds_alternative<core::Lost>(event)) rhythm.lose_last();  // as the navigator does
    if (auto* scan = std::get_if<core::Scan>(&event)) *scan = supervisor::without(errors, std::move(*scan));
  }
  return recording;
}

}  // namespace helixnav::apps
