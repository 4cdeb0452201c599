// SPDX-License-Identifier: BSD-3-Clause
#include "joint.hpp"

#include <algorithm>
#include <string>

#include "helixnav/core/errors.hpp"
#include "sparse/dense_inverse.hpp"

namespace helixnav::smoothing {
namespace {

void check_chosen(const std::vector<int>& chosen, std::size_t size, const char* what) {
  for (const int i : chosen) {
    if (i < 0 || static_cast<std::size_t>(i) >= size) {
      throw core::PreconditionError(std::string("smoothing: there is no ") + what + " with index " + std::to_string(i));
    }
  }
}

}  // namespace

std::vector<int> positions(const Session& session) {
  std::vector<int> position(static_cast<std::size_t>(session.layout.columns));
  if (position.empty()) return position;
  const FactorView L = session.cholesky.factor();
  for (int k = 0; k < L.columns; ++k) position[static_cast<std::size_t>(L.permutation[k])] = k;
  return position;
}

std::vector<int> columns_of(const Session& session, const std::vector<int>& poses, const std::vector<int>& landmarks) {
  check_chosen(poses, session.problem.graph.poses.size(), "pose");
  check_chosen(landmarks, session.problem.graph.landmarks.size(), "landmark");
  std::vector<int> columns;
  for (const int pose : poses) {
    const int column = session.layout.pose_column[static_cast<std::size_t>(pose)];
    for (int k = 0; k < 3; ++k) columns.push_back(column < 0 ? -1 : column + k);
  }
  for (const int landmark : landmarks) {
    for (int k = 0; k < 2; ++k)
      columns.push_back(session.layout.landmark_column[static_cast<std::size_t>(landmark)] + k);
  }
  return columns;
}

Eigen::MatrixXd joint_covariance(const Session& session, const std::vector<int>& poses,
                                 const std::vector<int>& landmarks) {
  const std::vector<int> columns = columns_of(session, poses, landmarks);
  const std::vector<int> position = positions(session);
  std::vector<int> chosen;
  std::vector<Eigen::Index> row_of;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k] < 0) continue;
    chosen.push_back(position[static_cast<std::size_t>(columns[k])]);
    row_of.push_back(static_cast<Eigen::Index>(k));
  }
  const auto n = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
  if (chosen.empty()) return covariance;
  const DenseInverse inverse(session.cholesky.factor(), chosen);
  std::vector<Eigen::Index> rows;
  for (const int k : inverse.order()) rows.push_back(row_of[static_cast<std::size_t>(k)]);
  constexpr int width = 128;
  const auto all = static_cast<int>(rows.size());
  for (int first = 0; first < all; first += width) {
    const Eigen::MatrixXd band = inverse.band(first, std::min(width, all - first));
    for (Eigen::Index k = 0; k < band.cols(); ++k) {
      for (Eigen::Index i = 0; i <= first + k; ++i) {
        const Eigen::Index row = rows[static_cast<std::size_t>(i)];
        const Eigen::Index column = rows[static_cast<std::size_t>(first + k)];
        covariance(row, column) = covariance(column, row) = band(i, k);
      }
    }
  }
  return covariance;
}

}  // namespace helixnav::smoothing
