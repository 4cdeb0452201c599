// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::cekf {

/// Landmarks passive now that began the phase in a cell closer to the point than reach_m.
std::vector<core::LandmarkId> CompressedEkf::passive_in_cells(const Eigen::Vector2d& point_m, double reach_m) const {
  const auto& by_cell = phases_.back().by_cell;
  const Eigen::Vector2i low = cell_of(point_m - Eigen::Vector2d::Constant(reach_m));
  const Eigen::Vector2i high = cell_of(point_m + Eigen::Vector2d::Constant(reach_m));
  std::vector<core::LandmarkId> ids;
  constexpr core::LandmarkId before_all = std::numeric_limits<core::LandmarkId>::min();
  auto entry = std::lower_bound(by_cell.begin(), by_cell.end(), std::pair(std::pair(low.x(), low.y()), before_all));
  while (entry != by_cell.end() && entry->first.first <= high.x()) {
    const auto [x, y] = entry->first;
    if (y < low.y() || y > high.y()) {  // on to the first cell of interest of this column, or of the next
      const std::pair<int, int> next = y < low.y() ? std::pair(x, low.y()) : std::pair(x + 1, low.y());
      entry = std::lower_bound(entry, by_cell.end(), std::pair(next, before_all));
      continue;
    }
    const Place* place = find_place(entry->second);
    if (place != nullptr && place->where == Whereabouts::passive) ids.push_back(entry->second);
    ++entry;
  }
  return ids;
}

std::vector<core::LandmarkId> CompressedEkf::landmarks_within(const Eigen::Vector2d& point_m, double radius_m) const {
  if (!point_m.allFinite() || !(radius_m >= 0.0)) {
    throw core::PreconditionError("landmarks_within: a finite point and a radius of zero or more expected");
  }
  std::vector<core::LandmarkId> found;
  for (double slack_m = 0.25 * options_.cell_side_m;;) {
    found.clear();
    std::vector<core::LandmarkId> passive = passive_in_cells(point_m, radius_m + slack_m);
    std::vector<int> slots;
    slots.reserve(passive.size());
    const auto is_far = [&](core::LandmarkId id) {
      const int slot = find_place(id)->index;
      const bool far = (phases_.back().mean_m.segment<2>(2 * slot) - point_m).norm() > radius_m + slack_m;
      if (!far) slots.push_back(slot);
      return far;
    };
    passive.erase(std::remove_if(passive.begin(), passive.end(), is_far), passive.end());
    const std::vector<Eigen::Vector2d> moved = moved_m(slots);
    double farthest_m = 0.0;
    for (std::size_t i = 0; i < passive.size(); ++i) {
      farthest_m = std::max(farthest_m, moved[i].norm());
      const Eigen::Vector2d mean_m = phases_.back().mean_m.segment<2>(2 * slots[i]) + moved[i];
      if ((mean_m - point_m).norm() <= radius_m) found.push_back(passive[i]);
    }
    if (farthest_m <= 0.5 * slack_m) break;
    slack_m = 3.0 * farthest_m;
  }
  for (std::size_t i = 0; i < active_.ids.size(); ++i) {
    if ((active_.points_m[i] - point_m).norm() <= radius_m) found.push_back(active_.ids[i]);
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace helixnav::cekf
