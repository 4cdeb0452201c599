// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/association/innovation_problem.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "helixnav/association/associate.hpp"
#include "helixnav/core/errors.hpp"
#include "scenes.hpp"

namespace helixnav::association {
namespace {

TEST(InnovationProblem, HoldsExactlyThePairsInsideTheGateWithTheirNumbers) {
  core::RandomStream random(16, "gating");
  const Gates gates;
  for (int t = 0; t < 300; ++t) {
    const Scene scene = crowded_scene(random, 6, 12, 0.3, 10.0, true);
    const InnovationProblem problem = make_innovation_problem(scene.map, scene.scan, gates);
    std::size_t next = 0;
    std::size_t inside = 0;
    for (std::size_t i = 0; i < scene.scan.observations.size(); ++i) {
      const core::Observation& observation = scene.scan.observations[i];
      const int d = core::dimension(observation.kind);
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t j = 0; j < scene.map.ids.size(); ++j) {
        const auto p = core::predict_observation(observation.kind, scene.map.pose, {}, scene.map.points_m[j]);
        Eigen::MatrixXd H = Eigen::MatrixXd::Zero(d, scene.map.covariance.rows());
        H.leftCols(3) = p.H_pose;
        H.middleCols(3 + 2 * static_cast<int>(j), 2) = p.H_landmark;
        const Eigen::MatrixXd S = H * scene.map.covariance * H.transpose() + observation.R;
        const Eigen::VectorXd nu = core::innovation(observation.kind, observation.z, p.z_hat);
        const double nis = nu.dot(S.inverse() * nu);
        nearest = std::min(nearest, nis);
        if (nis > core::chi2_quantile(gates.match_probability, d)) continue;
        ++inside;
        const auto same = [&](const GatedPair& pair) {
          return pair.observation == static_cast<int>(i) && pair.candidate == static_cast<int>(j);
        };
        const auto pair = std::find_if(problem.pairs.begin(), problem.pairs.end(), same);
        ASSERT_NE(pair, problem.pairs.end());
        EXPECT_LT((pair->nu.head(d) - nu).norm(), 1e-12);
        EXPECT_LT((pair->S.topLeftCorner(d, d) - S).norm(), 1e-12);
        EXPECT_NEAR(pair->nis, nis, 1e-9);
        EXPECT_NEAR(pair->log_likelihood, -0.5 * (nis + std::log((2.0 * core::pi * S).determinant())), 1e-9);
      }
      const GatedObservation& gated = problem.observations[i];
      ASSERT_EQ(static_cast<std::size_t>(gated.begin), next);
      next = static_cast<std::size_t>(gated.end);
      if (nearest <= core::chi2_quantile(gates.new_probability, d)) {
        EXPECT_NEAR(gated.nearest_nis, nearest, 1e-9);
      } else {
        EXPECT_TRUE(std::isinf(gated.nearest_nis));
      }
    }
    ASSERT_EQ(problem.pairs.size(), inside);
  }
}

TEST(InnovationProblem, OfAKnownPoseEqualsAJointGaussianWithoutCorrelations) {
  core::RandomStream random(17, "particle");
  Scene scene = crowded_scene(random, 6, 8, 0.3, 4.0, true);
  std::vector<core::PointGaussian> landmarks;
  Eigen::MatrixXd P = Eigen::MatrixXd::Zero(19, 19);
  for (int j = 0; j < 8; ++j) {
    P.block<2, 2>(3 + 2 * j, 3 + 2 * j) = scene.map.covariance.block<2, 2>(3 + 2 * j, 3 + 2 * j);
    landmarks.push_back({scene.map.points_m[j], P.block<2, 2>(3 + 2 * j, 3 + 2 * j)});
  }
  scene.map.covariance = P;
  const InnovationProblem joint = make_innovation_problem(scene.map, scene.scan);
  const InnovationProblem known = make_innovation_problem(scene.map.pose, scene.map.ids, landmarks, scene.scan);
  ASSERT_EQ(joint.pairs.size(), known.pairs.size());
  ASSERT_GT(joint.pairs.size(), 0u);
  for (std::size_t p = 0; p < joint.pairs.size(); ++p) {
    EXPECT_NEAR(joint.pairs[p].nis, known.pairs[p].nis, 1e-10);
  }
  for (const Method method : {Method::nearest_neighbour, Method::likelihood_ratio, Method::jcbb}) {
    EXPECT_EQ(associate(method, joint).pairs, associate(method, known).pairs);
    EXPECT_NEAR(associate(method, joint).joint_nis, associate(method, known).joint_nis, 1e-9);
  }
}

TEST(InnovationProblem, LeavesOutALandmarkThatStandsAtTheSensor) {
  core::JointGaussian map;
  map.ids = {0};
  map.points_m = {{0.0, 0.0}};
  map.covariance = Eigen::MatrixXd::Identity(5, 5);
  core::Scan scan;
  scan.observations = {core::make_range_bearing(5.0, 0.0, 0.1, 0.02)};
  EXPECT_EQ(associate(Method::likelihood_ratio, make_innovation_problem(map, scan)).observations[0].outcome,
            Outcome::new_landmark);
}

class BadInput : public ::testing::Test {
 protected:
  BadInput() {
    map.ids = {5};
    map.points_m = {{10.0, 0.0}};
    map.covariance = Eigen::MatrixXd::Identity(5, 5) * 0.01;
    scan.observations = {core::make_range_bearing(10.0, 0.0, 0.1, 0.02)};
  }
  core::JointGaussian map;
  core::Scan scan;
};

TEST_F(BadInput, ObservationsThatAreNoNumbersAreRefused) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    core::Scan broken = scan;
    broken.observations[0].z[1] = bad;
    EXPECT_THROW(make_innovation_problem(map, broken), core::PreconditionError);
    broken = scan;
    broken.observations[0].R(0, 0) = bad;
    EXPECT_THROW(make_innovation_problem(map, broken), core::PreconditionError);
  }
  core::Scan indefinite = scan;
  indefinite.observations[0].R << 1.0, 2.0, 2.0, 1.0;
  EXPECT_THROW(make_innovation_problem(map, indefinite), core::PreconditionError);
}

