// SPDX-License-Identifier: BSD-3-Clause
#include "session_views.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "helixnav/core/angle.hpp"

namespace helixnav::apps {
namespace {

constexpr double reach_in_rings = 10.0;

bool is_seen(const Look& look, core::LandmarkId id) {
  return std::binary_search(look.seen.begin(), look.seen.end(), id);
}

double detections_of(const std::vector<Look>& looks, core::LandmarkId id) {
  return static_cast<double>(
      std::count_if(looks.begin(), looks.end(), [id](const Look& look) { return is_seen(look, id); }));
}

/// Calls f(id, point) for the mature landmarks that the session saw itself: those of a map in which it went on may be gone.
template <class F>
void for_each_own(const core::JointMap& map, const std::vector<Look>& looks, F f) {
  for (std::size_t i = 0; i < map.joint.ids.size(); ++i) {
    const core::LandmarkId id = map.joint.ids[i];
    if (map.states[i] == core::LandmarkState::mature && detections_of(looks, id) > 0.0) f(id, map.joint.points_m[i]);
  }
}

}  // namespace

SessionViews::SessionViews(std::vector<Look> looks, const core::JointMap& map) : looks_(std::move(looks)) {
  measure_reach(map);
  count(map);
  fill_sparse_cells();
  measure_spread(map);
}

/// Beyond all but a hundredth of what was seen.
void SessionViews::measure_reach(const core::JointMap& map) {
  constexpr double nearly_all = 0.99;
  std::vector<double> ranges_m;
  for_each_own(map, looks_, [&](core::LandmarkId id, const Eigen::Vector2d& at_m) {
    for (const Look& look : looks_) {
      if (is_seen(look, id)) ranges_m.push_back((at_m - look.T_map_robot.position_m()).norm());
    }
  });
  if (ranges_m.empty()) return;
  const auto at = static_cast<std::ptrdiff_t>(nearly_all * static_cast<double>(ranges_m.size() - 1));
  std::nth_element(ranges_m.begin(), ranges_m.begin() + at, ranges_m.end());
  ring_m_ = ranges_m[static_cast<std::size_t>(at)] / reach_in_rings;
}

std::optional<std::size_t> SessionViews::cell(const core::Pose2& T_map_robot, const Eigen::Vector2d& at_map_m) const {
  const Eigen::Vector2d d = at_map_m - T_map_robot.position_m();
  const double range_m = d.norm();
  if (!(range_m < ring_m_ * static_cast<double>(rings))) return std::nullopt;
  const double bearing_rad = core::wrap_to_pi(std::atan2(d.y(), d.x()) - T_map_robot.heading_rad);
  const double turn = (bearing_rad + core::pi) / (2.0 * core::pi);
  const auto sector = static_cast<std::size_t>(turn * static_cast<double>(sectors)) % sectors;
  return static_cast<std::size_t>(range_m / ring_m_) * sectors + sector;
}

void SessionViews::count(const core::JointMap& map) {
  for_each_own(map, looks_, [&](core::LandmarkId id, const Eigen::Vector2d& at_m) {
    for (const Look& look : looks_) {
      const std::optional<std::size_t> here = cell(look.T_map_robot, at_m);
      if (!here) continue;
      cells_[*here].looks += 1.0;
      cells_[*here].detections += is_seen(look, id) ? 1.0 : 0.0;
    }
  });
}

/// In a sparse map, hardly any landmark passes through some of the cells: they are counted with those around them.
void SessionViews::fill_sparse_cells() {
  constexpr double enough_looks = 5.0;
  const std::array<Cell, rings* sectors> counted = cells_;
  for (std::size_t k = 0; k < counted.size(); ++k) {
    if (counted[k].looks >= enough_looks) continue;
    const std::size_t ring = k / sectors, sector = k % sectors;
    for (std::size_t r = ring == 0 ? 0 : ring - 1; r <= std::min(ring + 1, rings - 1); ++r) {
      for (std::size_t turn = sectors - 1; turn <= sectors + 1; ++turn) {
        const std::size_t other = r * sectors + (sector + turn) % sectors;
        if (other == k) continue;
        cells_[k].looks += counted[other].looks;
        cells_[k].detections += counted[other].detections;
      }
    }
  }
}

double SessionViews::expected(const Eigen::Vector2d& at_map_m) const {
  double sum = 0.0;
  for (const Look& look : looks_) {
    const std::optional<std::size_t> here = cell(look.T_map_robot, at_map_m);
    if (here && cells_[*here].looks > 0.0) sum += cells_[*here].detections / cells_[*here].looks;
  }
  return sum;
}

double SessionViews::detections(core::LandmarkId id) const { return detections_of(looks_, id); }

double SessionViews::surely_expected(const Eigen::Vector2d& at_map_m) const {
  constexpr int sides = 8;
  double least = expected(at_map_m);
  for (int k = 0; k < sides; ++k) {
    const double angle_rad = 2.0 * core::pi * k / sides;
    const Eigen::Vector2d beside_m = ring_m_ * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
    least = std::min(least, expected(at_map_m + beside_m));
  }
  return least;
}

/// What the numbers of detections differ by from those expected, beyond what chance makes of the same number. Landmarks of which many
/// are expected count most: at the edge of the view the differences are those of the cells.
void SessionViews::measure_spread(const core::JointMap& map) {
  double beyond_chance = 0.0, squares = 0.0;
  for_each_own(map, looks_, [&](core::LandmarkId id, const Eigen::Vector2d& at_m) {
    const double should = expected(at_m);
    const double off = detections_of(looks_, id) - should;
    beyond_chance += off * off - should;
    squares += should * should;
  });
  if (squares > 0.0) spread_ = std::max(0.0, beyond_chance / squares);
}

double SessionViews::missed_by_chance(double expected_detections) const {
  constexpr int needed = 3;              // of a mature landmark, association::LifeOptions::mature_looks
  constexpr double hardly_any = 1.0e-3;  // as good as Poisson
  const double shape = 1.0 / std::max(spread_, hardly_any);
  const double share = expected_detections / (expected_detections + shape);
  double term = std::pow(1.0 - share, shape);
  double sum = 0.0;
  for (int n = 0; n < needed; ++n) {
    sum += term;
    term *= share * (n + shape) / (n + 1.0);
  }
  return std::min(1.0, sum);
}

}  // namespace helixnav::apps
