// SPDX-License-Identifier: BSD-3-Clause
#include "association/place_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "association/gated_scan.hpp"
#include "association/gating.hpp"
#include "association/old_pairs.hpp"
#include "association/rival_matchings.hpp"
#include "helixnav/association/joint_innovation.hpp"
#include "helixnav/core/angle.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::supervisor {
namespace {

constexpr double sensor_sigma_m = 0.1;
constexpr double foreign_in_scan = 2.5;

/// Landmarks known to 0.05 m around a vehicle whose pose has since become uncertain, and a scan from where it truly is.
struct Ground {
  cekf::CompressedEkf filter{core::PoseGaussian{}};
  std::vector<core::LandmarkId> ids;
  std::vector<Eigen::Vector2d> points_m;
  core::Scan scan;

  Ground(std::vector<Eigen::Vector2d> points, double pose_sigma_m, double heading_sigma_rad)
      : points_m(std::move(points)) {
    for (const Eigen::Vector2d& point_m : points_m) {
      ids.push_back(filter.augment(core::make_cartesian(point_m, 0.0025 * Eigen::Matrix2d::Identity()), {}));
    }
    core::Odometry odometry;
    odometry.covariance.diagonal() << pose_sigma_m * pose_sigma_m, pose_sigma_m * pose_sigma_m,
        heading_sigma_rad * heading_sigma_rad;
    filter.predict(odometry);
    scan.field_of_view = {0.0, 30.0, -core::pi, core::pi};
  }

  void see(const core::Pose2& T_world_robot, const std::vector<std::size_t>& which, core::RandomStream& random) {
    for (const std::size_t i : which) {
      Eigen::Vector2d seen_m = core::transform(core::inverse(T_world_robot), points_m[i]);
      seen_m.x() += sensor_sigma_m * random.normal();
      seen_m.y() += sensor_sigma_m * random.normal();
      scan.observations.push_back(
          core::make_cartesian(seen_m, sensor_sigma_m * sensor_sigma_m * Eigen::Matrix2d::Identity()));
    }
  }

  PlaceEvidence weigh(const SearchOptions& options) const {
    const Gating gating(filter, ids, scan, {});
    association::Options how;
    how.extraneous = association::density_in_view(scan, 1.0, how.extraneous);
    const auto assignment = association::associate(association::Method::likelihood_ratio, gating.problem, how);
    return place_evidence(filter, gating.problem, assignment, scan, ids, foreign_in_scan, 2.0, options);
  }
};

std::vector<Eigen::Vector2d> scattered_points(core::RandomStream& random, int count, double half_side_m) {
  std::vector<Eigen::Vector2d> points_m;
  for (int i = 0; i < count; ++i) {
    const double x_m = half_side_m * (2.0 * random.uniform() - 1.0);
    const double y_m = half_side_m * (2.0 * random.uniform() - 1.0);
    points_m.emplace_back(x_m, y_m);
  }
  return points_m;
}

std::vector<Eigen::Vector2d> lattice(int half, double pitch_m) {
  std::vector<Eigen::Vector2d> points_m;
  for (int i = -half; i <= half; ++i) {
    for (int j = -half; j <= half; ++j) points_m.emplace_back(pitch_m * (i + 0.5), pitch_m * (j + 0.5));
  }
  return points_m;
}

core::RandomStream place_stream(std::uint64_t seed) { return core::RandomStream(seed, "place"); }

std::vector<int> all_gated_pairs(const association::InnovationProblem& problem) {
  std::vector<int> pairs(problem.pairs.size());
  std::iota(pairs.begin(), pairs.end(), 0);
  return pairs;
}

TEST(PlaceEvidence, ConditionsOnGivenPairsAsTheDenseCovarianceDoes) {
  core::RandomStream random = place_stream(1);
  Ground ground(scattered_points(random, 12, 15.0), 1.0, 0.05);
  ground.see({0.4, -0.3, 0.02}, {0, 1, 2, 3, 4}, random);
  const Gating gating(ground.filter, ground.ids, ground.scan, {});
  std::vector<int> all;  // the true ones: all pairs of two observations with two landmarks would depend on each other
  for (const int p : all_gated_pairs(gating.problem)) {
    const association::GatedPair& pair = gating.problem.pairs[static_cast<std::size_t>(p)];
    if (pair.observation == pair.candidate) all.push_back(p);
  }
  ASSERT_EQ(all.size(), 5u);
  const std::vector<int> given{all.front()}, rest(all.begin() + 1, all.end());
  const OldPairs pairs = old_pairs_given(gating.problem, rest, given);
  const association::JointInnovation joint = association::joint_innovation(gating.problem, all);
  const Eigen::MatrixXd precision = joint.S.inverse();
  const auto n = static_cast<Eigen::Index>(2 * rest.size());
  const Eigen::MatrixXd conditional = precision.bottomRightCorner(n, n).inverse();
  EXPECT_TRUE(pairs.S.isApprox(conditional, 1e-8));
  const Eigen::VectorXd mean =
      joint.S.bottomLeftCorner(n, 2) * joint.S.topLeftCorner<2, 2>().inverse() * joint.nu.head<2>();
  EXPECT_TRUE(pairs.nu.isApprox(joint.nu.tail(n) - mean, 1e-8));
  const Matching two{0, 1};
  const Eigen::Matrix4d S = pairs.S.topLeftCorner<4, 4>();
  const Eigen::Vector4d nu = pairs.nu.head<4>();
  EXPECT_NEAR(joint_log_likelihood(pairs, two),
              -0.5 * (nu.dot(S.inverse() * nu) + std::log(S.determinant()) + 4.0 * std::log(2.0 * core::pi)), 1e-9);
}

TEST(PlaceEvidence, FixesThePoseOnScatteredGround) {
  int fixed = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    core::RandomStream random = place_stream(seed);
    Ground ground(scattered_points(random, 40, 25.0), 0.35, 0.01);
    std::vector<std::size_t> which(12);
    std::iota(which.begin(), which.end(), 0);
    const double x_m = 0.35 * random.normal();
    const double y_m = 0.35 * random.normal();
    const double heading_rad = 0.01 * random.normal();
    ground.see({x_m, y_m, heading_rad}, which, random);
    fixed += fixes_pose(ground.weigh({}), {}) ? 1 : 0;
  }
  EXPECT_GE(fixed, 95);  // the prior leaves room in a few
}

