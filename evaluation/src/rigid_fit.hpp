// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/core/se2.hpp"

namespace helixnav::evaluation {

/// One landmark, where the map has it and where its tree stands.
struct PlacedTwice {
  Eigen::Vector2d map_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d true_m = Eigen::Vector2d::Zero();
};

/// T_true_map of least squared distance, closed form: heading = atan2(Σ m×t, Σ m·t) over centred points; heading 0 with
/// fewer than two distinct points.
core::Pose2 rigid_fit(const std::vector<PlacedTwice>& points);

/// Root of the mean squared distance after that; NaN with fewer than two points.
double rms_after_fit(const std::vector<PlacedTwice>& points);

}  // namespace helixnav::evaluation
