// SPDX-License-Identifier: BSD-3-Clause
#include "placing/join_maps.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "helixnav/core/chi2.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/core/rigid_fit.hpp"
#include "placing/relative_covariance.hpp"

namespace helixnav::supervisor {
namespace {

constexpr double pair_noise_m = 0.1;
const core::Pose2 T_true(20.0, -7.0, 2.1);

Eigen::MatrixXd some_covariance(Eigen::Index n, double sigma, core::RandomStream& random) {
  Eigen::MatrixXd root(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = 0; i < n; ++i) root(i, j) = random.normal(0.0, sigma / std::sqrt(static_cast<double>(n)));
  }
  return root * root.transpose() + 0.1 * sigma * sigma * Eigen::MatrixXd::Identity(n, n);
}

/// The covariance that a common rigid motion gives to the pose and, after it, the points.
Eigen::MatrixXd moved_together(const std::vector<Eigen::Vector2d>& points_m, double sigma_m, double sigma_rad) {
  Eigen::MatrixXd B(3 + 2 * static_cast<Eigen::Index>(points_m.size()), 3);
  B.topRows<3>().setIdentity();
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    B.middleRows<2>(3 + 2 * static_cast<Eigen::Index>(i)) << 1.0, 0.0, -points_m[i].y(), 0.0, 1.0, points_m[i].x();
  }
  const double m2 = sigma_m * sigma_m;
  return B * Eigen::Vector3d(m2, m2, sigma_rad * sigma_rad).asDiagonal() * B.transpose();
}

Eigen::VectorXd drawn(const Eigen::MatrixXd& covariance, core::RandomStream& random) {
  Eigen::VectorXd white(covariance.rows());
  for (Eigen::Index i = 0; i < white.size(); ++i) white[i] = random.normal(0.0, 1.0);
  return covariance.llt().matrixL() * white;
}

/// The same eight points twice: as the session knows them, and as the map does. Names 0… and 100….
struct PlacedMaps {
  core::JointGaussian session, earlier;
  relocalize::Place place;

  explicit PlacedMaps(std::uint64_t seed) {
    core::RandomStream random(seed, "two maps");
    session.pose = core::Pose2(1.0, 2.0, 0.3);
    session.covariance = some_covariance(19, 0.03, random);
    earlier.covariance = some_covariance(19, 0.03, random);
    place.T_map_branch = T_true;
    for (int i = 0; i < 8; ++i) {
      const double x_m = random.uniform(-15.0, 15.0);
      const Eigen::Vector2d at_m(x_m, random.uniform(-15.0, 15.0));
      const double dx_m = random.normal(0.0, 0.03);
      const Eigen::Vector2d error_m(dx_m, random.normal(0.0, 0.03));
      session.ids.push_back(100 + i);
      session.points_m.push_back(at_m);
      earlier.ids.push_back(i);
      earlier.points_m.push_back(core::transform(T_true, at_m) + error_m);
      place.pairs.push_back({100 + i, i});
    }
    place.information = Eigen::Vector3d(800.0, 800.0, 8e4).asDiagonal();
  }
};

/// Least squares over both maps and the place: session, map and pairs are measurements, the place is free.
struct LeastSquares {
  Eigen::VectorXd x;           ///< place (3), session's pose (3), its points (16), the map's (16)
  Eigen::MatrixXd covariance;  ///< of it

  explicit LeastSquares(const PlacedMaps& maps) : x(38) {
    x << maps.place.T_map_branch.vector(), maps.session.pose.vector(), Eigen::VectorXd::Zero(32);
    for (int i = 0; i < 8; ++i) {
      x.segment<2>(6 + 2 * i) = maps.session.points_m[static_cast<std::size_t>(i)];
      x.segment<2>(22 + 2 * i) = maps.earlier.points_m[static_cast<std::size_t>(i)];
    }
    const Eigen::VectorXd told = x;
    Eigen::MatrixXd prior = Eigen::MatrixXd::Zero(38, 38);
    prior.block(3, 3, 19, 19) = maps.session.covariance.inverse();
    prior.block(22, 22, 16, 16) = maps.earlier.covariance.bottomRightCorner(16, 16).inverse();
    for (int iteration = 0; iteration < 20; ++iteration) {
      Eigen::MatrixXd H = prior;
      Eigen::VectorXd g = prior * (told - x);
      for (int i = 0; i < 8; ++i) add_pair(i, H, g);
      x += H.ldlt().solve(g);
      covariance = H.inverse();
    }
  }

