// SPDX-License-Identifier: BSD-3-Clause
#include "estimate_range_scale.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <variant>

#include "common/navigator_feed.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/event_loop.hpp"

namespace helixnav::apps {
namespace {

/// Infinite when the filter broke on the way.
double mean_nis(core::Recording recording, double scale, const supervisor::NavigatorOptions& options) {
  divide_ranges(recording, scale);
  supervisor::Navigator navigator(recording.start, options);
  NavigatorFeed feed(navigator, recording.labels);
  core::EventLoop loop(recording.events, feed);
  double nis = 0.0;
  int rows = 0;
  try {
    while (const std::optional<core::StepReport> report = loop.next()) {
      nis += report->joint_nis;
      rows += report->joint_dof;
    }
  } catch (const core::NumericalError&) {
    rows = 0;
  }
  return rows > 0 ? nis / rows : std::numeric_limits<double>::infinity();
}

}  // namespace

void divide_ranges(core::Recording& recording, double scale) {
  for (core::Event& event : recording.events) {
    auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    for (core::Observation& observation : scan->observations) {
      if (observation.kind == core::ObservationKind::range) observation.z[0] /= scale;
    }
  }
}

double estimate_range_scale(const core::Recording& recording, const supervisor::NavigatorOptions& options) {
  const auto cost = [&](double scale) { return mean_nis(recording, scale, options); };
  constexpr double step = 0.02;
  double best = 1.0;
  double best_cost = std::numeric_limits<double>::infinity();
  for (int i = -5; i <= 10; ++i) {
    const double now = cost(1.0 + step * i);
    if (now < best_cost) {
      best = 1.0 + step * i;
      best_cost = now;
    }
  }
  const double golden = (std::sqrt(5.0) - 1.0) / 2.0;
  double low = best - step;
  double high = best + step;
  double a = high - golden * (high - low);
  double b = low + golden * (high - low);
  double cost_a = cost(a);
  double cost_b = cost(b);
  while (high - low > 5e-4) {
    if (cost_a < cost_b) {
      high = b;
      b = a;
      cost_b = cost_a;
      a = high - golden * (high - low);
      cost_a = cost(a);
    } else {
      low = a;
      a = b;
      cost_a = cost_b;
      b = low + golden * (high - low);
      cost_b = cost(b);
    }
  }
  return (low + high) / 2.0;
}

}  // namespace helixnav::apps
