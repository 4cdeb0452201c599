// SPDX-License-Identifier: BSD-3-Clause
#include "phase/world_form.hpp"

#include "helixnav/core/angle.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::atlas {
namespace {

using Eigen::Index;

/// D·M for the rows of u, in place; D = blkdiag(R, 1, R, …).
template <class Matrix>
void turn_rows(Matrix&& M, const Eigen::Matrix2d& R) {
  for (Index j = 0; j < M.cols(); ++j) {
    for (Index row = 0; row < M.rows(); row += row == 0 ? 3 : 2) {
      const double x = M(row, j);
      const double y = M(row + 1, j);
      M(row, j) = R(0, 0) * x + R(0, 1) * y;
      M(row + 1, j) = R(1, 0) * x + R(1, 1) * y;
    }
  }
}

/// How u's positions and heading, in the world, move with the reference.
Eigen::Matrix<double, Eigen::Dynamic, 3> carried(const Values& values) {
  Eigen::Matrix<double, Eigen::Dynamic, 3> G(2 * static_cast<Index>(values.size()) - 1, 3);
  Index row = 0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    const Eigen::Vector3d arm = values[i] - values[0];
    G.middleRows<2>(row) << 1.0, 0.0, -arm.y(), 0.0, 1.0, arm.x();
    row += 2;
    if (i == 1) G.row(row++) << 0.0, 0.0, 1.0;
  }
  return G;
}

}  // namespace

Eigen::VectorXd relative_coordinates(const Values& values) {
  const Eigen::Matrix2d R = core::rotation(values[0].z()).transpose();
  Eigen::VectorXd u(2 * static_cast<Index>(values.size()) - 1);
  u.head<2>() = R * (values[1] - values[0]).head<2>();
  u[2] = core::wrap_to_pi(values[1].z() - values[0].z());
  for (std::size_t i = 2; i < values.size(); ++i) {
    u.segment<2>(2 * static_cast<Index>(i) - 1) = R * (values[i] - values[0]).head<2>();
  }
  return u;
}

Eigen::MatrixXd world_form(const RelativeGaussian& factor, const Values& values) {
  const Index n = factor.mean.size();
  Eigen::VectorXd delta = relative_coordinates(values) - factor.mean;
  delta[2] = core::wrap_to_pi(delta[2]);
  Eigen::MatrixXd W = factor.information.full();
  const Eigen::VectorXd pull = W * delta;
  Eigen::MatrixXd g = factor.vector - pull;
  const Eigen::Matrix2d R = core::rotation(values[0].z());
  turn_rows(g, R);
  turn_rows(W, R);
  turn_rows(W.transpose(), R);
  const auto G = carried(values);
  const Eigen::MatrixXd WG = W * G;
  Eigen::MatrixXd A(n + 4, n + 4);
  A.topLeftCorner<3, 3>() = G.transpose() * WG;
  A.block(3, 0, n, 3) = -WG;
  A.block(3, 3, n, n) = W;
  A.row(n + 3).head<3>() = -(g.transpose() * G);
  A.row(n + 3).segment(3, n) = g.transpose();
  A(n + 3, n + 3) = factor.chi2 - 2.0 * factor.vector.dot(delta) + delta.dot(pull);
  return A;
}

}  // namespace helixnav::atlas
