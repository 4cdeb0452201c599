// SPDX-License-Identifier: BSD-3-Clause
// Evidence of slips, the places found for them, and what is believed.
#include "slip/slip_decision.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "helixnav/core/random.hpp"
#include "slip/density_of_new.hpp"
#include "slip/slip_record.hpp"
#include "slip_scene.hpp"

namespace helixnav::supervisor {
namespace {

std::optional<Slip> decide(const SlipScene& scene, std::vector<PointPair> associated = {}) {
  const std::vector<double> new_per_m2(scene.seen.size(), extraneous_per_m2);
  return decide_slip(
      {scene.geometry, scene.seen, new_per_m2, std::move(associated), a_pair_nats, extraneous_per_m2, false},
      SlipOptions{});
}

double log_normal(const Eigen::VectorXd& nu, const Eigen::MatrixXd& S) {
  return -0.5 * (nu.dot(S.inverse() * nu) + std::log((2.0 * core::pi * S).determinant()));
}

/// ∫ N(δ; 0, Q) N(residual(δ); 0, S(δ)) dδ over a grid around the best δ.
double integrate(const SlipScene& scene, const std::vector<PointPair>& pairs, const SlipComponent& component,
                 const SlipExplanation& around) {
  const Eigen::Vector3d sigma = around.displacement_covariance.diagonal().cwiseSqrt();
  constexpr int half = 9;
  constexpr double step = 5.0 / half;
  double sum = 0.0;
  const double offset = around.nats;
  for (int i = -half; i <= half; ++i) {
    for (int j = -half; j <= half; ++j) {
      for (int k = -half; k <= half; ++k) {
        const Eigen::Vector3d at = around.displacement + step * sigma.cwiseProduct(Eigen::Vector3d(i, j, k));
        const PairEquations e(scene.geometry, scene.seen, pairs, at);
        sum += std::exp(log_normal(at, component.covariance()) + log_normal(e.nu - e.A * at, e.S) - offset);
      }
    }
  }
  return offset + std::log(sum * step * step * step * sigma.prod());
}

TEST(SlipEvidence, IsTheIntegralOverAllSlips) {
  const SlipComponent component{0.5, 4.0 * degree, 0.01};
  for (const std::uint64_t seed : {1, 2, 3}) {
    const SlipScene scene(scattered(seed, 4), {0.4, -0.3, 3.0 * degree}, seed);
    const std::vector<PointPair> pairs = all_pairs(4);
    const SlipExplanation found =
        explain_by_slip(scene.geometry, scene.seen, pairs, 0.0, {component}, Eigen::Vector3d::Zero());
    SlipExplanation around = found;
    around.nats -= std::log(component.probability);
    EXPECT_NEAR(around.nats, integrate(scene, pairs, component, around), 0.05) << seed;
  }
}

TEST(SlipEvidence, ChargesAWidePriorForWhatItMightHaveExplained) {
  const SlipScene scene(scattered(4), {0.1, 0.05, 0.5 * degree}, 4);
  const auto nats = [&](double factor) {
    const std::vector<SlipComponent> one{{0.1 * factor, degree * factor, 1.0}};
    return explain_by_slip(scene.geometry, scene.seen, all_pairs(8), 0.0, one, Eigen::Vector3d::Zero()).nats;
  };
  EXPECT_NEAR(nats(10.0) - nats(100.0), 3.0 * std::log(10.0), 0.3) << "three dimensions, each ten times as wide";
}

TEST(SlipEvidence, WithoutASlipIsThatOfTheInnovation) {
  const SlipScene scene(scattered(5), Eigen::Vector3d::Zero(), 5);
  const PairEquations e(scene.geometry, scene.seen, all_pairs(8), Eigen::Vector3d::Zero());
  EXPECT_NEAR(explain_without_slip(scene.geometry, scene.seen, all_pairs(8), 2.0), 16.0 + log_normal(e.nu, e.S), 1e-9);
  EXPECT_EQ(explain_without_slip(scene.geometry, scene.seen, {}, 2.0), 0.0);
}

TEST(SlipDecision, FindsWhereTheVehicleSlippedTo) {
  core::RandomStream random(1, "slips");
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Eigen::Vector3d truth(random.uniform(-0.7, 0.7), random.uniform(0.3, 0.7), random.uniform(-0.08, 0.08));
    const SlipScene scene(scattered(seed), truth, seed);
    const std::optional<Slip> slip = decide(scene);
    ASSERT_TRUE(slip) << seed;
    EXPECT_EQ(slip->figures.pairs, 8) << seed;
    for (const SlipPair& pair : slip->pairs) EXPECT_EQ(pair.landmark, 100 + pair.observation) << seed;
    EXPECT_LT((slip->displacement - truth).head<2>().norm(), 0.25) << seed;
    EXPECT_NEAR(slip->displacement.z(), truth.z(), 1.5 * degree) << seed;
    EXPECT_GT(slip->figures.nats, 8.0);
  }
}

TEST(SlipDecision, BelievesNoneWhereTheVehicleIsAsPredicted) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const SlipScene scene(scattered(seed), Eigen::Vector3d::Zero(), seed);
    EXPECT_FALSE(decide(scene, all_pairs(8))) << seed;
    EXPECT_FALSE(decide(scene, {{0, 0}, {1, 1}, {2, 2}})) << seed << ": pairs dropped by a joint test are no slip";
  }
}

