// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <gtest/gtest.h>

#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::supervisor {

inline double relative_variance(const Eigen::MatrixXd& P, Eigen::Index i, Eigen::Index j) {
  return (P.block<2, 2>(i, i) + P.block<2, 2>(j, j) - P.block<2, 2>(i, j) - P.block<2, 2>(j, i)).trace();
}

/// Pose and landmarks to 3 cm and 2 mrad, standard deviations to 2 %, also those between neighbours in the list: phases
/// are relinearised only once they have moved by 0.1 m (tests/atlas has the counterpart with that at 0).
inline void expect_same(const core::JointGaussian& one, const core::JointGaussian& other) {
  EXPECT_LT((one.pose.position_m() - other.pose.position_m()).norm(), 0.03);
  EXPECT_LT(std::abs(core::wrap_to_pi(one.pose.heading_rad - other.pose.heading_rad)), 2e-3);
  for (std::size_t i = 0; i < one.ids.size(); ++i) {
    EXPECT_LT((one.points_m[i] - other.points_m[i]).norm(), 0.03);
  }
  const Eigen::MatrixXd& P = one.covariance;
  const Eigen::VectorXd ratio = P.diagonal().cwiseQuotient(other.covariance.diagonal()).cwiseSqrt();
  EXPECT_LT((ratio.array() - 1.0).abs().maxCoeff(), 0.02);
  for (Eigen::Index i = 3; i + 2 < P.rows(); i += 2) {
    EXPECT_NEAR(std::sqrt(relative_variance(P, i, i + 2) / relative_variance(other.covariance, i, i + 2)), 1.0, 0.02);
  }
}

}  // namespace helixnav::supervisor
