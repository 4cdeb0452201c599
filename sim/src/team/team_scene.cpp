// SPDX-License-Identifier: BSD-3-Clause
#include "team_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "helixnav/core/angle.hpp"
#include "helixnav/sim/world.hpp"

namespace helixnav::sim {
namespace {

using Points = std::vector<Eigen::Vector2d>;

/// From a circle of radius a, a scanner of reach b ≥ a sees the disc of radius a + b.
double disc_m(const TeamScene& scene) { return scene.radius_m + scene.reach_m; }

TeamScene circles_in_a_row(int robots, double apart_m, core::RandomStream& random) {
  TeamScene scene;
  scene.radius_m = 15.0;
  scene.reach_m = 18.0;
  for (int r = 0; r < robots; ++r) {
    TeamCircle& circle = scene.circles.emplace_back();
    circle.centre_m.x() = apart_m * r;
    circle.direction = random.bernoulli(0.5) ? 1.0 : -1.0;
    circle.begin_rad = random.uniform(0.0, 2.0 * core::pi);
  }
  return scene;
}

/// Adds landmarks in the disc of robot `in` that are in no other disc than that of robot `also`; also == in: in none.
void scatter(int count, std::size_t in, std::size_t also, core::RandomStream& random, TeamScene& scene) {
  const double disc = disc_m(scene);
  const auto is_seen = [&](std::size_t robot, const Eigen::Vector2d& p) {
    return (p - scene.circles[robot].centre_m).norm() < disc;
  };
  const std::size_t wanted = scene.landmarks_m.size() + static_cast<std::size_t>(std::max(0, count));
  while (scene.landmarks_m.size() < wanted) {
    const double x_m = random.uniform(-disc, disc);
    const Eigen::Vector2d p = scene.circles[in].centre_m + Eigen::Vector2d(x_m, random.uniform(-disc, disc));
    bool fits = is_seen(in, p);
    for (std::size_t r = 0; r < scene.circles.size(); ++r) fits = fits && is_seen(r, p) == (r == in || r == also);
    for (const Eigen::Vector2d& q : scene.landmarks_m) fits = fits && (p - q).norm() > nearest_trees_m;
    if (fits) scene.landmarks_m.push_back(p);
  }
}

TeamScene shared(const TeamWorldOptions& options, core::RandomStream& random) {
  constexpr double apart_m = 33.5;  // discs of 33 m: next but one do not touch
  TeamScene scene = circles_in_a_row(options.robots, apart_m, random);
  const std::size_t robots = scene.circles.size();
  for (std::size_t r = 0; r < robots; ++r) {
    const int neighbours = (r > 0 ? 1 : 0) + (r + 1 < robots ? 1 : 0);
    scatter(options.landmarks_each - neighbours * options.common, r, r, random, scene);
    if (r + 1 < robots) scatter(options.common, r, r + 1, random, scene);
  }
  return scene;
}

TeamScene apart(const TeamWorldOptions& options, core::RandomStream& random) {
  constexpr double apart_m = 600.0;
  TeamScene scene = circles_in_a_row(options.robots, apart_m, random);
  for (std::size_t r = 0; r < scene.circles.size(); ++r) scatter(options.landmarks_each, r, r, random, scene);
  return scene;
}

/// Each robot is 1 to 5 columns and 0 to 2 rows from the previous one; trees wherever any robot sees.
TeamScene orchard(const TeamWorldOptions& options, core::RandomStream& random) {
  TeamScene scene = circles_in_a_row(options.robots, 0.0, random);
  const double pitch_m = options.pitch_m;
  scene.radius_m = pitch_m;
  scene.reach_m = 2.0 * pitch_m;
  int column = 0, row = 0;
  for (TeamCircle& circle : scene.circles) {
    circle.centre_m = pitch_m * Eigen::Vector2d(column + 0.5, row + 0.5);
    column += 1 + static_cast<int>(random.below(5));
    row += static_cast<int>(random.below(3));
  }
  constexpr int margin = 4;  // columns and rows around the circles' centres: more than a view and its jitter
  for (int i = -margin; i <= column + margin; ++i) {
    for (int k = -margin; k <= row + margin; ++k) {
      const double x_m = pitch_m * i + random.normal(0.0, options.jitter_m);
      scene.landmarks_m.emplace_back(x_m, pitch_m * k + random.normal(0.0, options.jitter_m));
    }
  }
  return scene;
}

}  // namespace

TeamScene scene_of(const TeamWorldOptions& options, core::RandomStream& random) {
  switch (options.kind) {
    case TeamWorldKind::shared:
      return shared(options, random);
    case TeamWorldKind::apart:
      return apart(options, random);
    default:
      return orchard(options, random);
  }
}

}  // namespace helixnav::sim