TEST(PlaceEvidence, LeavesALatticeToTheSearchWhereThePriorHoldsMoreThanOnePitch) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    core::RandomStream random = place_stream(seed);
    Ground ground(lattice(4, 4.0), 2.0, 0.01);
    ground.see({}, {30, 31, 39, 40, 41, 48, 49}, random);
    EXPECT_FALSE(fixes_pose(ground.weigh({}), {})) << "seed " << seed;
  }
}

TEST(PlaceEvidence, FindsTheFourNeighboursOfALatticeAsRivals) {
  core::RandomStream random = place_stream(3);
  Ground ground(lattice(4, 4.0), 1.3, 0.002);
  ground.see({}, {30, 31, 39, 40, 41, 48, 49}, random);
  const Gating gating(ground.filter, ground.ids, ground.scan, {});
  const OldPairs pairs = old_pairs_given(gating.problem, all_gated_pairs(gating.problem), {});
  Matching best;
  for (int k = 0; k < pairs.size(); ++k) {
    const std::vector<std::size_t> truth{30, 31, 39, 40, 41, 48, 49};
    const auto observation = static_cast<std::size_t>(pairs.at(k).observation);
    if (pairs.at(k).candidate == static_cast<int>(truth[observation])) best.push_back(k);
  }
  ASSERT_EQ(best.size(), 7u);
  const auto rivals = rival_matchings(pairs, best);
  ASSERT_TRUE(rivals.has_value());
  int shifted_by_one = 0;
  for (const int by : {-1, 1, -9, 9}) {  // landmarks of neighbouring places, by their ids
    shifted_by_one += std::any_of(rivals->begin(), rivals->end(), [&](const Matching& rival) {
      return rival.size() == 7 && std::all_of(rival.begin(), rival.end(), [&](int k) {
               const std::vector<int> truth{30, 31, 39, 40, 41, 48, 49};
               return pairs.at(k).candidate == truth[static_cast<std::size_t>(pairs.at(k).observation)] + by;
             });
    });
  }
  EXPECT_EQ(shifted_by_one, 4);
}

/// Σ exp(evidence) over matchings with old landmarks, 1 for the empty one: over all, and over those that share more
/// than half of their pairs with the assignment.
struct Enumerated {
  double all = 0.0;
  double same = 0.0;
};

