// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "helixnav/sim/route.hpp"

namespace helixnav::sim {

/// A quantity drawn uniformly per seed, or per object.
struct Interval {
  double min = 0.0;
  double max = 0.0;
};

enum class WorldKind {
  loop,             ///< closed wavy road with trees and a bare stretch before it closes
  open_road,        ///< starts like the loop, then swings out beside its own start and never returns to it
  orchard,          ///< racetrack whose home straight runs through a lattice of trees larger than the part mapped
  figure_of_eight,  ///< two lobes with trees, bare around the crossing: both are revisited, the first one twice
  circuit,          ///< small circle among scattered landmarks, driven again and again
  town,             ///< random tour on a grid of streets with trees on both sides, some of them bare
  forest,           ///< closed wavy road through trees at random places, as far as the eye can see
};

/// What a world is drawn from. Not every quantity matters to every kind; the comment names those it matters to.
struct WorldOptions {
  WorldKind kind = WorldKind::loop;
  Interval loop_length_m{390.0,
                         820.0};  ///< once round (loop, open_road, figure_of_eight, forest); circuit uses its middle
  Interval bare_length_m{110.0, 200.0};  ///< without trees, just before the loop closes (loop, open_road)
  Interval tree_spacing_m{5.0, 15.0};    ///< along each side of the road; the nearest neighbour is then about 8 m away
  Interval tree_offset_m{4.0, 9.0};      ///< from the centre line of the road
  double road_clearance_m = 3.0;         ///< no tree nearer to the centre line of any part of the route
  double changed_share = 0.0;            ///< of the trees: felled before the return; as many new ones planted
  double drive_on_m = 180.0;             ///< driven after the (last) return; figure_of_eight: to the lobe's end at most
  int returns = 1;                       ///< how often the loop is closed (loop, circuit, forest)
  Interval lattice_pitch_m{4.0, 7.0};    ///< orchard
  int circuit_landmarks = 20;            ///< circuit: at 0.5 to 1.5 times its radius from its centre
  double blackout_length_m = 0.0;        ///< loop: stretch of the first lap where the scanner sees nothing
  double tour_m = 4800.0;                ///< town: length of the tour
  double block_side_m = 120.0;           ///< town: from crossing to crossing
  int blocks_a_side = 4;                 ///< town: the grid has this many blocks in each direction
  double bare_share = 0.15;              ///< town: of the streets, never the first one
  double trees_a_m2 = 0.04;              ///< forest
  double forest_depth_m = 35.0;          ///< forest: from the road, to either side
  double twin_share = 0.0;               ///< forest: share of trees that have a second stem …
  Interval twin_m{0.3, 0.8};             ///< … this far from the first
};

/// A tree, seen as a point. It exists while the vehicle's position along its route is within `present`.
struct Tree {
  Eigen::Vector2d point_m = Eigen::Vector2d::Zero();
  Stretch present;
  double class_draw = 0.0;     ///< uniform in [0, 1): which of the classes a scanner reports, and …
  double diameter_draw = 0.0;  ///< … where between its smallest and its largest diameter
};

/// The truth: the path of the vehicle from the origin along x, and the trees. No two trees are nearer than 2 m, even if
/// they never exist at the same time; only the second stem of a twin, a tree of its own, is nearer to its first. The
/// index of a tree is its label.
struct World {
  Route route;
  double drive_m = 0.0;  ///< how much of the route is driven
  std::vector<Tree> trees;
  std::vector<double> returns_at_m;  ///< distances along the route where old ground begins again; empty: never. In a
                                     ///< town: where a street with trees is entered again from one that is no such
  std::optional<Stretch> blackout;
};

inline constexpr double nearest_trees_m = 2.0;

/// Draws a world. Road, trees, changes and blackout come from streams of their own: the same seed with a different
/// changed_share has the same road and the same trees on the first lap. Cost: trees × points of the route. Test:
/// sim/world_test.cpp.
World build_world(const WorldOptions& options, std::uint64_t seed);

}  // namespace helixnav::sim
