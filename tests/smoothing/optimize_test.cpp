// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/smoothing/optimize.hpp"

#include <gtest/gtest.h>

#include "dense_twin.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/core/errors.hpp"
#include "random_problem.hpp"

namespace helixnav::smoothing {
namespace {

using testing::DenseTwin;
using testing::random_problem;
using testing::RandomProblem;

double worst_distance(const core::LandmarkGraph& a, const core::LandmarkGraph& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < a.poses.size(); ++i) {
    const Eigen::Vector3d d = a.poses[i].T_world_robot.vector() - b.poses[i].T_world_robot.vector();
    worst = std::max({worst, d.head<2>().norm(), std::abs(core::wrap_to_pi(d[2]))});
  }
  for (std::size_t i = 0; i < a.landmarks.size(); ++i) {
    worst = std::max(worst, (a.landmarks[i].point_m - b.landmarks[i].point_m).norm());
  }
  return worst;
}

TEST(Optimize, FindsTheTruthWhenMeasurementsAreExact) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    RandomProblem made = random_problem(seed, {30, 12, 0.0});
    const Report report = optimize(made.problem);
    EXPECT_EQ(report.reason, Reason::converged);
    EXPECT_LT(report.chi2.total(), 1e-6);
    EXPECT_LT(worst_distance(made.problem.graph, made.truth), 1e-5);
  }
}

TEST(Optimize, EndsWhereTheDenseGradientVanishes) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    RandomProblem made = random_problem(seed);
    Options o;
    o.tolerance_chi2 = 1e-12;
    const Report report = optimize(made.problem, o);
    const DenseTwin twin(made.problem);
    const Eigen::MatrixXd J = twin.jacobian();
    const Eigen::VectorXd e = twin.residuals(Eigen::VectorXd::Zero(twin.columns()));
    const Eigen::VectorXd step = (J.transpose() * J).ldlt().solve(J.transpose() * e);
    EXPECT_LT(step.cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_NEAR(report.chi2.total(), e.squaredNorm(), 1e-8);
  }
}

TEST(Optimize, LeavesChi2InItsBand) {
  // Both tails have probability 1e-6: a run outside is no accident.
  for (std::uint64_t seed = 11; seed <= 20; ++seed) {
    RandomProblem made = random_problem(seed);
    const Report report = optimize(made.problem);
    EXPECT_GT(report.chi2.total(), core::chi2_quantile(1e-6, report.dof));
    EXPECT_LT(report.chi2.total(), core::chi2_quantile(1.0 - 1e-6, report.dof));
  }
}

/// One pose says the landmark is 1 m ahead, exactly at another pose, which says with next to no weight that it is not.
Problem landmark_at_a_sensor() {
  Problem problem;
  core::LandmarkGraph& graph = problem.graph;
  graph.poses.resize(2);
  graph.poses[1].T_world_robot = core::Pose2(1.0, 0.0, 0.0);
  graph.landmarks.resize(1);
  graph.landmarks[0].point_m = Eigen::Vector2d(1.0, 0.7);
  graph.landmark_edges.resize(2);
  graph.landmark_edges[0].observation =
      core::make_cartesian(Eigen::Vector2d(1.0, 0.0), 1e-4 * Eigen::Matrix2d::Identity());
  graph.landmark_edges[1].pose = 1;
  graph.landmark_edges[1].observation = core::make_range(0.5, 1e3);
  problem.fixed_poses = {0, 1};
  return problem;
}

// If the sum is cut short at such a step, half of it is known, and half of a cost is less than the cost.
TEST(Optimize, TakesNoStepThatPutsALandmarkIntoASensor) {
  Problem problem = landmark_at_a_sensor();
  Options options;
  options.first_damping = 1e-9;
  const Report report = optimize(problem, options);
  EXPECT_LT(report.chi2.cost, 1e-5) << "0.25e-6 from the range alone";
  EXPECT_LT((problem.graph.landmarks[0].point_m - Eigen::Vector2d(1.0, 0.0)).norm(), 1e-3);
}

