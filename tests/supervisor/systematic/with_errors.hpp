// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <utility>
#include <variant>

#include "helixnav/core/recording.hpp"
#include "helixnav/supervisor/systematic_errors.hpp"

namespace helixnav::supervisor {

/// The recording, had its odometry and its sensor these errors.
inline core::Recording with_errors(core::Recording recording, const SystematicErrors& errors) {
  SystematicErrors opposite(SystematicErrors::Vector(-errors.vector()));
  opposite.too_long = 1.0 / (1.0 + errors.too_long) - 1.0;
  std::optional<core::Nanoseconds> moved_ns;
  for (core::Event& event : recording.events) {
    if (auto* odometry = std::get_if<core::Odometry>(&event)) {
      *odometry =
          without(opposite, *odometry, {core::seconds(odometry->t_ns - moved_ns.value_or(odometry->t_ns)), 0.0});
      moved_ns = odometry->t_ns;
    }
    if (auto* scan = std::get_if<core::Scan>(&event)) *scan = without(opposite, std::move(*scan));
  }
  return recording;
}

}  // namespace helixnav::supervisor