TEST_F(BadInput, AnInnovationCovarianceThatIsNotPositiveDefiniteIsNamed) {
  map.covariance = -map.covariance;
  try {
    make_innovation_problem(map, scan);
    FAIL() << "accepted";
  } catch (const core::NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("observation 0 and landmark 5"), std::string::npos) << error.what();
  }
  map.covariance.setConstant(std::nan(""));
  EXPECT_THROW(make_innovation_problem(map, scan), core::NumericalError);
}

TEST_F(BadInput, ShapesAndGatesThatDoNotFitAreRefused) {
  core::JointGaussian wrong = map;
  wrong.covariance = Eigen::MatrixXd::Identity(4, 4);
  EXPECT_THROW(make_innovation_problem(wrong, scan), core::PreconditionError);
  wrong = map;
  wrong.points_m.clear();
  EXPECT_THROW(make_innovation_problem(wrong, scan), core::PreconditionError);
  for (const Gates& gates : {Gates{0.0, 0.9}, Gates{0.9, 1.0}, Gates{0.99, 0.9}, Gates{std::nan(""), 0.9}}) {
    EXPECT_THROW(make_innovation_problem(map, scan, gates), core::PreconditionError);
  }
}

TEST_F(BadInput, AScanOfThreeHundredObservationsEndsWithAnAnswer) {
  core::RandomStream random(18, "large");
  const Scene scene = crowded_scene(random, 150, 150, 0.2, 30.0);
  const InnovationProblem problem = make_innovation_problem(scene.map, scene.scan);
  Options options;
  options.node_budget = 2000;
  for (const Method method :
       {Method::nearest_neighbour, Method::likelihood_ratio, Method::jcbb, Method::ihgr_likelihood_ratio}) {
    EXPECT_EQ(associate(method, problem, options).observations.size(), 150u);
  }
}

}  // namespace
}  // namespace helixnav::association
