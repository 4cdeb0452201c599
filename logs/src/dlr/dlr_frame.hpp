// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace helixnav::logs {

/// DLR robot axes (X left, Y backward) to ours (x ahead, y left): x = −Y, y = X.
inline Eigen::Vector2d from_dlr_axes(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }
inline Eigen::Vector2d to_dlr_axes(const Eigen::Vector2d& v) { return {v.y(), -v.x()}; }

/// R·C·Rᵀ for that quarter turn, exactly (no rounding).
inline Eigen::Matrix2d from_dlr_axes(const Eigen::Matrix2d& C) {
  return (Eigen::Matrix2d() << C(1, 1), -C(0, 1), -C(0, 1), C(0, 0)).finished();
}
inline Eigen::Matrix2d to_dlr_axes(const Eigen::Matrix2d& C) { return from_dlr_axes(C); }

inline Eigen::Matrix3d from_dlr_axes(const Eigen::Matrix3d& C) {
  Eigen::Matrix3d turned;
  turned.topLeftCorner<2, 2>() = from_dlr_axes(Eigen::Matrix2d(C.topLeftCorner<2, 2>()));
  turned(0, 2) = turned(2, 0) = -C(1, 2);
  turned(1, 2) = turned(2, 1) = C(0, 2);
  turned(2, 2) = C(2, 2);
  return turned;
}
inline Eigen::Matrix3d to_dlr_axes(const Eigen::Matrix3d& C) {
  Eigen::Matrix3d turned;
  turned.topLeftCorner<2, 2>() = to_dlr_axes(Eigen::Matrix2d(C.topLeftCorner<2, 2>()));
  turned(0, 2) = turned(2, 0) = C(1, 2);
  turned(1, 2) = turned(2, 1) = -C(0, 2);
  turned(2, 2) = C(2, 2);
  return turned;
}

}  // namespace helixnav::logs
