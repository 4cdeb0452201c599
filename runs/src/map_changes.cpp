// SPDX-License-Identifier: BSD-3-Clause
#include "map_changes.hpp"

#include <algorithm>
#include <cmath>

namespace helixnav::runs {
namespace {

constexpr double visible_growth = 1.25;  ///< of σ

double sigma_m(const core::MapLandmark& landmark) { return std::sqrt(landmark.point.covariance_m2.trace()); }

bool looks_other(const core::MapLandmark& a, const core::MapLandmark& b, double visible_m) {
  if (a.state != b.state || (a.point.mean_m - b.point.mean_m).norm() > visible_m) return true;
  const double before_m = sigma_m(a);
  const double after_m = sigma_m(b);
  return std::abs(after_m - before_m) > visible_m &&
         std::max(before_m, after_m) > visible_growth * std::min(before_m, after_m);
}

/// If the map moves all the time, only larger moves are reported, or its history would be most of the report.
double visible_m(std::size_t told) {
  constexpr double least_m = 0.02;
  constexpr double doubles_after = 40'000.0;
  return least_m * std::exp2(static_cast<double>(told) / doubles_after);
}

}  // namespace

MapChanges::MapChanges(std::size_t scans) {
  constexpr std::size_t most = 400;
  every_ = std::max<std::int64_t>(every_, static_cast<std::int64_t>(scans / most));
}

bool MapChanges::wants(const core::StepReport& report) const {
  return report.step % every_ == 0 || !report.merged.empty() || !report.solved.empty();
}

MapChange MapChanges::since_last(std::int64_t step, const std::vector<core::MapLandmark>& map) {
  MapChange change;
  change.step = step;
  const double seen_m = visible_m(told_);
  std::vector<core::MapLandmark> next;
  next.reserve(map.size());
  auto before = shown_.begin();
  for (const core::MapLandmark& landmark : map) {
    if (landmark.state == core::LandmarkState::dead) continue;
    for (; before != shown_.end() && before->id < landmark.id; ++before) change.removed.push_back(before->id);
    const bool known = before != shown_.end() && before->id == landmark.id;
    const bool same = known && !looks_other(*before, landmark, seen_m);
    if (!same) change.changed.push_back(landmark);
    next.push_back(same ? *before : landmark);
    if (known) ++before;
  }
  for (; before != shown_.end(); ++before) change.removed.push_back(before->id);
  change.changed.shrink_to_fit();
  change.removed.shrink_to_fit();
  shown_ = std::move(next);
  told_ += change.changed.size();
  return change;
}

}  // namespace helixnav::runs
