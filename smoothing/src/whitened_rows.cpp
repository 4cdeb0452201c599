// SPDX-License-Identifier: BSD-3-Clause
#include "whitened_rows.hpp"

#include <Eigen/Cholesky>

namespace helixnav::smoothing {
namespace {

template <int D, int NA, int NB>
WhitenedRows whitened(const BinaryFactor<D, NA, NB>& factor, const Eigen::Matrix<double, D, D>& covariance,
                      int column_a, int column_b) {
  Eigen::Matrix<double, D, NA + NB> J;
  J << factor.J_a, factor.J_b;
  WhitenedRows one;
  one.rows = D;
  one.J.template topLeftCorner<D, NA + NB>() = covariance.llt().matrixL().solve(J);
  for (int k = 0; k < NA; ++k) one.column[sized(k)] = column_a < 0 ? -1 : column_a + k;
  for (int k = 0; k < NB; ++k) one.column[sized(NA + k)] = column_b < 0 ? -1 : column_b + k;
  return one;
}

template <int D>
WhitenedRows whitened_observation(const Session& session, const core::LandmarkGraph::LandmarkEdge& edge) {
  const auto factor =
      observation_factor<D>(edge, session.state.poses[sized(edge.pose)], session.state.landmarks[sized(edge.landmark)]);
  return whitened<D, 3, 2>(factor, Eigen::Matrix<double, D, D>(edge.observation.R),
                           session.layout.pose_column[sized(edge.pose)],
                           session.layout.landmark_column[sized(edge.landmark)]);
}

}  // namespace

std::vector<WhitenedRows> whitened_odometry(const Session& session) {
  std::vector<WhitenedRows> all;
  for (const auto& edge : session.problem.graph.pose_edges) {
    const auto factor =
        odometry_factor(edge, session.state.poses[sized(edge.from)], session.state.poses[sized(edge.to)]);
    all.push_back(whitened<3, 3, 3>(factor, edge.covariance, session.layout.pose_column[sized(edge.from)],
                                    session.layout.pose_column[sized(edge.to)]));
  }
  return all;
}

std::vector<WhitenedRows> whitened_observations(const Session& session) {
  std::vector<WhitenedRows> all;
  for (const auto& edge : session.problem.graph.landmark_edges) {
    all.push_back(core::dimension(edge.observation.kind) == 2 ? whitened_observation<2>(session, edge)
                                                              : whitened_observation<1>(session, edge));
  }
  return all;
}

int count_rows(const std::vector<WhitenedRows>& all) {
  int rows = 0;
  for (const WhitenedRows& one : all) rows += one.rows;
  return rows;
}

double squared_norm_of(const std::vector<WhitenedRows>& all, const Eigen::VectorXd& x) {
  double sum = 0.0;
  for (const WhitenedRows& one : all) {
    Eigen::Vector3d product = Eigen::Vector3d::Zero();
    for (int k = 0; k < 6; ++k) {
      if (one.column[sized(k)] >= 0) product += one.J.col(k) * x[one.column[sized(k)]];
    }
    sum += product.squaredNorm();
  }
  return sum;
}

}  // namespace helixnav::smoothing
