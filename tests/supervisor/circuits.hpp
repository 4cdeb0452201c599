// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <variant>

#include <Eigen/Cholesky>

#include "helixnav/core/angle.hpp"
#include "helixnav/sim/simulate.hpp"
#include "helixnav/supervisor/navigator.hpp"
#include "wide_circuit.hpp"

namespace helixnav::supervisor {

using sim::wide_circuit;

/// Feeds the recording; `on_scan(scan, index)` observes it.
template <class AnyNavigator>
void drive(const core::Recording& run, AnyNavigator& navigator,
           const std::function<void(const core::Scan&, std::size_t)>& on_scan) {
  std::size_t scans = 0;
  for (const core::Event& event : run.events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) navigator.move(*odometry);
    if (const auto* scan = std::get_if<core::Scan>(&event)) on_scan(*scan, scans++);
  }
}

/// eᵀP⁻¹e of (x, y, heading).
inline double nees(const core::PoseGaussian& estimate, const core::Pose2& truth) {
  Eigen::Vector3d error = estimate.mean.vector() - truth.vector();
  error[2] = core::wrap_to_pi(error[2]);
  return error.dot(estimate.covariance.ldlt().solve(error));
}

}  // namespace helixnav::supervisor