std::vector<Eigen::Vector2d> lattice(double pitch_m, int columns) {
  std::vector<Eigen::Vector2d> points_m;
  for (int i = 0; i < columns; ++i) {
    for (int k = 0; k < 4; ++k) points_m.emplace_back(3.0 + pitch_m * i, pitch_m * (k - 1.5));
  }
  return points_m;
}

TEST(SlipDecision, FindsALargeSlipWhereTheMapIsIrregular) {
  core::RandomStream random(2, "large slips");
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Eigen::Vector3d truth(random.uniform(1.5, 3.0), random.uniform(-2.0, 2.0), random.uniform(-0.2, 0.2));
    const std::optional<Slip> slip = decide(SlipScene(scattered(seed, 12), truth, seed));
    ASSERT_TRUE(slip) << seed;
    EXPECT_LT((slip->displacement - truth).head<2>().norm(), 0.3) << seed;
  }
}

TEST(SlipDecision, BelievesNoneInALatticeThatLooksLikeOneMovedByAPitch) {
  EXPECT_TRUE(decide(SlipScene(lattice(4.0, 4), {0.8, 0.0, 0.0}, 1)));
  EXPECT_FALSE(decide(SlipScene(lattice(4.0, 4), {4.0, 0.0, 0.0}, 2)));
  EXPECT_FALSE(decide(SlipScene(lattice(4.0, 4), {2.4, 0.0, 0.0}, 3)));
}

TEST(SlipDecision, TakesANewRowOfALatticeForNoSlip) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SlipScene scene(lattice(5.0, 5), Eigen::Vector3d::Zero(), seed);
    scene.geometry = RelativeGeometry(SlipScene::joint_of(lattice(5.0, 4)));
    EXPECT_FALSE(decide(scene, all_pairs(16))) << seed << ": four of a new row, where a slip by a pitch wants old ones";
  }
}

TEST(SlipDecision, TakesASlipOfAPitchForNoneWhereItsRivalIsToSeeNewRows) {
  SlipScene scene(lattice(4.0, 6), {0.7, 0.0, 0.0}, 1);
  scene.geometry = RelativeGeometry(SlipScene::joint_of(lattice(4.0, 5)));
  const std::optional<Slip> slip = decide(scene);
  EXPECT_TRUE(!slip || slip->displacement.head<2>().norm() < 1.0)
      << "four trees of a new row fit a slip by 3.3 m the other way, too";
}

TEST(SlipDecision, NeedsMoreEvidenceFromFewOrTentativeLandmarks) {
  const SlipScene three(scattered(3, 3), {0.5, 0.3, 2.0 * degree}, 3);
  const std::vector<double> new_per_m2(three.seen.size(), extraneous_per_m2);
  SlipQuestion question{three.geometry, three.seen, new_per_m2, {}, a_pair_nats, extraneous_per_m2, false};
  SlipOptions options;
  options.few_pairs_nats = 0.0;
  const std::optional<Slip> slip = decide_slip(question, options);
  ASSERT_TRUE(slip);
  EXPECT_EQ(slip->figures.pairs, 3);
  for (const double more : {-0.01, 0.01}) {
    options.few_pairs_nats = slip->figures.nats + more;
    EXPECT_EQ(decide_slip(question, options).has_value(), more < 0.0);
  }
  EXPECT_GT(SlipOptions{}.few_pairs_nats, SlipOptions{}.nats);
  question.tentative = true;
  EXPECT_FALSE(decide_slip(question, SlipOptions{}));
}