  Eigen::Vector2d placed(int i) const {
    return core::transform(core::Pose2(Eigen::Vector3d(x.head<3>())), x.segment<2>(6 + 2 * i));
  }

 private:
  void add_pair(int i, Eigen::MatrixXd& H, Eigen::VectorXd& g) const {
    const Eigen::Matrix2d R = core::rotation(x[2]);
    const Eigen::Vector2d arm_m = R * x.segment<2>(6 + 2 * i);
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(2, 38);
    J.leftCols<3>() << 1.0, 0.0, -arm_m.y(), 0.0, 1.0, arm_m.x();
    J.middleCols<2>(6 + 2 * i) = R;
    J.middleCols<2>(22 + 2 * i) = -Eigen::Matrix2d::Identity();
    const Eigen::Vector2d r = x.segment<2>(22 + 2 * i) - placed(i);
    const double weight = 1.0 / (pair_noise_m * pair_noise_m);
    H += weight * J.transpose() * J;
    g += weight * J.transpose() * r;
  }
};

JoinedMaps join(const PlacedMaps& maps, const SearchOptions& options = {}) {
  const cekf::CompressedEkf session(maps.session, 200);
  return join_maps(session, maps.earlier, maps.place, maps.session.ids, {}, pair_noise_m, options);
}

TEST(JoinMaps, IsLeastSquaresOverBothMapsWithAFreePlace) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const PlacedMaps maps(seed);
    const JoinedMaps joined = join(maps);
    ASSERT_TRUE(joined.closing.accepted);
    ASSERT_EQ(joined.closing.merged.size(), 8u);
    const LeastSquares expected(maps);
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector2d difference_m = joined.filter.landmark_mean(i) - expected.x.segment<2>(22 + 2 * i);
      EXPECT_LT(difference_m.norm(), 2e-4) << "landmark " << i << " of seed " << seed;
    }
    const core::Pose2 pose = core::compose(core::Pose2(Eigen::Vector3d(expected.x.head<3>())),
                                           core::Pose2(Eigen::Vector3d(expected.x.segment<3>(3))));
    EXPECT_LT((joined.filter.pose().mean.position_m() - pose.position_m()).norm(), 5e-4);
    EXPECT_NEAR(core::wrap_to_pi(joined.filter.pose().mean.heading_rad - pose.heading_rad), 0.0, 1e-4)
        << "first order: 3 % of its σ";
  }
}

/// A session that does not know where the map is in its frame changes nothing in what is known about that. What is
/// common to all of the map is independent of the rest and no pair sees it, so it is added to the least-squares result
/// without it: one covariance of both would lose the digits of the rest.
TEST(JoinMaps, CovarianceIsThatOfAFreePlaceHoweverUncertainTheMap) {
  for (const double sigma_m : {0.01, 0.1, 20.0, 300.0, 1000.0}) {
    PlacedMaps maps(9);
    Eigen::MatrixXd exact = LeastSquares(maps).covariance.bottomRightCorner<16, 16>();
    const Eigen::MatrixXd common = moved_together(maps.earlier.points_m, sigma_m, 0.1);
    exact += common.bottomRightCorner<16, 16>();
    maps.earlier.covariance += common;
    const JoinedMaps joined = join(maps);
    ASSERT_TRUE(joined.closing.accepted) << sigma_m;
    ASSERT_EQ(joined.closing.merged.size(), 8u);
    const Eigen::MatrixXd got = joined.filter.joint(joined.filter.landmarks()).covariance.bottomRightCorner<16, 16>();
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ratio(got, exact, Eigen::EigenvaluesOnly);
    EXPECT_GT(ratio.eigenvalues().minCoeff(), 0.92) << "map known to " << sigma_m << " m";
    EXPECT_LT(ratio.eigenvalues().maxCoeff(), 1.08) << "map known to " << sigma_m << " m";
  }
}

