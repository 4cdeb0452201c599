// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Dense>

#include "helixnav/smoothing/problem.hpp"
#include "layout.hpp"

namespace helixnav::smoothing::testing {

/// The exact twin: whitened residuals written out plainly, with dense Jacobians by central differences.
class DenseTwin {
 public:
  explicit DenseTwin(const Problem& problem) : problem_(problem), layout_(make_layout(problem)) {}

  int columns() const { return layout_.columns; }
  const Layout& layout() const { return layout_; }

  /// All whitened residuals at the problem's values moved by `step`.
  Eigen::VectorXd residuals(const Eigen::VectorXd& step) const {
    const State from = state_of(problem_.graph);
    State at = from;
    add_step(layout_, step, from, at);
    std::vector<double> rows;
    const auto push = [&rows](const Eigen::VectorXd& e, const Eigen::MatrixXd& C) {
      const Eigen::VectorXd whitened = C.llt().matrixL().solve(e);
      rows.insert(rows.end(), whitened.begin(), whitened.end());
    };
    const auto pose = [&at](int i) { return at.poses[static_cast<std::size_t>(i)]; };
    const auto point = [&at](int i) { return at.landmarks[static_cast<std::size_t>(i)]; };
    for (const auto& edge : problem_.graph.pose_edges) {
      Eigen::VectorXd e = core::between(pose(edge.from), pose(edge.to)).vector() - edge.T_from_to.vector();
      e[2] = core::wrap_to_pi(e[2]);
      push(e, edge.covariance);
    }
    for (const auto& edge : problem_.graph.landmark_edges) {
      const auto& z = edge.observation;
      const auto predicted =
          core::predict_observation(z.kind, pose(edge.pose), edge.T_robot_sensor, point(edge.landmark));
      push(-core::innovation(z.kind, z.z, predicted.z_hat), z.R);
    }
    for (const auto& edge : problem_.graph.fix_edges) {
      push(core::transform(pose(edge.pose), edge.fix.antenna_robot_m) - edge.fix.position_world_m,
           edge.fix.covariance_m2);
    }
    for (const auto& prior : problem_.pose_priors) {
      Eigen::VectorXd e = pose(prior.pose).vector() - prior.T_world_robot.vector();
      e[2] = core::wrap_to_pi(e[2]);
      push(e, prior.covariance);
    }
    for (const auto& prior : problem_.landmark_priors) push(point(prior.landmark) - prior.point_m, prior.covariance_m2);
    return Eigen::Map<const Eigen::VectorXd>(rows.data(), static_cast<Eigen::Index>(rows.size()));
  }

  Eigen::MatrixXd jacobian() const {
    Eigen::MatrixXd J;
    for (int c = 0; c < layout_.columns; ++c) {
      Eigen::VectorXd step = Eigen::VectorXd::Zero(layout_.columns);
      step[c] = 1e-5;
      const Eigen::VectorXd slope = (residuals(step) - residuals(-step)) / 2e-5;
      if (c == 0) J.resize(slope.size(), layout_.columns);
      J.col(c) = slope;
    }
    return J;
  }

 private:
  Problem problem_;
  Layout layout_;
};

}  // namespace helixnav::smoothing::testing
