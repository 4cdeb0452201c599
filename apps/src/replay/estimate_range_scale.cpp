// SPDX-License-Identifier: BSD-3-Clause
#include "estimate_range_scale.hpp"

#include <limits>
#include <optional>
#include <variant>

#include <boost/math/tools/minima.hpp>

#include "common/chosen_navigator.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/event_loop.hpp"

namespace helixnav::apps {
namespace {

/// Infinite if the filter broke down on the way.
double mean_nis(core::Recording recording, double scale, const supervisor::NavigatorOptions& options) {
  divide_ranges(recording, scale);
  ChosenNavigator navigator(recording, options, true);
  core::EventLoop loop(recording.events, navigator);
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
  supervisor::NavigatorOptions believing = options;
  believing.names.wrong = 0.0;  // contradictions of a wrong scale are its cost, and must not be left out
  const auto cost = [&](double scale) { return mean_nis(recording, scale, believing); };
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
  constexpr int bits = 12;  // of the scale: 5e-4
  return boost::math::tools::brent_find_minima(cost, best - step, best + step, bits).first;
}

}  // namespace helixnav::apps
