// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "helixnav/logs/dlr.hpp"
#include "helixnav/logs/graph_files.hpp"
#include "helixnav/smoothing/marginals.hpp"
#include "helixnav/smoothing/optimize.hpp"
#include "real_data.hpp"

namespace helixnav::smoothing {
namespace {

class DlrRunE : public helixnav::testing::RealDataTest {};

TEST_F(DlrRunE, ReachesThePublishedChi2FromOdometry) {
  ASSERT_NO_FATAL_FAILURE(find_real_data("dlr/raw/map.circles"));
  if (IsSkipped()) return;
  const core::Recording recording = logs::read_dlr(path_);
  Problem problem = build_problem(recording.events, recording.labels);
  EXPECT_EQ(problem.graph.poses.size(), 3298u);
  EXPECT_EQ(problem.graph.landmarks.size(), 576u);
  EXPECT_EQ(problem.graph.landmark_edges.size(), 14309u);
  const Report report = optimize(problem);
  EXPECT_EQ(report.reason, Reason::converged);
  EXPECT_EQ(report.dof, 27466);
  EXPECT_NEAR(report.chi2.total(), 56871.4, 0.1);
  EXPECT_NEAR(report.chi2.odometry, 11356.13, 0.1);
  EXPECT_NEAR(report.chi2.landmarks, 45515.32, 0.1);
  EXPECT_NEAR(report.chi2.total() / report.dof, 2.07, 0.005);  // the paper's factor of overconfidence
}

TEST_F(DlrRunE, GivesEveryLandmarkAnEllipse) {
  ASSERT_NO_FATAL_FAILURE(find_real_data("dlr/raw/map.circles"));
  if (IsSkipped()) return;
  const core::Recording recording = logs::read_dlr(path_);
  Problem problem = build_problem(recording.events, recording.labels);
  optimize(problem);
  const std::vector<Eigen::Matrix2d> covariances = landmark_covariances(problem);
  ASSERT_EQ(covariances.size(), 576u);
  for (const Eigen::Matrix2d& P : covariances) EXPECT_GT(P.determinant(), 0.0);
  // Compared with two triangular solves a column for some of them.
  for (const int i : {0, 100, 300, 575}) {
    const Eigen::MatrixXd exact = joint_covariance(problem, {}, {i});
    EXPECT_LE((covariances[static_cast<std::size_t>(i)] - exact).norm(), 1e-9 * exact.norm());
  }
}

TEST_F(DlrRunE, HasTheSameMinimumInTheG2oCopyOfIt) {
  ASSERT_NO_FATAL_FAILURE(find_real_data("dlr/raw/dlr.g2o"));
  if (IsSkipped()) return;
  Problem problem = problem_from_graph(logs::read_g2o(path_));
  int factorisations = 0;
  Options options;
  options.go_on = [&factorisations](const std::vector<Iteration>&) { return ++factorisations <= 60; };
  const Report report = optimize(problem, options);
  EXPECT_EQ(report.reason, Reason::converged) << factorisations << " factorisations";  // measured: 31
  EXPECT_EQ(report.dof, 27466);
  EXPECT_NEAR(report.chi2.total(), 56871.4, 0.1);  // the copy keeps six digits
}

}  // namespace
}  // namespace helixnav::smoothing
