// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/sim/world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "grove.hpp"
#include "helixnav/core/angle.hpp"
#include "helixnav/core/errors.hpp"
#include "roads.hpp"
#include "town.hpp"

namespace helixnav::sim {
namespace {

constexpr Stretch always{0.0, std::numeric_limits<double>::infinity()};
constexpr double out_of_sight_m = 45.0;   // before the trees come into view again, they may change
constexpr double planted_ahead_m = 40.0;  // beyond the end of the drive, so that the last scans see trees too
constexpr double orchard_turn_radius_m = 40.0;
constexpr double orchard_run_up_m = 60.0;

/// Streams of one world, one for each thing drawn.
struct Dice {
  core::RandomStream road;
  core::RandomStream trees;
  core::RandomStream changes;
  core::RandomStream blackout;

  explicit Dice(std::uint64_t seed)
      : road(seed, "sim.world.road"),
        trees(seed, "sim.world.trees"),
        changes(seed, "sim.world.changes"),
        blackout(seed, "sim.world.blackout") {}
};

double draw(const Interval& interval, core::RandomStream& random) { return random.uniform(interval.min, interval.max); }

int laps_for(double drive_m, double lap_m) {
  return static_cast<int>(std::ceil((drive_m + planted_ahead_m) / lap_m)) + 1;
}

/// Somewhere among the trees of the first lap, not right at the start.
std::optional<Stretch> draw_blackout(double length_m, double last_tree_m, core::RandomStream& random) {
  constexpr double first_m = 60.0;
  if (length_m <= 0.0) return std::nullopt;
  const double from_m = random.uniform(first_m, std::max(first_m, last_tree_m - length_m));
  return Stretch{from_m, from_m + length_m};
}

World loop_world(const WorldOptions& options, Dice& dice) {
  const double lap_m = draw(options.loop_length_m, dice.road);
  const double bare_m = draw(options.bare_length_m, dice.road);
  const double drive_m = options.returns * lap_m + options.drive_on_m;
  World world{route_from_origin(wavy_loop(lap_m, laps_for(drive_m, lap_m), dice.road)), drive_m, {}, {}, {}};
  for (int i = 1; i <= options.returns; ++i) world.returns_at_m.push_back(i * lap_m);

  const double change_m = lap_m - out_of_sight_m;
  const double seen_again_m = std::min(lap_m - bare_m, drive_m - lap_m + planted_ahead_m);
  Grove grove(world.route, options.road_clearance_m);
  grove.plant_along({0.0, lap_m - bare_m}, options, 1.0, always, dice.trees);
  grove.fell(options.changed_share, change_m, dice.changes);
  grove.plant_along({0.0, seen_again_m}, options, options.changed_share, {change_m, always.to_m}, dice.changes);
  world.trees = grove.trees();
  world.blackout = draw_blackout(options.blackout_length_m, lap_m - bare_m, dice.blackout);
  return world;
}

World open_road_world(const WorldOptions& options, Dice& dice) {
  const double lap_m = draw(options.loop_length_m, dice.road);
  const double bare_m = draw(options.bare_length_m, dice.road);
  const double offset_m = dice.road.bernoulli(2.0 / 3.0) ? 50.0 : 120.0;
  const int laps = 2 + static_cast<int>(options.drive_on_m / lap_m);
  const Polyline road = spiral(lap_m, offset_m, laps, dice.road);
  World world{route_from_origin(road), 0.0, {}, {}, {}};
  const Route& route = world.route;
  // The way round is counter-clockwise, so that outside is to the right of the start; the first lap is the shortest.
  const double beside_start_m =
      route.nearest_along_m(Eigen::Vector2d(0.0, -offset_m), {lap_m / 2.0, route.length_m() / laps});
  world.drive_m = beside_start_m + options.drive_on_m;
  Grove grove(route, options.road_clearance_m);
  grove.plant_along({0.0, beside_start_m - bare_m}, options, 1.0, always, dice.trees);
  grove.plant_along({beside_start_m, world.drive_m + planted_ahead_m}, options, 1.0, always, dice.trees);
  world.trees = grove.trees();
  return world;
}

/// A lattice along the home straight: several rows per side, each shifted relative to the previous one.
void plant_lattice(const WorldOptions& options, Grove& grove, Dice& dice) {
  constexpr double first_row_m = 4.0;
  constexpr double jitter_m = 0.05;
  constexpr Stretch along_m{-100.0, 50.0};
  const double pitch_m = draw(options.lattice_pitch_m, dice.trees);
  const auto rows_a_side = 2 + static_cast<int>(dice.trees.below(2));
  constexpr double shifts[] = {0.0, 0.5, 1.0 / 3.0};  // square, staggered, oblique
  const double shift = shifts[dice.trees.below(3)];
  for (int row = -rows_a_side; row < rows_a_side; ++row) {
    const double y_m = row < 0 ? -first_row_m + (row + 1) * pitch_m : first_row_m + row * pitch_m;
    for (double x_m = along_m.from_m + std::fmod((row + rows_a_side) * shift, 1.0) * pitch_m; x_m < along_m.to_m;
         x_m += pitch_m) {
      const double x_jitter_m = dice.trees.normal(0.0, jitter_m);
      const double y_jitter_m = dice.trees.normal(0.0, jitter_m);
      grove.plant({x_m + x_jitter_m, y_m + y_jitter_m}, always);
    }
  }
}

World orchard_world(const WorldOptions& options, Dice& dice) {
  const double lap_m = draw(options.loop_length_m, dice.road);
  const double drive_m = lap_m + options.drive_on_m;
  const Polyline road = racetrack(lap_m, orchard_turn_radius_m, orchard_run_up_m, laps_for(drive_m, lap_m));
  World world{route_from_origin(road), drive_m, {}, {lap_m}, {}};
  Grove grove(world.route, options.road_clearance_m);
  plant_lattice(options, grove, dice);
  grove.plant_along({115.0, 230.0}, options, 1.0, always, dice.trees);
  grove.fell(options.changed_share, lap_m / 2.0, dice.changes);
  world.trees = grove.trees();
  return world;
}

World figure_of_eight_world(const WorldOptions& options, Dice& dice) {
  const double lap_m = draw(options.loop_length_m, dice.road);
  const Stretch first{0.07 * lap_m, 0.36 * lap_m};
  const Stretch second{0.57 * lap_m, 0.86 * lap_m};
  const std::vector<double> returns_at_m = {lap_m + first.from_m, lap_m + second.from_m, 2.0 * lap_m + first.from_m};
  // Not so far that a region that would not be judged comes into view again.
  const double drive_m = returns_at_m.back() + std::min(options.drive_on_m, first.to_m - first.from_m);
  World world{route_from_origin(figure_of_eight(lap_m, laps_for(drive_m, lap_m), dice.road)), drive_m, {}, {}, {}};
  world.returns_at_m = returns_at_m;

  const double change_m = 0.95 * lap_m;
  Grove grove(world.route, options.road_clearance_m);
  for (const Stretch& region : {first, second}) grove.plant_along(region, options, 1.0, always, dice.trees);
  grove.fell(options.changed_share, change_m, dice.changes);
  for (const Stretch& region : {first, second}) {
    grove.plant_along(region, options, options.changed_share, {change_m, always.to_m}, dice.changes);
  }
  world.trees = grove.trees();
  return world;
}

World circuit_world(const WorldOptions& options, Dice& dice) {
  const double lap_m = draw(options.loop_length_m, dice.road);
  const double half_radius_m = lap_m / (4.0 * core::pi);
  const double drive_m = options.returns * lap_m + options.drive_on_m;
  World world{route_from_origin(circle(lap_m, laps_for(drive_m, lap_m))), drive_m, {}, {}, {}};
  for (int i = 1; i <= options.returns; ++i) world.returns_at_m.push_back(i * lap_m);

  Grove grove(world.route, options.road_clearance_m);
  const auto wanted = static_cast<std::size_t>(options.circuit_landmarks);
  for (std::size_t tries = 0; grove.trees().size() < wanted && tries < 1000 * wanted; ++tries) {
    const double along_m = dice.trees.uniform(0.0, lap_m);
    const Eigen::Vector2d forward = world.route.direction(along_m);
    const double offset_m = dice.trees.uniform(-half_radius_m, half_radius_m);
    grove.plant(world.route.at(along_m) + offset_m * Eigen::Vector2d(-forward.y(), forward.x()), always);
  }
  world.trees = grove.trees();
  return world;
}

World town_world(const WorldOptions& options, Dice& dice) {
  const Town town(options, dice.road);
  const TownTour tour = town.tour(options.tour_m, options.drive_on_m, dice.road);
  World world{Route(tour.road), tour.drive_m, {}, tour.returns_at_m, {}};
  constexpr double crossing_m = 10.0;  // no trees this close to the middle of a crossing
  Grove grove(world.route, options.road_clearance_m);
  for (const Polyline& street : town.streets_with_trees()) {
    const Stretch stretch{crossing_m, options.block_side_m - crossing_m};
    grove.plant_along(Route(street), stretch, options, 1.0, always, dice.trees);
  }
  world.trees = grove.trees();
  return world;
}

/// As dense as given on average, if there is room; some of them with a second stem.
void plant_forest(const WorldOptions& options, double lap_m, const Route& route, Grove& grove, Dice& dice) {
  Eigen::AlignedBox2d box;
  for (double along_m = 0.0; along_m < lap_m; along_m += 1.0) box.extend(route.at(along_m));
  const Eigen::Vector2d rim_m = Eigen::Vector2d::Constant(options.forest_depth_m);
  const Eigen::Vector2d from_m = box.min() - rim_m;
  const Eigen::Vector2d size_m = box.max() + rim_m - from_m;
  const double wanted = options.trees_a_m2 * size_m.prod();
  for (double planted = 0.0; planted < wanted; planted += 1.0) {
    const double x_m = from_m.x() + dice.trees.uniform(0.0, size_m.x());
    const double y_m = from_m.y() + dice.trees.uniform(0.0, size_m.y());
    const bool is_twin = dice.trees.bernoulli(options.twin_share);
    const double apart_m = draw(options.twin_m, dice.trees);
    const double side_rad = dice.trees.uniform(-core::pi, core::pi);
    if (route.distance_m({x_m, y_m}) > options.forest_depth_m) continue;
    if (!grove.plant({x_m, y_m}, always) || !is_twin) continue;
    grove.plant_twin({x_m + apart_m * std::cos(side_rad), y_m + apart_m * std::sin(side_rad)});
  }
}

World forest_world(const WorldOptions& options, Dice& dice) {
  const double lap_m = draw(options.loop_length_m, dice.road);
  const double drive_m = options.returns * lap_m + options.drive_on_m;
  World world{route_from_origin(wavy_loop(lap_m, laps_for(drive_m, lap_m), dice.road)), drive_m, {}, {}, {}};
  for (int i = 1; i <= options.returns; ++i) world.returns_at_m.push_back(i * lap_m);
  Grove grove(world.route, options.road_clearance_m);
  plant_forest(options, lap_m, world.route, grove, dice);
  world.trees = grove.trees();
  return world;
}

World build(const WorldOptions& options, Dice& dice) {
  switch (options.kind) {
    case WorldKind::loop:
      return loop_world(options, dice);
    case WorldKind::open_road:
      return open_road_world(options, dice);
    case WorldKind::orchard:
      return orchard_world(options, dice);
    case WorldKind::figure_of_eight:
      return figure_of_eight_world(options, dice);
    case WorldKind::circuit:
      return circuit_world(options, dice);
    case WorldKind::town:
      return town_world(options, dice);
    case WorldKind::forest:
      return forest_world(options, dice);
  }
  throw core::PreconditionError("sim: unknown kind of world");
}

}  // namespace

World build_world(const WorldOptions& options, std::uint64_t seed) {
  Dice dice(seed);
  World world = build(options, dice);
  core::RandomStream looks(seed, "sim.world.looks");
  for (Tree& tree : world.trees) {
    tree.class_draw = looks.uniform(0.0, 1.0);
    tree.diameter_draw = looks.uniform(0.0, 1.0);
  }
  return world;
}

}  // namespace helixnav::sim