TEST(Optimize, ReportsAFallingCostThatEndsAtTheSolution) {
  RandomProblem made = random_problem(4);
  const Chi2 start = evaluate_chi2(made.problem);
  const Report report = optimize(made.problem);
  EXPECT_EQ(report.start.total(), start.total());
  double last = start.cost;
  for (const Iteration& iteration : report.iterations) {
    EXPECT_LT(iteration.chi2.cost, last);
    last = iteration.chi2.cost;
  }
  EXPECT_EQ(report.chi2.cost, last);
  EXPECT_NEAR(evaluate_chi2(made.problem).total(), report.chi2.total(), 1e-9);
  EXPECT_GT(report.chi2.odometry, 0.0);
  EXPECT_GT(report.chi2.landmarks, 0.0);
  EXPECT_EQ(report.chi2.priors, 0.0);
}

TEST(Optimize, FindsTheSameMinimumWithEitherOrdering) {
  RandomProblem a = random_problem(5);
  RandomProblem b = a;
  Options options;
  options.ordering = Ordering::amd;
  const Report with_amd = optimize(a.problem, options);
  options.ordering = Ordering::metis;
  const Report with_metis = optimize(b.problem, options);
  EXPECT_EQ(with_amd.ordering, Ordering::amd);
  EXPECT_EQ(with_metis.ordering, Ordering::metis);
  EXPECT_NEAR(with_amd.chi2.total(), with_metis.chi2.total(), 1e-8);
}

TEST(Optimize, KeepsTheOrderingWithLessFill) {
  RandomProblem made = random_problem(5, {200, 60, 1.0});
  double nonzeros[3];
  for (const Ordering ordering : {Ordering::least_fill, Ordering::amd, Ordering::metis}) {
    Problem problem = made.problem;
    Options options;
    options.ordering = ordering;
    nonzeros[static_cast<int>(ordering)] = optimize(problem, options).factor_nonzeros;
  }
  EXPECT_EQ(nonzeros[0], std::min(nonzeros[1], nonzeros[2]));
}

TEST(Optimize, NeverMovesAFixedPose) {
  RandomProblem made = random_problem(6);
  made.problem.fixed_poses = {0, 10};
  const Eigen::Vector3d before = made.problem.graph.poses[10].T_world_robot.vector();
  optimize(made.problem);
  EXPECT_EQ(made.problem.graph.poses[10].T_world_robot.vector(), before);
}

TEST(Optimize, TakesAPriorForGauge) {
  RandomProblem fixed = random_problem(7);
  RandomProblem with_prior = fixed;
  with_prior.problem.fixed_poses.clear();
  with_prior.problem.pose_priors.push_back({0, core::Pose2(), 1e-2 * Eigen::Matrix3d::Identity()});
  const Report a = optimize(fixed.problem);
  const Report b = optimize(with_prior.problem);
  EXPECT_NEAR(a.chi2.total(), b.chi2.total(), 1e-5);
  EXPECT_LT(worst_distance(fixed.problem.graph, with_prior.problem.graph), 1e-3);
  EXPECT_EQ(a.dof, b.dof);
}

TEST(Optimize, TakesTwoFixesForGauge) {
  RandomProblem made = random_problem(8, {30, 12, 0.0});
  made.problem.fixed_poses.clear();
  for (const int pose : {3, 20}) {
    core::AbsoluteFix fix;
    fix.antenna_robot_m = {0.5, 0.1};
    fix.position_world_m =
        core::transform(made.truth.poses[static_cast<std::size_t>(pose)].T_world_robot, fix.antenna_robot_m);
    made.problem.graph.fix_edges.push_back({pose, fix});
  }
  const Report report = optimize(made.problem);
  EXPECT_LT(report.chi2.total(), 1e-6);
  EXPECT_LT(worst_distance(made.problem.graph, made.truth), 1e-3);
}

