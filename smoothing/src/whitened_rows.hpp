// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "session.hpp"

namespace helixnav::smoothing {

inline std::size_t sized(int i) { return static_cast<std::size_t>(i); }

/// The whitened derivative of one measurement between two variables, `rows` × `columns`, whose place in H is given by
/// `column` (−1: the variable is fixed).
struct WhitenedRows {
  Eigen::Matrix<double, 3, 6> J = Eigen::Matrix<double, 3, 6>::Zero();
  std::array<int, 6> column{-1, -1, -1, -1, -1, -1};
  int rows = 0;
};

/// Of all increments, of all observations of landmarks, at the session's state.
std::vector<WhitenedRows> whitened_odometry(const Session& session);
std::vector<WhitenedRows> whitened_observations(const Session& session);

/// How many rows they have together.
int count_rows(const std::vector<WhitenedRows>& all);

/// Σ Jᵀη for errors η of the rows, asked for one by one.
template <class NextError>
Eigen::VectorXd transposed_times(const std::vector<WhitenedRows>& all, int columns, NextError&& next_error) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(columns);
  for (const WhitenedRows& one : all) {
    Eigen::Vector3d error = Eigen::Vector3d::Zero();
    for (int row = 0; row < one.rows; ++row) error[row] = next_error();
    for (int k = 0; k < 6; ++k) {
      if (one.column[sized(k)] >= 0) {
        sum[one.column[sized(k)]] += one.J.col(k).dot(error);
      }
    }
  }
  return sum;
}

/// Σ |Jx|².
double squared_norm_of(const std::vector<WhitenedRows>& all, const Eigen::VectorXd& x);

}  // namespace helixnav::smoothing