void enumerate(const OldPairs& pairs, const Matching& best, double foreign_per_m2, double detected, int from,
               Matching& matching, Enumerated& sum) {
  double nats = 0.0;
  if (!matching.empty()) {
    nats = joint_log_likelihood(pairs, matching) +
           static_cast<double>(matching.size()) * std::log(detected / foreign_per_m2);
  }
  Matching common;
  std::set_intersection(best.begin(), best.end(), matching.begin(), matching.end(), std::back_inserter(common));
  sum.all += std::exp(nats);
  if (!matching.empty() && 2 * common.size() >= matching.size()) sum.same += std::exp(nats);
  for (int k = from; k < pairs.size(); ++k) {
    const bool clash = std::any_of(matching.begin(), matching.end(), [&](int m) {
      return pairs.at(m).observation == pairs.at(k).observation || pairs.at(m).candidate == pairs.at(k).candidate;
    });
    if (clash) continue;
    matching.push_back(k);
    enumerate(pairs, best, foreign_per_m2, detected, k + 1, matching, sum);
    matching.pop_back();
  }
}

TEST(PlaceEvidence, WhereItFixesThePoseAllMatchingsTogetherAgree) {
  int fixed = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    core::RandomStream random = place_stream(seed);
    Ground ground(scattered_points(random, 14, 12.0), 0.4, 0.01);
    const double x_m = 0.4 * random.normal();
    const double y_m = 0.4 * random.normal();
    ground.see({x_m, y_m, 0.0}, {0, 1, 2, 3, 4}, random);
    SearchOptions options;
    options.confirmation_widening = 0.0;  // without the other rule
    if (!fixes_pose(ground.weigh(options), options)) continue;
    ++fixed;
    const Gating gating(ground.filter, ground.ids, ground.scan, {});
    const auto assignment = association::associate(association::Method::likelihood_ratio, gating.problem, {});
    const OldPairs pairs = old_pairs_given(gating.problem, all_gated_pairs(gating.problem), {});
    const Matching best(assignment.pairs.begin(), assignment.pairs.end());
    Enumerated sum;
    Matching none;
    enumerate(pairs, best, foreign_in_scan / (core::pi * 900.0), 1.0 - std::exp(-options.integrity.missing_nats), 0,
              none, sum);
    EXPECT_LT(1.0 - sum.same / sum.all, 1e-2) << "seed " << seed;
  }
  EXPECT_GE(fixed, 50);
}

TEST(PlaceEvidence, TwinsAreNoQuestionOfThePose) {
  core::RandomStream random = place_stream(5);
  std::vector<Eigen::Vector2d> points_m = scattered_points(random, 30, 20.0);
  points_m.emplace_back(points_m[0] + Eigen::Vector2d(0.25, 0.0));
  Ground ground(std::move(points_m), 0.1, 0.002);
  std::vector<std::size_t> which(15);
  std::iota(which.begin(), which.end(), 0);
  ground.see({0.05, -0.05, 0.0}, which, random);
  EXPECT_TRUE(fixes_pose(ground.weigh({}), {}));
}

TEST(PlaceEvidence, AWorldThatIsNotThereDoesNotFixThePose) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    core::RandomStream random = place_stream(seed);
    Ground ground(scattered_points(random, 40, 25.0), 0.5, 0.01);
    const Ground other(scattered_points(random, 12, 20.0), 0.5, 0.01);
    Ground elsewhere = ground;
    elsewhere.points_m = other.points_m;
    std::vector<std::size_t> which(12);
    std::iota(which.begin(), which.end(), 0);
    elsewhere.see({}, which, random);
    EXPECT_FALSE(fixes_pose(elsewhere.weigh({}), {})) << "seed " << seed;
  }
}

TEST(PlaceEvidence, OneOldLandmarkInViewThatMayBeItsTwinIsOnePlace) {
  core::RandomStream random = place_stream(6);
  const std::vector<Eigen::Vector2d> far_apart{{8.0, 0.0}, {0.0, 9.0}, {-9.0, 1.0}, {1.0, -8.0}, {8.0, 0.5}};
  Ground ground(far_apart, 0.15, 0.002);
  ground.scan.field_of_view = {0.0, 30.0, -0.5, 0.5};
  ground.see({0.05, -0.05, 0.0}, {0}, random);
  const PlaceEvidence place = ground.weigh({});
  ASSERT_EQ(place.pairs, 1);
  EXPECT_FALSE(fixes_pose(place, {}));
  EXPECT_TRUE(leaves_one_place(place, {}));
}

TEST(PlaceEvidence, AWorldThatIsNotThereIsNotOnePlace) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    core::RandomStream random = place_stream(seed);
    Ground ground(scattered_points(random, 40, 25.0), 0.35, 0.01);
    const Ground other(scattered_points(random, 12, 20.0), 0.5, 0.01);
    ground.points_m = other.points_m;
    std::vector<std::size_t> which(12);
    std::iota(which.begin(), which.end(), 0);
    ground.see({}, which, random);
    EXPECT_FALSE(leaves_one_place(ground.weigh({}), {})) << "seed " << seed;
  }
}