/// Map and session drawn about the truth, the map displaced by 20 m and 0.01 rad as its covariance says.
TEST(JoinMaps, IsConsistentOnAMapThatLiesElsewhereThanItSays) {
  constexpr int runs = 60;
  double nees = 0.0;
  for (int run = 0; run < runs; ++run) {
    PlacedMaps maps(static_cast<std::uint64_t>(100 + run));
    std::vector<Eigen::Vector2d> true_m;
    for (const Eigen::Vector2d& at_m : maps.session.points_m) true_m.push_back(core::transform(T_true, at_m));
    maps.earlier.covariance += moved_together(true_m, 20.0, 0.01);
    core::RandomStream random(static_cast<std::uint64_t>(run), "errors");
    const Eigen::VectorXd of_map = drawn(maps.earlier.covariance, random);
    const Eigen::VectorXd of_session = drawn(maps.session.covariance, random);
    for (std::size_t i = 0; i < 8; ++i) {
      const auto row = 3 + 2 * static_cast<Eigen::Index>(i);
      maps.earlier.points_m[i] = true_m[i] + of_map.segment<2>(row);
      maps.session.points_m[i] += of_session.segment<2>(row);
    }
    maps.place.T_map_branch = core::fit_rigidly(maps.earlier.points_m, maps.session.points_m);
    const JoinedMaps joined = join(maps);
    ASSERT_TRUE(joined.closing.accepted);
    Eigen::VectorXd error(16);
    for (int i = 0; i < 8; ++i) {
      error.segment<2>(2 * i) = joined.filter.landmark_mean(i) - true_m[static_cast<std::size_t>(i)];
    }
    const Eigen::MatrixXd P = joined.filter.joint(joined.filter.landmarks()).covariance.bottomRightCorner<16, 16>();
    nees += error.dot(P.llt().solve(error));
  }
  EXPECT_LT(nees, core::chi2_quantile(0.999, 16 * runs));
}

/// Three coordinates of the pairs go into the place, about which nothing else is known. Two-sided, false alarm 1 in 1000; with as
/// many degrees of freedom as coordinates the mean would be 16 of 13.
TEST(JoinMaps, TheCostOfPairsHasTheDegreesOfFreedomThatAFreePlaceLeaves) {
  constexpr int runs = 300;
  double cost = 0.0;
  int dof = 0;
  for (int run = 0; run < runs; ++run) {
    PlacedMaps maps(static_cast<std::uint64_t>(1000 + run));
    core::RandomStream random(static_cast<std::uint64_t>(run), "errors of pairs");
    const Eigen::VectorXd of_map = drawn(maps.earlier.covariance, random);
    const Eigen::VectorXd of_session = drawn(maps.session.covariance, random);
    for (std::size_t i = 0; i < 8; ++i) {
      const auto row = 3 + 2 * static_cast<Eigen::Index>(i);
      const double dx_m = random.normal(0.0, pair_noise_m);
      const Eigen::Vector2d of_pair_m(dx_m, random.normal(0.0, pair_noise_m));
      maps.earlier.points_m[i] = core::transform(T_true, maps.session.points_m[i]) + of_map.segment<2>(row) + of_pair_m;
      maps.session.points_m[i] += of_session.segment<2>(row);
    }
    maps.place.T_map_branch = core::fit_rigidly(maps.earlier.points_m, maps.session.points_m);
    const JoinedMaps joined = join(maps);
    cost += joined.closing.cost;
    dof += joined.closing.dof;
    if (joined.closing.dropped == 0) {
      EXPECT_EQ(joined.closing.dof, 2 * 8 - 3);
    }
  }
  EXPECT_GT(cost, core::chi2_quantile(0.0005, dof));
  EXPECT_LT(cost, core::chi2_quantile(0.9995, dof));
}

