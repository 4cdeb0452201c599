// SPDX-License-Identifier: BSD-3-Clause
#include "scans_apart.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "helixnav/reports/decision_sentence.hpp"

namespace helixnav::reports {
namespace {

/// Sorts `values`, of which there is one at least.
double quantile_of(std::vector<double>& values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// Between scans of which the vehicle moved at all.
std::vector<double> ways_between(const runs::Run& run) {
  constexpr double standing_m = 1e-2;
  std::vector<double> ways_m;
  for (std::size_t k = 1; k < run.steps.size(); ++k) {
    const double way_m = (run.steps[k].pose.mean.position_m() - run.steps[k - 1].pose.mean.position_m()).norm();
    if (way_m > standing_m) ways_m.push_back(way_m);
  }
  return ways_m;
}

std::vector<double> seen_ahead(const runs::Run& run) {
  std::vector<double> ahead_m;
  for (const auto& scan : run.scans) {
    for (const Eigen::Vector2f& point : scan) {
      if (std::isfinite(point.x())) ahead_m.push_back(static_cast<double>(point.x()));
    }
  }
  return ahead_m;
}

}  // namespace

std::string scans_apart_text(const runs::Run& run) {
  std::vector<double> ways_m = ways_between(run), ahead_m = seen_ahead(run);
  if (ways_m.empty() || ahead_m.empty()) return {};
  constexpr double few = 0.05, half = 0.5, twice = 2.0;
  const double between_m = quantile_of(ways_m, half);
  const double shown_m = quantile_of(ahead_m, 1.0 - few) - quantile_of(ahead_m, few);
  if (shown_m > twice * between_m) return {};
  return "scans are " + short_number(between_m) + " m apart and show landmarks along " + short_number(shown_m) +
         " m of the path: most landmarks are in view of two scans at most, too few to match them. Record scans more "
         "often, or drive more slowly";
}

}  // namespace helixnav::reports
