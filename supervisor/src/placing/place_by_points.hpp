// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/core/se2.hpp"

namespace helixnav::supervisor {

/// Errors of a point per error of T (x, y, heading), which moved it there.
Eigen::Matrix<double, 2, 3> point_by_place(const core::Pose2& T, const Eigen::Vector2d& point_m);

/// How T, a place on a map, moves when points of the map do: by the rigid motion that fits theirs best. 3 rows, two columns a
/// point. Test: supervisor/placing/begun_at_test.cpp.
Eigen::MatrixXd place_by_points(const core::Pose2& T, const std::vector<Eigen::Vector2d>& points_m);

}  // namespace helixnav::supervisor
