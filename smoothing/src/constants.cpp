// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/smoothing/constants.hpp"

#include <Eigen/Cholesky>

#include "helixnav/core/errors.hpp"
#include "session.hpp"

namespace helixnav::smoothing {
namespace {

/// How a landmark would have to move for a fixed sensor to see what a sensor moved on the vehicle sees.
Eigen::Matrix<double, 2, 3> point_by_mounting(const core::Pose2& T_world_robot, const core::Pose2& T_robot_sensor,
                                              const Eigen::Vector2d& point_m) {
  const Eigen::Vector2d from_sensor_m = point_m - core::compose(T_world_robot, T_robot_sensor).position_m();
  Eigen::Matrix<double, 2, 3> J;
  J.leftCols<2>() = -core::rotation(T_world_robot.heading_rad);
  J.col(2) << from_sensor_m.y(), -from_sensor_m.x();
  return J;
}

/// The rows of the constants in the normal equations of poses, landmarks and constants.
class BorderedEquations {
 public:
  BorderedEquations(const Session& session, const std::vector<ConstantDerivative>& constants)
      : session_(session), constants_(constants) {
    const auto count = static_cast<Eigen::Index>(constants.size());
    border = Eigen::MatrixXd::Zero(session.layout.columns, count);
    corner = Eigen::MatrixXd::Zero(count, count);
    gradient = Eigen::VectorXd::Zero(count);
    const core::LandmarkGraph& graph = session.problem.graph;
    for (std::size_t i = 0; i < graph.pose_edges.size(); ++i) add_odometry(i);
    for (std::size_t i = 0; i < graph.landmark_edges.size(); ++i) {
      if (core::dimension(graph.landmark_edges[i].observation.kind) == 2) {
        add_observation<2>(i);
      } else {
        add_observation<1>(i);
      }
    }
  }

  Eigen::MatrixXd border;    ///< J_xᵀC⁻¹J_c
  Eigen::MatrixXd corner;    ///< J_cᵀC⁻¹J_c
  Eigen::VectorXd gradient;  ///< J_cᵀC⁻¹e

 private:
  void add_odometry(std::size_t i) {
    const auto& edge = session_.problem.graph.pose_edges[i];
    const auto from = static_cast<std::size_t>(edge.from);
    const auto to = static_cast<std::size_t>(edge.to);
    const auto factor = odometry_factor(edge, session_.state.poses[from], session_.state.poses[to]);
    Eigen::Matrix3Xd J(3, corner.cols());
    for (Eigen::Index c = 0; c < J.cols(); ++c) J.col(c) = -constants_[static_cast<std::size_t>(c)].increments[i];
    add(factor, J, edge.covariance, session_.layout.pose_column[from], session_.layout.pose_column[to]);
  }

  template <int D>
  void add_observation(std::size_t i) {
    const auto& edge = session_.problem.graph.landmark_edges[i];
    const auto pose = static_cast<std::size_t>(edge.pose);
    const auto landmark = static_cast<std::size_t>(edge.landmark);
    const core::Pose2& T_world_robot = session_.state.poses[pose];
    const Eigen::Vector2d& point_m = session_.state.landmarks[landmark];
    const auto factor = observation_factor<D>(edge, T_world_robot, point_m);
    const Eigen::Matrix<double, D, 3> by_mounting =
        factor.J_b * point_by_mounting(T_world_robot, edge.T_robot_sensor, point_m);
    Eigen::Matrix<double, D, Eigen::Dynamic> J(D, corner.cols());
    for (Eigen::Index c = 0; c < J.cols(); ++c)
      J.col(c) = by_mounting * constants_[static_cast<std::size_t>(c)].mountings[i];
    add(factor, J, Eigen::Matrix<double, D, D>(edge.observation.R), session_.layout.pose_column[pose],
        session_.layout.landmark_column[landmark]);
  }

  template <int D, int NA, int NB>
  void add(const BinaryFactor<D, NA, NB>& factor, const Eigen::Matrix<double, D, Eigen::Dynamic>& J,
           const Eigen::Matrix<double, D, D>& covariance, int column_a, int column_b) {
    const Eigen::Matrix<double, D, Eigen::Dynamic> weighted = covariance.llt().solve(J);
    corner += J.transpose() * weighted;
    gradient += weighted.transpose() * factor.e;
    if (column_a >= 0) border.template middleRows<NA>(column_a) += factor.J_a.transpose() * weighted;
    if (column_b >= 0) border.template middleRows<NB>(column_b) += factor.J_b.transpose() * weighted;
  }

  const Session& session_;
  const std::vector<ConstantDerivative>& constants_;
};

void check(const Problem& problem, const std::vector<ConstantDerivative>& constants) {
  for (const ConstantDerivative& constant : constants) {
    if (constant.increments.size() == problem.graph.pose_edges.size() &&
        constant.mountings.size() == problem.graph.landmark_edges.size()) {
      continue;
    }
    throw core::PreconditionError("evidence_of_constants: a derivative of other measurements than the problem's");
  }
}

}  // namespace

ConstantsEvidence evidence_of_constants(const Problem& solved, const std::vector<ConstantDerivative>& constants) {
  check_problem(solved);
  check(solved, constants);
  const Options options;
  Session session(solved, options);
  session.linearize();
  session.factorize_undamped();
  const BorderedEquations equations(session, constants);
  ConstantsEvidence evidence{equations.gradient, equations.corner};
  Eigen::VectorXd x;
  for (Eigen::Index c = 0; c < equations.border.cols(); ++c) {
    session.cholesky.solve(equations.border.col(c), x);
    evidence.information.col(c) -= equations.border.transpose() * x;
    evidence.gradient[c] -= x.dot(session.equations.gradient);  // zero exactly at the minimum
  }
  evidence.information = 0.5 * (evidence.information + evidence.information.transpose()).eval();
  return evidence;
}

}  // namespace helixnav::smoothing
