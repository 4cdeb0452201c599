// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/smoothing/marginals.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numeric>

#include "helixnav/core/errors.hpp"
#include "helixnav/smoothing/minimum.hpp"
#include "normal_equations.hpp"
#include "random_problem.hpp"

namespace helixnav::smoothing {
namespace {

using testing::random_problem;

Eigen::MatrixXd dense_inverse(const Problem& problem, const Layout& layout) {
  NormalEquations equations(problem, layout, {});
  equations.linearize(state_of(problem.graph));
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(layout.columns, layout.columns);
  for (int c = 0; c < layout.columns; ++c) {
    for (int k = equations.column_start[static_cast<std::size_t>(c)];
         k < equations.column_start[static_cast<std::size_t>(c) + 1]; ++k) {
      H(equations.row_index[static_cast<std::size_t>(k)], c) = H(c, equations.row_index[static_cast<std::size_t>(k)]) =
          equations.values[static_cast<std::size_t>(k)];
    }
  }
  return H.inverse();
}

std::vector<int> all(std::size_t n) {
  std::vector<int> indices(n);
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

class MarginalsOf : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(MarginalsOf, EqualTheDenseInverse) {
  const Problem problem = random_problem(GetParam(), {80, 30, 1.0}).problem;
  const Layout layout = make_layout(problem);
  const Eigen::MatrixXd P = dense_inverse(problem, layout);
  const MarginalCovariances marginals =
      marginal_covariances(problem, all(problem.graph.poses.size()), all(problem.graph.landmarks.size()));
  EXPECT_EQ(marginals.poses[0], Eigen::Matrix3d::Zero());
  for (std::size_t i = 1; i < marginals.poses.size(); ++i) {
    const Eigen::Matrix3d exact = P.block<3, 3>(layout.pose_column[i], layout.pose_column[i]);
    EXPECT_LE((marginals.poses[i] - exact).norm(), 1e-9 * exact.norm());
  }
  for (std::size_t i = 0; i < marginals.landmarks.size(); ++i) {
    const Eigen::Matrix2d exact = P.block<2, 2>(layout.landmark_column[i], layout.landmark_column[i]);
    EXPECT_LE((marginals.landmarks[i] - exact).norm(), 1e-9 * exact.norm());
  }
}

TEST_P(MarginalsOf, AFewChosenEqualThoseAmongAll) {
  const Problem problem = random_problem(GetParam(), {80, 30, 1.0}).problem;
  const auto everything = landmark_covariances(problem);
  const MarginalCovariances chosen = marginal_covariances(problem, {0, 17}, {29, 4});
  EXPECT_EQ(chosen.poses.size(), 2u);
  EXPECT_EQ(chosen.landmarks[0], everything[29]);
  EXPECT_EQ(chosen.landmarks[1], everything[4]);
}

TEST_P(MarginalsOf, JointCovarianceEqualsTheDenseInverse) {
  const Problem problem = random_problem(GetParam(), {40, 15, 1.0}).problem;
  const Layout layout = make_layout(problem);
  const Eigen::MatrixXd P = dense_inverse(problem, layout);
  const Eigen::MatrixXd joint = joint_covariance(problem, {0, 12}, {3, 9});
  ASSERT_EQ(joint.rows(), 10);
  EXPECT_TRUE(joint.topRows<3>().isZero(0.0));
  const int pose = layout.pose_column[12];
  const int landmark = layout.landmark_column[9];
  const double scale = P.norm();
  EXPECT_LE((joint.block<3, 3>(3, 3) - P.block<3, 3>(pose, pose)).norm(), 1e-9 * scale);
  EXPECT_LE((joint.block<3, 2>(3, 8) - P.block<3, 2>(pose, landmark)).norm(), 1e-9 * scale);
  EXPECT_LE((joint.block<2, 2>(8, 8) - P.block<2, 2>(landmark, landmark)).norm(), 1e-9 * scale);
}

// All variables, so that the factor has wide blocks as well as narrow ones; and a selection in an order and with
// repetitions chosen by the caller.
TEST_P(MarginalsOf, JointCovarianceOfAllEqualsTheDenseInverse) {
  const Problem problem = random_problem(GetParam(), {60, 50, 1.0}).problem;
  const Layout layout = make_layout(problem);
  const Eigen::MatrixXd P = dense_inverse(problem, layout);
  const std::vector<int> poses = all(problem.graph.poses.size());
  const std::vector<int> landmarks = all(problem.graph.landmarks.size());
  const Eigen::MatrixXd joint = joint_covariance(problem, poses, landmarks);
  ASSERT_EQ(joint.rows(), layout.columns + 3);
  EXPECT_TRUE(joint.topRows<3>().isZero(0.0));
  EXPECT_LE((joint.bottomRightCorner(layout.columns, layout.columns) - P).norm(), 1e-9 * P.norm());
  EXPECT_EQ(joint, joint.transpose());
  const Eigen::MatrixXd few = joint_covariance(problem, {7}, {9, 3, 9});
  EXPECT_LE((few.block<2, 2>(3, 5) - joint.block<2, 2>(180 + 18, 180 + 6)).norm(), 1e-12 * P.norm());
  EXPECT_LE((few.block<2, 2>(3, 3) - few.block<2, 2>(3, 7)).norm(), 1e-12 * P.norm());
}

TEST_P(MarginalsOf, AMinimumKnowsTheJointCovarianceThere) {
  Problem problem = random_problem(GetParam()).problem;
  const Minimum minimum(problem);
  EXPECT_EQ(minimum.report().reason, Reason::converged);
  const Eigen::MatrixXd afresh = joint_covariance(problem, {5, 29}, {0, 11});
  EXPECT_LE((minimum.joint_covariance({5, 29}, {0, 11}) - afresh).norm(), 1e-9 * afresh.norm());
}

INSTANTIATE_TEST_SUITE_P(Seeds, MarginalsOf, ::testing::Range<std::uint64_t>(1, 9));

TEST(Marginals, RefuseAVariableThatIsNotThere) {
  const Problem problem = random_problem(1).problem;
  EXPECT_THROW(marginal_covariances(problem, {}, {99}), core::PreconditionError);
  EXPECT_THROW(joint_covariance(problem, {-1}, {}), core::PreconditionError);
}

TEST(Marginals, AreHonestOverManyNoiseDraws) {
  // NEES of one landmark over 400 draws of noise, two-sided band with false-alarm probability 1e-4.
  double nees = 0.0;
  constexpr int draws = 400;
  for (int i = 0; i < draws; ++i) {
    testing::RandomProblem made = random_problem(static_cast<std::uint64_t>(1000 + i), {16, 6, 1.0});
    optimize(made.problem);
    const Eigen::Matrix2d P = marginal_covariances(made.problem, {}, {3}).landmarks[0];
    const Eigen::Vector2d e = made.problem.graph.landmarks[3].point_m - made.truth.landmarks[3].point_m;
    nees += e.dot(P.inverse() * e);
  }
  // 800 degrees of freedom: standard deviation of the mean of 400 χ²₂ is 0.1; 3.9 σ each side.
  EXPECT_NEAR(nees / draws, 2.0, 0.39);
}

}  // namespace
}  // namespace helixnav::smoothing
