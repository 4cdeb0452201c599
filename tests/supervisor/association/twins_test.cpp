// SPDX-License-Identifier: BSD-3-Clause
// A drive past pairs of objects that are too close together for the sensor to tell them apart by position.
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/core/random.hpp"
#include "helixnav/supervisor/navigator.hpp"

namespace helixnav::supervisor {
namespace {

constexpr double twin_distance_m = 0.3;

struct TwinWorld {
  std::vector<Eigen::Vector2d> points_m;
  std::vector<const char*> names;
  std::vector<double> sizes_m;
};

/// Pairs every 8 m on both sides of a straight road; in each pair, one is red and thin and the other blue and thick.
TwinWorld pairs_along_a_road() {
  TwinWorld world;
  for (int i = 0; i < 10; ++i) {
    for (const double side_m : {-5.0, 6.0}) {
      world.points_m.emplace_back(8.0 * i, side_m);
      world.points_m.emplace_back(8.0 * i + twin_distance_m, side_m);
      world.names.insert(world.names.end(), {"red", "blue"});
      world.sizes_m.insert(world.sizes_m.end(), {0.2, 0.4});
    }
  }
  return world;
}

enum class Given { nothing, classes, sizes };

core::Appearance appearance_of(const TwinWorld& world, std::size_t k, Given given, core::RandomStream& random) {
  core::Appearance seen;
  if (given == Given::classes) seen.name = core::ClassName(world.names[k]);
  if (given == Given::sizes) {
    seen.sigma_size_m = 0.03;
    seen.size_m = random.normal(world.sizes_m[k], seen.sigma_size_m);
  }
  return seen;
}

struct TwinScore {
  int confused = 0;  ///< matched with a landmark that another object began
  int matched = 0;
  std::vector<core::MapLandmark> map;
};

/// Drives along the road; noise of 0.15 m on each coordinate, half the distance of twins.
TwinScore drive_past(const TwinWorld& world, Given given, std::uint64_t seed) {
  constexpr double sigma_m = 0.15;
  core::RandomStream random(seed, "twins");
  Navigator navigator(core::PoseGaussian{});
  std::map<core::LandmarkId, std::size_t> begun_by;
  TwinScore score;
  for (int step = 0; step < 140; ++step) {
    core::Odometry moved;
    moved.t_ns = step * 1'000'000'000LL;
    moved.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-7).asDiagonal();
    moved.T_before_after = {step == 0 ? 0.0 : 0.5, 0.0, 0.0};
    navigator.move(moved);
    core::Scan scan;
    scan.t_ns = moved.t_ns;
    scan.field_of_view.max_range_m = 20.0;
    std::vector<std::size_t> origin;
    for (std::size_t k = 0; k < world.points_m.size(); ++k) {
      const Eigen::Vector2d away_m = world.points_m[k] - Eigen::Vector2d(0.5 * step, 0.0);
      if (away_m.norm() > 20.0) continue;
      const Eigen::Vector2d noise_m(random.normal(0.0, sigma_m), random.normal(0.0, sigma_m));
      scan.observations.push_back(
          core::make_cartesian(away_m + noise_m, sigma_m * sigma_m * Eigen::Matrix2d::Identity()));
      scan.observations.back().appearance = appearance_of(world, k, given, random);
      origin.push_back(k);
    }
    const core::StepReport report = navigator.observe(scan);
    for (const core::AssociationReport& one : report.associations) {
      const std::size_t k = origin[static_cast<std::size_t>(one.observation)];
      if (one.outcome == core::Outcome::augmented) begun_by[one.landmark] = k;
      if (one.outcome != core::Outcome::matched) continue;
      ++score.matched;
      score.confused += begun_by.at(one.landmark) != k ? 1 : 0;
    }
  }
  score.map = navigator.map();
  return score;
}

TEST(Twins, AreToldApartByClassOrSizeAndNotByPlace) {
  const TwinWorld world = pairs_along_a_road();
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const TwinScore by_place = drive_past(world, Given::nothing, seed);
    const TwinScore by_class = drive_past(world, Given::classes, seed);
    const TwinScore by_size = drive_past(world, Given::sizes, seed);
    EXPECT_GT(by_place.confused, by_place.matched / 20) << seed;
    EXPECT_LT(by_class.confused, by_class.matched / 200) << seed;
    EXPECT_LT(by_size.confused, by_size.matched / 100) << seed;
    EXPECT_GT(by_class.matched, by_place.matched / 2) << seed;
  }
}

TEST(Twins, KnowTheirClassesAndSizesAtTheEnd) {
  const TwinWorld world = pairs_along_a_road();
  for (const Given given : {Given::classes, Given::sizes}) {
    int right = 0;
    int known = 0;
    for (const core::MapLandmark& landmark : drive_past(world, given, 4).map) {
      if (landmark.state != core::LandmarkState::mature) continue;
      std::size_t nearest = 0;
      for (std::size_t k = 1; k < world.points_m.size(); ++k) {
        const auto off_m = [&](std::size_t i) { return (world.points_m[i] - landmark.point.mean_m).norm(); };
        if (off_m(k) < off_m(nearest)) nearest = k;
      }
      ++known;
      right += given == Given::classes ? landmark.appearance.votes.front().name == core::ClassName(world.names[nearest])
                                       : std::abs(landmark.appearance.size_m - world.sizes_m[nearest]) < 0.1;
    }
    EXPECT_GT(known, 20);
    EXPECT_GE(right, known - 2);
  }
}

}  // namespace
}  // namespace helixnav::supervisor