TEST(PlaceEvidence, WithRoomForAnotherItIsNotOnePlace) {
  core::RandomStream random = place_stream(6);
  Ground ground({{8.0, 0.0}, {8.0, 2.0}, {8.0, -2.0}}, 0.6, 0.01);
  ground.see({0.1, -0.2, 0.0}, {0, 1}, random);
  EXPECT_FALSE(leaves_one_place(ground.weigh({}), {}));
}

TEST(PlaceEvidence, WhatIsAmbiguousWithinOnePlaceIsLeftUnused) {
  GatedScan gated;
  gated.returns.resize(2);
  gated.returns[0].landmark = 3;
  gated.returns[0].expected_confusers = 0.2;
  gated.returns[1].landmark = 5;
  gated.returns[1].expected_confusers = 0.01;
  leave_ambiguous_unused({}, gated);
  EXPECT_EQ(gated.place.loose, std::vector<core::LandmarkId>{3});
}

/// Six landmarks seen again right after they were mapped; others mapped before a drive of very uncertain odometry.
struct TornGround {
  Ground ground{{}, 0.0, 0.0};
  core::RandomStream random = place_stream(7);

  explicit TornGround(const std::vector<Eigen::Vector2d>& before) {
    add(before);
    core::Odometry odometry;
    odometry.covariance.diagonal() << 36.0, 36.0, 1e-4;
    ground.filter.predict(odometry);
    add({{10.0, 3.0}, {14.0, -6.0}, {-9.0, 8.0}, {-5.0, -12.0}, {3.0, 16.0}, {18.0, 9.0}});
    odometry.covariance.diagonal() << 1e-4, 1e-4, 1e-6;
    ground.filter.predict(odometry);
    const std::size_t last = ground.ids.size();
    ground.see({}, {last - 6, last - 5, last - 4, last - 3, last - 2, last - 1}, random);
  }

  void add(const std::vector<Eigen::Vector2d>& points_m) {
    for (const Eigen::Vector2d& point_m : points_m) {
      ground.points_m.push_back(point_m);
      ground.ids.push_back(
          ground.filter.augment(core::make_cartesian(point_m, 0.0025 * Eigen::Matrix2d::Identity()), {}));
    }
  }
};

GatedScan gated_with_place(const Ground& ground) {
  GatedScan gated = gate_scan(ground.filter, ground.ids, ground.scan, {});
  gated.place = place_evidence(ground.filter, gated.gating->problem, gated.assignment, ground.scan, ground.ids,
                               foreign_in_scan, 2.0, {});
  return gated;
}

TEST(PlaceEvidence, WhatIsKnownBesideOthersSaysNothingOfALandmarkFarFromThemAll) {
  TornGround torn({{2.0, -3.0}});
  torn.ground.see({1.0, 0.0, 0.0}, {0}, torn.random);  // spurious: it happens to be in a gate of tens of metres
  const GatedScan gated = gated_with_place(torn.ground);
  ASSERT_EQ(gated.place.pairs, 7);
  EXPECT_LT(gated.place.widening, 2.0);
  EXPECT_EQ(gated.place.loose, std::vector<core::LandmarkId>{torn.ground.ids.front()});
  EXPECT_TRUE(fixes_pose(gated.place, {}));
  Confirmation confirmation;
  const std::vector<core::AssociationReport> fate = associate_scan(gated, torn.ground.scan, {}, 0.0, confirmation);
  const auto outcomes = [&](core::Outcome outcome) {
    return std::count_if(fate.begin(), fate.end(), [&](const auto& one) { return one.outcome == outcome; });
  };
  EXPECT_EQ(outcomes(core::Outcome::matched), 6);
  EXPECT_EQ(outcomes(core::Outcome::ambiguous), 1);
}

TEST(PlaceEvidence, TwoThatHangLooseAreAPlaceInQuestion) {
  TornGround torn({{2.0, -3.0}, {-12.0, -3.0}});
  torn.ground.see({1.0, 0.0, 0.0}, {0, 1}, torn.random);
  const GatedScan gated = gated_with_place(torn.ground);
  ASSERT_EQ(gated.place.pairs, 8);
  EXPECT_EQ(gated.place.loose.size(), 2U);
  EXPECT_FALSE(fixes_pose(gated.place, {}));
}

}  // namespace
}  // namespace helixnav::supervisor
