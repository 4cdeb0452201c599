// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/CMatrixFixed.h>
#include <Eigen/Core>

namespace helixnav::mrpt_adapter {

inline Eigen::Matrix3d eigen_of(const mrpt::math::CMatrixDouble33& matrix) {
  Eigen::Matrix3d result;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) result(r, c) = matrix(r, c);
  }
  return result;
}

inline mrpt::math::CMatrixDouble33 mrpt_of(const Eigen::Matrix3d& matrix) {
  mrpt::math::CMatrixDouble33 result;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) result(r, c) = matrix(r, c);
  }
  return result;
}

inline mrpt::math::CMatrixDouble22 mrpt_of(const Eigen::Matrix2d& matrix) {
  mrpt::math::CMatrixDouble22 result;
  for (int r = 0; r < 2; ++r) {
    for (int c = 0; c < 2; ++c) result(r, c) = matrix(r, c);
  }
  return result;
}

}  // namespace helixnav::mrpt_adapter
