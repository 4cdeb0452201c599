// SPDX-License-Identifier: BSD-3-Clause
#include "normal_equations.hpp"

#include <gtest/gtest.h>

#include "central_differences.hpp"
#include "dense_twin.hpp"
#include "random_problem.hpp"

namespace helixnav::smoothing {
namespace {

using testing::DenseTwin;
using testing::random_problem;

/// A problem with every kind of factor.
Problem problem_with_everything(std::uint64_t seed) {
  Problem problem = random_problem(seed, {12, 5, 1.0}).problem;
  core::AbsoluteFix fix;
  fix.position_world_m = {3.0, 1.0};
  fix.covariance_m2 << 0.5, 0.1, 0.1, 0.3;
  fix.antenna_robot_m = {-0.7, 0.4};
  problem.graph.fix_edges.push_back({5, fix});
  core::RandomStream random(seed, "prior");
  problem.pose_priors.push_back({7, core::Pose2(1.0, 2.0, 3.1), testing::random_covariance(random, 0.4, 0.1)});
  problem.landmark_priors.push_back({2, {4.0, 5.0}, Eigen::Vector2d(0.2, 0.3).asDiagonal()});
  return problem;
}

Eigen::MatrixXd dense(const NormalEquations& equations) {
  const Eigen::Index n = equations.gradient.size();
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index c = 0; c < n; ++c) {
    for (int k = equations.column_start[static_cast<std::size_t>(c)];
         k < equations.column_start[static_cast<std::size_t>(c) + 1]; ++k) {
      const int r = equations.row_index[static_cast<std::size_t>(k)];
      H(r, c) = H(c, r) = equations.values[static_cast<std::size_t>(k)];
    }
  }
  return H;
}

TEST(NormalEquations, AreJacobiansByCentralDifferencesSquared) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Problem problem = problem_with_everything(seed);
    const DenseTwin twin(problem);
    const Eigen::MatrixXd J = twin.jacobian();
    const Eigen::VectorXd e = twin.residuals(Eigen::VectorXd::Zero(twin.columns()));
    NormalEquations equations(problem, twin.layout(), {});
    const Chi2 chi2 = equations.linearize(state_of(problem.graph));
    EXPECT_NEAR(chi2.total(), e.squaredNorm(), 1e-9 * e.squaredNorm());
    EXPECT_LE((dense(equations) - J.transpose() * J).norm(), 1e-7 * (J.transpose() * J).norm());
    EXPECT_LE((equations.gradient - J.transpose() * e).norm(), 1e-7 * (J.transpose() * e).norm());
  }
}

TEST(NormalEquations, MultiplyAsTheWholeSymmetricMatrix) {
  const Problem problem = problem_with_everything(3);
  const Layout layout = make_layout(problem);
  NormalEquations equations(problem, layout, {});
  equations.linearize(state_of(problem.graph));
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(layout.columns, -1.0, 2.0);
  Eigen::VectorXd Hx;
  equations.multiply(x, Hx);
  EXPECT_LE((Hx - dense(equations) * x).norm(), 1e-12 * Hx.norm());
}

TEST(Factors, OdometryHasThePapersJacobians) {
  core::RandomStream random(1, "odometry");
  for (int i = 0; i < 100; ++i) {
    const core::LandmarkGraph::PoseEdge edge{0, 1, core::Pose2(random.normal(), random.normal(), random.normal()), {}};
    Eigen::VectorXd x(6);
    for (double& value : x) value = random.uniform(-3.0, 3.0);
    const auto factor_at = [&edge](const Eigen::VectorXd& v) {
      return odometry_factor(edge, core::Pose2(Eigen::Vector3d(v.head<3>())),
                             core::Pose2(Eigen::Vector3d(v.tail<3>())));
    };
    const Eigen::MatrixXd J = helixnav::testing::central_differences(
        [&](const Eigen::VectorXd& v) { return Eigen::VectorXd(factor_at(v).e); }, x,
        [](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
          Eigen::VectorXd d = a - b;
          d[2] = core::wrap_to_pi(d[2]);
          return d;
        });
    EXPECT_LE((J.leftCols<3>() - factor_at(x).J_a).norm(), 1e-8);
    EXPECT_LE((J.rightCols<3>() - factor_at(x).J_b).norm(), 1e-8);
  }
}

TEST(Factors, BearingOfALineFollowsThePapersChainOfJacobians) {
  // dlr_kurlbaum2009 eq (13)-(19), written out: the line's foot m in the robot frame, then the bearing from the camera.
  core::RandomStream random(2, "line");
  for (int i = 0; i < 100; ++i) {
    const core::Pose2 p(random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0), random.uniform(-3.0, 3.0));
    const Eigen::Vector2d l(random.uniform(-9.0, 9.0), random.uniform(-9.0, 9.0));
    const Eigen::Vector2d c(0.0808609, 0.0179777);
    const Eigen::Matrix2d J6 = core::rotation(p.heading_rad).transpose();
    const Eigen::Vector2d m = J6 * (l - p.position_m());
    const Eigen::RowVector2d J7 = Eigen::RowVector2d(c.y() - m.y(), m.x() - c.x()) / (m - c).squaredNorm();
    Eigen::Matrix<double, 2, 3> J5;
    J5.leftCols<2>() = -J6;
    J5.col(2) << m.y(), -m.x();

    core::LandmarkGraph::LandmarkEdge edge;
    edge.T_robot_sensor = core::Pose2(c.x(), c.y(), 0.0);
    edge.observation = core::make_bearing(0.1, 0.01);
    const auto factor = observation_factor<1>(edge, p, l);
    EXPECT_NEAR(factor.e[0], core::wrap_to_pi(std::atan2(m.y() - c.y(), m.x() - c.x()) - 0.1), 1e-12);
    EXPECT_LE((factor.J_a - J7 * J5).norm(), 1e-12);
    EXPECT_LE((factor.J_b - J7 * J6).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace helixnav::smoothing