// A vehicle that turns into the next row of an avenue sees new trees, as densely spaced as the known ones.
TEST(SlipDecision, WeighsFewPairsLessWhereNobodyHasLookedYet) {
  const SlipScene scene(scattered(6, 4), {2.5, 1.0, 8.0 * degree}, 6);
  const std::optional<Slip> on_known_ground = decide(scene);
  ASSERT_TRUE(on_known_ground);
  SlipQuestion question{scene.geometry, scene.seen, {}, {}, a_pair_nats, extraneous_per_m2, false};
  constexpr double denser = 12.0;
  question.new_per_m2.assign(scene.seen.size(), denser * extraneous_per_m2);
  const std::optional<Slip> on_new_ground = decide_slip(question, SlipOptions{});
  const double nats = on_known_ground->figures.nats - 4.0 * std::log(denser);
  EXPECT_EQ(on_new_ground.has_value(), nats > SlipOptions{}.nats);
  if (on_new_ground) {
    EXPECT_NEAR(on_new_ground->figures.nats, nats, 1e-9);
  }
}

pf_relocalize::Coverage looked_at_along(double length_m) {
  pf_relocalize::Coverage coverage;
  coverage.field_of_view = {0.0, 30.0, -0.8, 0.8, 0.0};
  for (double x_m = 0.0; x_m <= length_m; x_m += 4.0) coverage.T_frame_sensor.emplace_back(x_m, 0.0, 0.0);
  coverage.least_views = 2;
  return coverage;
}

TEST(DensityOfNew, IsThatOfTheMapWhereNobodyHasLooked) {
  const std::vector<SeenPoint> seen = {{0, {15.0, 0.0}, Eigen::Matrix2d::Identity()},
                                       {1, {15.0, 40.0}, Eigen::Matrix2d::Identity()}};
  const std::vector<double> per_m2 = density_of_new(seen, core::Pose2(), looked_at_along(12.0), 0.02, 0.001);
  EXPECT_EQ(per_m2, (std::vector<double>{0.001, 0.02}));
}

TEST(DensityOfNew, OfALatticeIsOneInASquareAndSecondStemsChangeLittle) {
  std::vector<Eigen::Vector2d> points_m = lattice(8.0, 6);
  EXPECT_NEAR(local_density_per_m2(points_m), 1.0 / 64.0, 0.1 / 64.0);
  for (std::size_t i = 0; i < 24; ++i) points_m.push_back(points_m[i] + Eigen::Vector2d(0.5, 0.0));
  EXPECT_NEAR(local_density_per_m2(points_m), 1.0 / 64.0, 0.2 / 64.0);
  EXPECT_EQ(local_density_per_m2({{0.0, 0.0}, {1.0, 0.0}, {2.0, 0.0}}), 0.0);
}

TEST(SlipRecord, ExpectsSlipsWhereNoneCanBeSeenOnceThereWereTwo) {
  SlipRecord record;
  record.see(5);
  EXPECT_TRUE(record.drive(300.0, 60.0).isZero());
  record.add({0.6, 0.0, 0.05});
  record.see(0);
  EXPECT_TRUE(record.drive(10.0, 60.0).isZero()) << "one slip is no habit";
  record.add({0.0, 0.6, 0.05});
  const Eigen::Matrix3d expected = record.drive(150.0, 60.0);
  EXPECT_NEAR(expected(0, 0), 0.5 * 0.5 * 2.0 * 0.36, 1e-12) << "one more slip half the time";
  EXPECT_NEAR(expected(2, 2), 0.5 * 2.0 * 0.0025, 1e-12);
  record.see(3);
  EXPECT_TRUE(record.drive(10.0, 60.0).isZero()) << "they would be seen";
}

}  // namespace
}  // namespace helixnav::supervisor
