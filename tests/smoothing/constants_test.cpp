// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/smoothing/constants.hpp"

#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/smoothing/optimize.hpp"
#include "random_problem.hpp"

namespace helixnav::smoothing {
namespace {

Problem random_problem_solved() {
  Problem problem = testing::random_problem(1).problem;
  problem.fixed_poses = {0};
  optimize(problem);
  return problem;
}

/// Scale of the way, bias of the heading, sensor heading, and a lever arm.
std::vector<ConstantDerivative> constants_of(const Problem& problem) {
  std::vector<ConstantDerivative> constants(4);
  for (auto& constant : constants) {
    constant.increments.assign(problem.graph.pose_edges.size(), Eigen::Vector3d::Zero());
    constant.mountings.assign(problem.graph.landmark_edges.size(), Eigen::Vector3d::Zero());
  }
  for (std::size_t i = 0; i < problem.graph.pose_edges.size(); ++i) {
    constants[0].increments[i].head<2>() = problem.graph.pose_edges[i].T_from_to.vector().head<2>();
    constants[1].increments[i].z() = 1.0;
  }
  for (Eigen::Vector3d& mounting : constants[2].mountings) mounting.z() = 1.0;
  for (Eigen::Vector3d& mounting : constants[3].mountings) mounting.x() = 1.0;
  return constants;
}

Problem changed(const Problem& problem, const ConstantDerivative& by, double change) {
  Problem result = problem;
  for (std::size_t i = 0; i < by.increments.size(); ++i) {
    core::Pose2& T = result.graph.pose_edges[i].T_from_to;
    T = core::Pose2(Eigen::Vector3d(T.vector() + change * by.increments[i]));
  }
  for (std::size_t i = 0; i < by.mountings.size(); ++i) {
    core::Pose2& T = result.graph.landmark_edges[i].T_robot_sensor;
    T = core::Pose2(Eigen::Vector3d(T.vector() + change * by.mountings[i]));
  }
  return result;
}

TEST(ConstantsEvidence, IsTheSlopeAndTheCurvatureOfTheLeastChi2) {
  Problem problem = random_problem_solved();
  const auto constants = constants_of(problem);
  const ConstantsEvidence evidence = evidence_of_constants(problem, constants);
  for (std::size_t c = 0; c < constants.size(); ++c) {
    constexpr double h = 1e-4;
    const auto k = static_cast<Eigen::Index>(c);
    Problem more = changed(problem, constants[c], h), less = changed(problem, constants[c], -h);
    const double high = optimize(more).chi2.total(), low = optimize(less).chi2.total();
    const double middle = evaluate_chi2(problem).total();
    EXPECT_NEAR(evidence.gradient[k] / ((high - low) / (4.0 * h)), 1.0, 1e-3) << c;
    // Gauss–Newton leaves out the second derivatives of the residuals.
    EXPECT_NEAR(evidence.information(k, k) / ((high - 2.0 * middle + low) / (2.0 * h * h)), 1.0, 0.05) << c;
  }
}

TEST(ConstantsEvidence, RefusesDerivativesOfAnotherProblem) {
  EXPECT_THROW(evidence_of_constants(random_problem_solved(), std::vector<ConstantDerivative>(1)),
               core::PreconditionError);
}

}  // namespace
}  // namespace helixnav::smoothing