TEST(Optimize, SurvivesWrongAssociationsWithARobustKernel) {
  for (const auto shape : {RobustKernel::Shape::huber, RobustKernel::Shape::cauchy}) {
    RandomProblem made = random_problem(9, {60, 20, 1.0});
    core::RandomStream random(9, "outliers");
    for (auto& edge : made.problem.graph.landmark_edges) {
      if (edge.observation.kind == core::ObservationKind::cartesian && random.uniform() < 0.05) {
        edge.observation.z += Eigen::Vector2d(3.0, -2.0);
      }
    }
    Problem plain = made.problem;
    optimize(plain);
    Options options;
    options.kernel = {shape, 2.0};
    const Report report = optimize(made.problem, options);
    EXPECT_EQ(report.reason, Reason::converged);
    EXPECT_LT(report.chi2.cost, report.chi2.total());
    EXPECT_LT(worst_distance(made.problem.graph, made.truth), 0.5 * worst_distance(plain.graph, made.truth));
  }
}

TEST(Optimize, StopsAtTheBestStateWhenTheCallerSaysSo) {
  RandomProblem made = random_problem(10);
  const double before = evaluate_chi2(made.problem).cost;
  std::size_t seen = 0;
  Options options;
  options.go_on = [&seen](const std::vector<Iteration>& steps) {
    seen = steps.size();
    return seen < 2;
  };
  const Report report = optimize(made.problem, options);
  EXPECT_EQ(report.reason, Reason::stopped);
  EXPECT_EQ(report.iterations.size(), 2u);
  EXPECT_EQ(seen, 2u);
  EXPECT_LT(report.chi2.cost, before);
  EXPECT_EQ(report.chi2.cost, report.iterations.back().chi2.cost);
  EXPECT_EQ(evaluate_chi2(made.problem).cost, report.chi2.cost);
}

TEST(Optimize, LeavesTheProblemWhenTheCallerStopsItBeforeItBegan) {
  RandomProblem made = random_problem(10);
  const Problem start = made.problem;
  Options options;
  options.go_on = [](const std::vector<Iteration>&) { return false; };
  EXPECT_EQ(optimize(made.problem, options).reason, Reason::stopped);
  EXPECT_EQ(worst_distance(made.problem.graph, start.graph), 0.0);
}

TEST(Optimize, NamesTheLandmarkThatBearingsLeaveOpenAndLeavesTheProblem) {
  Problem problem;
  problem.graph.poses = {{40, {}}, {41, {1.0, 0.0, 0.0}}};
  problem.graph.pose_edges = {{0, 1, core::Pose2(1.0, 0.0, 0.0), 0.01 * Eigen::Matrix3d::Identity()}};
  problem.graph.landmarks = {{17, {5.0, 0.0}}};
  const core::Observation ahead = core::make_bearing(0.0, 0.01);
  problem.graph.landmark_edges = {{0, 0, {}, ahead}, {1, 0, {}, ahead}};
  problem.fixed_poses = {0};
  Problem tried = problem;
  try {
    optimize(tried);
    FAIL() << "no error";
  } catch (const core::NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("landmark 17"), std::string::npos) << error.what();
  }
  EXPECT_EQ(worst_distance(tried.graph, problem.graph), 0.0);
}

TEST(Optimize, NamesThePairThatStandsOnEachOther) {
  Problem problem;
  problem.graph.poses = {{3, {}}};
  problem.graph.landmarks = {{8, {0.0, 0.0}}};
  problem.graph.landmark_edges = {{0, 0, {}, core::make_range_bearing(2.0, 0.0, 0.1, 0.1)}};
  problem.fixed_poses = {0};
  try {
    optimize(problem);
    FAIL() << "no error";
  } catch (const core::NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("pose 3 sees landmark 8"), std::string::npos) << error.what();
  }
}

TEST(Optimize, SolvesAProblemWithNothingFree) {
  Problem problem;
  problem.graph.poses = {{0, {}}};
  problem.fixed_poses = {0};
  const Report report = optimize(problem);
  EXPECT_EQ(report.reason, Reason::converged);
  EXPECT_EQ(report.dof, 0);
}

}  // namespace
}  // namespace helixnav::smoothing
