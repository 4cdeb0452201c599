// SPDX-License-Identifier: BSD-3-Clause
// The places proposed by pairs of observations are the distinct ones that explain most.
#include "slip/slip_places.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

#include "slip_scene.hpp"

namespace helixnav::supervisor {
namespace {

constexpr double distinct_places_m = 0.5;

const std::vector<SlipComponent>& components() {
  static const std::vector<SlipComponent> some{{0.1, degree, 0.01}, {0.8, 4.0 * degree, 0.001}};
  return some;
}

std::vector<SlipPlace> places_of(const SlipScene& scene) {
  return slip_places(scene.geometry, scene.seen, a_pair_nats, components(), distinct_places_m);
}

/// Each observation with the landmark nearest to where the displaced vehicle sees it, if within a metre.
std::vector<PointPair> nearest_pairs(const SlipScene& scene, const Eigen::Vector3d& displacement) {
  std::vector<PointPair> pairs;
  const core::Pose2 T_predicted_displaced(displacement);
  std::vector<bool> taken(scene.geometry.points_m.size(), false);
  for (std::size_t s = 0; s < scene.seen.size(); ++s) {
    const Eigen::Vector2d at_m = core::transform(T_predicted_displaced, scene.seen[s].point_m);
    for (std::size_t l = 0; l < taken.size(); ++l) {
      if (taken[l] || (scene.geometry.points_m[l] - at_m).norm() > 1.0) continue;
      taken[l] = true;
      pairs.push_back({s, l});
      break;
    }
  }
  return pairs;
}

/// The best explanation from a grid of starting displacements that reaches as far as slips are looked for.
double best_nats_of_a_grid(const SlipScene& scene) {
  double best = -1e9;
  for (int i = -4; i <= 4; ++i) {
    for (int k = -4; k <= 4; ++k) {
      for (int turn = -4; turn <= 4; ++turn) {
        const Eigen::Vector3d from(0.5 * i, 0.5 * k, 2.5 * degree * turn);
        const std::vector<PointPair> pairs = nearest_pairs(scene, from);
        if (pairs.size() < 3) continue;
        best = std::max(best, explain_by_slip(scene.geometry, scene.seen, pairs, a_pair_nats, components(), from).nats);
      }
    }
  }
  return best;
}

TEST(SlipPlaces, NoneOfAGridOfDisplacementsExplainsMore) {
  core::RandomStream random(7, "slip places");
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Eigen::Vector3d truth(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-0.1, 0.1));
    const SlipScene scene(scattered(seed), truth, seed);
    const std::vector<SlipPlace> places = places_of(scene);
    ASSERT_FALSE(places.empty()) << seed;
    const SlipExplanation of_truth =
        explain_by_slip(scene.geometry, scene.seen, all_pairs(8), a_pair_nats, components(), truth);
    EXPECT_NEAR(places.front().explanation.nats, of_truth.nats, 0.01) << seed;
    EXPECT_LT((places.front().explanation.displacement - of_truth.displacement).norm(), 0.01) << seed;
    EXPECT_GT(places.front().explanation.nats, best_nats_of_a_grid(scene) - 0.1) << seed;
  }
}

TEST(SlipPlaces, ArePairedOneToOneAndTheBestComesFirst) {
  std::vector<Eigen::Vector2d> lattice_m;  // half a pitch is ambiguous in direction
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 4; ++k) lattice_m.emplace_back(3.0 + 2.0 * i, -3.0 + 2.0 * k);
  }
  const std::vector<SlipPlace> places = places_of(SlipScene(lattice_m, {1.0, 0.0, 0.0}, 1));
  ASSERT_FALSE(places.empty());
  for (std::size_t a = 0; a < places.size(); ++a) {
    if (a > 0) {
      EXPECT_GE(places[a - 1].explanation.nats, places[a].explanation.nats);
    }
    EXPECT_GE(places[a].pairs.size(), 3u);
    for (std::size_t i = 0; i < places[a].pairs.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        EXPECT_NE(places[a].pairs[i].seen, places[a].pairs[k].seen);
        EXPECT_NE(places[a].pairs[i].landmark, places[a].pairs[k].landmark);
      }
    }
  }
  const bool has_rival = std::any_of(places.begin(), places.end(), [&](const SlipPlace& place) {
    return !is_same_place(place.explanation.displacement, places.front().explanation.displacement, distinct_places_m);
  });
  EXPECT_TRUE(has_rival) << "half a pitch ahead, or behind";
}

TEST(SlipPlaces, ThereAreNoneOfTwoObservationsNorBeyondTheReachOfTheWidestSlip) {
  EXPECT_TRUE(places_of(SlipScene(scattered(1, 2), {0.5, 0.0, 0.0}, 1)).empty());
  EXPECT_TRUE(places_of(SlipScene(scattered(2), {3.5, 0.0, 0.0}, 2)).empty());
}

/// Stems in pairs, 0.4 m apart.
std::vector<Eigen::Vector2d> twins(std::uint64_t seed) {
  core::RandomStream random(seed, "twins");
  std::vector<Eigen::Vector2d> points_m;
  for (const Eigen::Vector2d& point_m : scattered(seed, 10)) {
    const double bearing_rad = random.uniform(-core::pi, core::pi);
    points_m.push_back(point_m);
    points_m.push_back(point_m + 0.4 * Eigen::Vector2d(std::cos(bearing_rad), std::sin(bearing_rad)));
  }
  return points_m;
}

TEST(SlipPlaces, AmongTwinsAreFoundBeyondTheNextNeighbourOnly) {
  const Eigen::Vector3d truth(1.3, -0.8, 4.0 * degree);
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const SlipScene scene(twins(seed), truth, seed);
    const auto has_truth = [&](SlipReach reach) {
      const std::vector<SlipPlace> places =
          slip_places(scene.geometry, scene.seen, a_pair_nats, components(), distinct_places_m, reach);
      return !places.empty() && is_same_place(places.front().explanation.displacement, truth, distinct_places_m) &&
             places.front().pairs.size() >= 18;
    };
    EXPECT_FALSE(has_truth(SlipReach::next_neighbour)) << seed;
    EXPECT_TRUE(has_truth(SlipReach::any_neighbour)) << seed;
  }
}

TEST(SlipPlaces, HeadingsTellPlacesApartAndCountRoundTheCircle) {
  const Eigen::Vector3d here(1.0, 2.0, core::pi - 0.01);
  EXPECT_TRUE(is_same_place(here, {1.1, 2.0, -core::pi + 0.01}, 0.5));
  EXPECT_FALSE(is_same_place(here, {1.1, 2.0, core::pi - 0.1}, 0.5));
  EXPECT_FALSE(is_same_place(here, {1.6, 2.0, here.z()}, 0.5));
}

TEST(SlipPlaces, ReachIsThatOfTheWidestSlipAtThatRangeButNotFarBeyondTheNeighbour) {
  const SeenPoint seen{0, {3.0, 4.0}, Eigen::Matrix2d::Identity()};
  const SlipComponent widest{0.4, 0.1, 0.01};
  EXPECT_DOUBLE_EQ(slip_reach_m(widest, seen, 100.0), 2.5 * (0.4 + 0.1 * 5.0));
  EXPECT_DOUBLE_EQ(slip_reach_m(widest, seen, 1.0), 1.25);
}

}  // namespace
}  // namespace helixnav::supervisor
