// SPDX-License-Identifier: BSD-3-Clause
#include "scanner.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "in_view.hpp"

namespace helixnav::sim {
namespace {

bool contains(const Stretch& stretch, double along_m) { return stretch.from_m <= along_m && along_m < stretch.to_m; }

}  // namespace

Scanner::Scanner(const Scenario& scenario, const World& world, std::uint64_t seed)
    : world_(world),
      options_(scenario.scanner),
      grid_(world.trees, std::max(nearest_trees_m, scenario.scanner.field_of_view.max_range_m)),
      true_noise_(scenario.true_noise),
      assumed_noise_(scenario.assumed_noise),
      random_(seed, "sim.scanner"),
      looks_(scenario.scanner.looks, seed),
      movers_random_(seed, "sim.scanner.movers") {}

LabelledScan Scanner::look(const core::Pose2& T_world_robot, double along_m, core::Nanoseconds t_ns,
                           const std::vector<Eigen::Vector2d>& moving_m) {
  LabelledScan seen;
  seen.scan.t_ns = t_ns;
  seen.scan.T_robot_sensor = options_.T_robot_sensor;
  seen.scan.field_of_view = options_.field_of_view;
  if (world_.blackout && contains(*world_.blackout, along_m)) return seen;

  const core::Pose2 T_world_sensor = core::compose(T_world_robot, options_.T_robot_sensor);
  const std::vector<Sighting> visible = visible_trees(T_world_sensor, along_m);
  for (const Sighting& tree : visible) {
    if (occluded(tree, visible)) continue;
    if (random_.bernoulli(options_.detection_probability)) add(tree, random_, seen);
  }
  const int clutter = random_.poisson(options_.clutter_per_scan);
  for (int i = 0; i < clutter; ++i) add_clutter(seen);
  shuffle(seen);
  for (const Eigen::Vector2d& point_m : moving_m) add_mover(core::inverse(T_world_sensor), point_m, seen);
  return seen;
}

/// At a random place among the others.
void Scanner::add_mover(const core::Pose2& T_sensor_world, const Eigen::Vector2d& point_m, LabelledScan& into) {
  const Polar seen = polar(T_sensor_world, point_m);
  if (!contains(options_.field_of_view, seen) || !movers_random_.bernoulli(options_.detection_probability)) return;
  add({seen.range_m, seen.bearing_rad, core::no_label}, movers_random_, into);
  const auto at = static_cast<std::size_t>(movers_random_.below(into.labels.size()));
  std::swap(into.labels[at], into.labels.back());
  std::swap(into.scan.observations[at], into.scan.observations.back());
}

std::vector<Scanner::Sighting> Scanner::visible_trees(const core::Pose2& T_world_sensor, double along_m) const {
  std::vector<Sighting> visible;
  const core::Pose2 T_sensor_world = core::inverse(T_world_sensor);
  const double beyond_m2 = 1.01 * options_.field_of_view.max_range_m * options_.field_of_view.max_range_m;
  for (const std::size_t i : grid_.about(T_world_sensor.position_m(), std::sqrt(beyond_m2))) {
    const Eigen::Vector2d away_m = world_.trees[i].point_m - T_world_sensor.position_m();
    if (away_m.squaredNorm() > beyond_m2 || !contains(world_.trees[i].present, along_m)) continue;
    const Polar seen = polar(T_sensor_world, world_.trees[i].point_m);
    if (!contains(options_.field_of_view, seen)) continue;
    visible.push_back({seen.range_m, seen.bearing_rad, static_cast<core::Label>(i)});
  }
  std::sort(visible.begin(), visible.end(), [](const Sighting& a, const Sighting& b) {
    return std::pair(a.range_m, a.label) < std::pair(b.range_m, b.label);
  });
  return visible;
}

bool Scanner::occluded(const Sighting& sighting, const std::vector<Sighting>& nearer_first) const {
  const double radius_m = options_.occluding_radius_m;
  return std::any_of(nearer_first.begin(), nearer_first.end(), [&](const Sighting& other) {
    if (other.range_m >= sighting.range_m) return false;
    const double off_rad = core::wrap_to_pi(other.bearing_rad - sighting.bearing_rad);
    return std::abs(off_rad) < std::asin(std::min(1.0, radius_m / other.range_m));
  });
}

void Scanner::add(const Sighting& truth, core::RandomStream& random, LabelledScan& into) {
  const double range_m = random.normal(truth.range_m, true_noise_.sigma_range_m);
  const double bearing_rad = core::wrap_to_pi(random.normal(truth.bearing_rad, true_noise_.sigma_bearing_rad));
  if (range_m <= 0.0) return;  // a scanner has no negative ranges: a miss
  into.scan.observations.push_back(
      core::make_range_bearing(range_m, bearing_rad, assumed_noise_.sigma_range_m, assumed_noise_.sigma_bearing_rad));
  into.scan.observations.back().appearance = truth.label == core::no_label
                                                 ? looks_.of_clutter()
                                                 : looks_.of(world_.trees[static_cast<std::size_t>(truth.label)]);
  into.labels.push_back(truth.label);
}

void Scanner::add_clutter(LabelledScan& into) {
  const core::FieldOfView& view = options_.field_of_view;
  const double range_m =
      std::sqrt(random_.uniform(view.min_range_m * view.min_range_m, view.max_range_m * view.max_range_m));
  const double bearing_rad = random_.uniform(view.min_bearing_rad, view.max_bearing_rad);
  into.scan.observations.push_back(
      core::make_range_bearing(range_m, bearing_rad, assumed_noise_.sigma_range_m, assumed_noise_.sigma_bearing_rad));
  into.scan.observations.back().appearance = looks_.of_clutter();
  into.labels.push_back(core::no_label);
}

void Scanner::shuffle(LabelledScan& scan) {
  for (std::size_t i = scan.labels.size(); i > 1; --i) {
    const auto j = static_cast<std::size_t>(random_.below(i));
    std::swap(scan.labels[i - 1], scan.labels[j]);
    std::swap(scan.scan.observations[i - 1], scan.scan.observations[j]);
  }
}

}  // namespace helixnav::sim