TEST(JoinMaps, KeepsTheNamesOfTheEarlierMapAndGivesNoneTwice) {
  const JoinedMaps joined = join(PlacedMaps(4));
  EXPECT_EQ(joined.filter.landmarks(), (std::vector<core::LandmarkId>{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(joined.filter.next_name(), 200);
}

TEST(JoinMaps, PairsThatContradictEachOtherAreRefused) {
  PlacedMaps maps(5);
  for (std::size_t i = 0; i < 4; ++i) maps.earlier.points_m[i].x() += i % 2 == 0 ? 1.0 : -1.0;
  const JoinedMaps joined = join(maps);
  EXPECT_FALSE(joined.closing.accepted);
  EXPECT_GT(joined.closing.cost, joined.closing.limit);
  EXPECT_EQ(joined.filter.mapped_count(), 16);
}

TEST(JoinMaps, OneWrongPairOfEightIsDropped) {
  PlacedMaps maps(6);
  maps.earlier.points_m[3].y() += 2.0;
  const JoinedMaps joined = join(maps);
  EXPECT_TRUE(joined.closing.accepted);
  EXPECT_EQ(joined.closing.dropped, 1);
  EXPECT_TRUE(joined.filter.contains(103));
  EXPECT_TRUE(joined.filter.contains(3));
}

TEST(JoinMaps, WhatTheQuestionLeftOutIsMergedAfterwards) {
  PlacedMaps maps(7);
  maps.place.pairs.resize(6);
  EXPECT_EQ(join(maps).closing.merged.size(), 8u);
}

/// A drive past landmarks 12 m apart, placed by the last five: the farther back, the more its odometry has drifted from there.
PlacedMaps placed_late(int landmarks, double drift_m, std::uint64_t seed) {
  core::RandomStream random(seed, "placed late");
  PlacedMaps maps(seed);
  const Eigen::Index n = 3 + 2 * landmarks;
  maps.session.ids.clear();
  maps.session.points_m.clear();
  maps.session.covariance = 0.01 * Eigen::MatrixXd::Identity(n, n);
  maps.earlier = maps.session;
  maps.earlier.pose = {};
  maps.place.pairs.clear();
  const int placed_from = landmarks - 5;
  Eigen::Vector2d error_m(0.0, 0.0);
  for (int i = landmarks - 1; i >= 0; --i) {
    const Eigen::Vector2d at_m(12.0 * i, i % 2 == 0 ? -3.0 : 3.0);
    if (i < placed_from) error_m += Eigen::Vector2d(random.normal(0.0, drift_m), random.normal(0.0, drift_m));
    maps.session.ids.insert(maps.session.ids.begin(), 100 + i);
    maps.session.points_m.insert(maps.session.points_m.begin(), at_m + error_m);
    maps.earlier.ids.insert(maps.earlier.ids.begin(), i);
    maps.earlier.points_m.insert(maps.earlier.points_m.begin(), core::transform(T_true, at_m));
    if (i >= placed_from) maps.place.pairs.push_back({100 + i, i});
    for (int k = 0; k < placed_from; ++k) {
      const double common_m2 = drift_m * drift_m * std::max(0, placed_from - std::max(i, k));
      maps.session.covariance.block<2, 2>(3 + 2 * i, 3 + 2 * k) += common_m2 * Eigen::Matrix2d::Identity();
    }
  }
  return maps;
}

TEST(JoinMaps, WhatWasMappedLongBeforeThePlaceIsMergedFromThereOn) {
  const JoinedMaps joined = join(placed_late(20, 1.4, 11));
  ASSERT_TRUE(joined.closing.accepted);
  for (const core::MergedLandmarks& one : joined.closing.merged) EXPECT_EQ(one.removed, 100 + one.kept);
  EXPECT_EQ(joined.closing.merged.size(), 20u);
}

// If the drift from one landmark to the next is as large as their spacing, none is merged rather than a wrong one.
TEST(JoinMaps, WhatMayBeANeighboursStaysTwice) {
  const JoinedMaps joined = join(placed_late(20, 5.0, 12));
  ASSERT_TRUE(joined.closing.accepted);
  for (const core::MergedLandmarks& one : joined.closing.merged) EXPECT_EQ(one.removed, 100 + one.kept);
  EXPECT_LT(joined.closing.merged.size(), 12u);
}

TEST(RelativeCovariance, CommonMotionLeavesNothing) {
  core::RandomStream random(8, "relative");
  std::vector<Eigen::Vector2d> points_m;
  Eigen::MatrixXd B(20, 3);
  for (int i = 0; i < 10; ++i) {
    const double x_m = random.uniform(0.0, 20.0);
    points_m.emplace_back(x_m, random.uniform(0.0, 20.0));
    B.middleRows<2>(2 * i) << 1.0, 0.0, -points_m.back().y(), 0.0, 1.0, points_m.back().x();
  }
  const Eigen::MatrixXd common = B * Eigen::Vector3d(4.0, 9.0, 0.01).asDiagonal() * B.transpose();
  for (const Eigen::Matrix2d& own : relative_covariances(points_m, common)) EXPECT_LT(own.norm(), 1e-9);
  const Eigen::MatrixXd both = common + 0.04 * Eigen::MatrixXd::Identity(20, 20);
  double trace = 0.0;
  for (const Eigen::Matrix2d& own : relative_covariances(points_m, both)) trace += own.trace();
  EXPECT_NEAR(trace, 0.04 * 17, 1e-9) << "20 coordinates less the three that they have in common";
  EXPECT_EQ(relative_covariances({points_m[0]}, common.topLeftCorner(2, 2))[0], Eigen::Matrix2d::Zero());
}

}  // namespace
}  // namespace helixnav::supervisor
