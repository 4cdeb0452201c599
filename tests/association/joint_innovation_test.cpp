// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/association/joint_innovation.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "helixnav/core/errors.hpp"
#include "joint_shares.hpp"
#include "scenes.hpp"

namespace helixnav::association {
namespace {

/// H of one pair over the whole state, from core's model, padded with a zero row.
Eigen::MatrixXd dense_row(const Scene& scene, const GatedPair& pair) {
  const core::Observation& observation = scene.scan.observations[pair.observation];
  const core::PredictedObservation p = core::predict_observation(
      observation.kind, scene.map.pose, scene.scan.T_robot_sensor, scene.map.points_m[pair.candidate]);
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(2, scene.map.covariance.rows());
  H.block(0, 0, pair.dof, 3) = p.H_pose;
  H.block(0, 3 + 2 * pair.candidate, pair.dof, 2) = p.H_landmark;
  return H;
}

TEST(JointInnovation, EqualsDenseHPHtPlusRForMixedKindsAndSharedObservations) {
  core::RandomStream random(14, "joint");
  for (int t = 0; t < 200; ++t) {
    Scene scene = crowded_scene(random, 4, 6, 0.4, 4.0, true);
    scene.scan.T_robot_sensor = core::Pose2(0.3, -0.2, 0.1);
    const InnovationProblem problem = make_innovation_problem(scene.map, scene.scan);
    for (const GatedPair& a : problem.pairs) {
      for (const GatedPair& b : problem.pairs) {
        Eigen::Matrix2d expected = dense_row(scene, a) * scene.map.covariance * dense_row(scene, b).transpose();
        if (a.observation == b.observation) {
          const core::ObsMatrix& R = scene.scan.observations[a.observation].R;
          expected.topLeftCorner(R.rows(), R.cols()) += R;
          if (a.dof == 1) expected(1, 1) = 1.0;
        }
        ASSERT_LT((innovation_cross_covariance(problem, a, b) - expected).norm(), 1e-12);
      }
    }
  }
}

TEST(JointInnovation, NisAndSharesEqualThoseWithoutThePairAsPairsAreTakenOut) {
  core::RandomStream random(15, "shares");
  for (int t = 0; t < 200; ++t) {
    const Scene scene = crowded_scene(random, 5, 5, 0.2, 8.0, t % 2 == 1);
    const InnovationProblem problem = make_innovation_problem(scene.map, scene.scan);
    std::vector<int> pairs;
    for (const GatedObservation& o : problem.observations) {
      if (o.begin < o.end) pairs.push_back(o.begin);
    }
    const JointNis joint = joint_nis(problem, pairs);
    const JointInnovation dense = joint_innovation(problem, pairs);
    ASSERT_NEAR(joint.nis, dense.nu.dot(dense.S.inverse() * dense.nu), 1e-8 * (1.0 + joint.nis));
    if (!pairs.empty()) {
      const double log_likelihood =
          -0.5 * (joint.nis + std::log(dense.S.determinant()) + joint.dof * std::log(2.0 * core::pi));
      ASSERT_NEAR(joint.log_likelihood, log_likelihood, 1e-8);
    }
    if (pairs.empty()) continue;
    JointShares shares(problem, pairs);
    std::vector<int> rest = pairs;
    for (double nis = joint.nis; !rest.empty();) {
      for (const int pair : rest) {
        std::vector<int> others = rest;
        others.erase(std::find(others.begin(), others.end(), pair));
        ASSERT_NEAR(shares.of(static_cast<std::size_t>(std::find(pairs.begin(), pairs.end(), pair) - pairs.begin())),
                    nis - joint_nis(problem, others).nis, 1e-8 * (1.0 + joint.nis));
      }
      const std::size_t worst = shares.worst();
      rest.erase(std::find(rest.begin(), rest.end(), pairs[worst]));
      nis -= shares.drop(worst);
      ASSERT_NEAR(nis, joint_nis(problem, rest).nis, 1e-8 * (1.0 + joint.nis));
      ASSERT_EQ(shares.of(worst), 0.0);
    }
  }
}

TEST(JointInnovation, NamesTheLandmarksWhenTheJointCovarianceIsNotPositiveDefinite) {
  core::JointGaussian map;
  map.ids = {41, 42};
  map.points_m = {{10.0, 0.0}, {0.0, 10.0}};
  map.covariance = Eigen::MatrixXd::Identity(7, 7);
  map.covariance.block<2, 2>(3, 5) = 3.0 * Eigen::Matrix2d::Identity();  // more than the variances allow
  map.covariance.block<2, 2>(5, 3) = 3.0 * Eigen::Matrix2d::Identity();
  core::Scan scan;
  for (const Eigen::Vector2d& m : map.points_m) {
    scan.observations.push_back(core::make_cartesian(m, 1e-3 * Eigen::Matrix2d::Identity()));
  }
  const InnovationProblem problem = make_innovation_problem(map, scan);
  try {
    joint_nis(problem, {0, problem.observations[1].begin});
    FAIL() << "accepted";
  } catch (const core::NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("41"), std::string::npos);
  }
}

}  // namespace
}  // namespace helixnav::association
