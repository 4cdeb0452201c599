// SPDX-License-Identifier: BSD-3-Clause
#include "smoothing/standing_looks.hpp"

#include <algorithm>
#include <cmath>

namespace helixnav::supervisor {

void StandingLooks::thin(std::vector<Stop>& stops) {
  for (Stop& stop : stops) {
    if (stop.motion) move(stop.motion->T_before_after);
    if (&stop != &stops.back()) thin(stop);
  }
}

void StandingLooks::move(const core::Pose2& T_before_after) {
  constexpr double place_rad = 0.02;
  T_place_here_ = core::compose(T_place_here_, T_before_after);
  if (T_place_here_.position_m().norm() <= place_m_ && std::abs(T_place_here_.heading_rad) <= place_rad) return;
  T_place_here_ = core::Pose2();
  looks_.clear();
}

void StandingLooks::thin(Stop& stop) {
  constexpr int most_looks = 64;
  const std::size_t before = stop.seen.size();
  const auto is_enough = [&](const cekf::Match& match) { return ++looks_[match.landmark] > most_looks; };
  stop.seen.erase(std::remove_if(stop.seen.begin(), stop.seen.end(), is_enough), stop.seen.end());
  stop.repeats = before > 0 && stop.seen.empty() && !stop.fix;
}

}  // namespace helixnav::supervisor
