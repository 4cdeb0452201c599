// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/landmark_id.hpp"

namespace helixnav::relocalize {

/// A measured size (diameter of a stem, width of a sign) with its standard deviation.
struct Size {
  double mean_m = 0.0;
  double sigma_m = 0.0;
};

/// A point landmark of a map or of the branch that asks where it is, in the frame of that map or branch.
/// The covariance is that of the point relative to its neighbours within the sensor's reach, not to the map's origin: what
/// a whole region shares moves the answer's pose and says nothing about whether the place is right. Symmetric, positive
/// definite. Kind and size are evidence where both sides have them.
struct Landmark {
  core::LandmarkId id = core::no_landmark;
  core::PointGaussian point;
  std::optional<int> kind;
  std::optional<Size> size;
};

/// Ground within a distance of a point.
struct Disc {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  double radius_m = 0.0;
};

}  // namespace helixnav::relocalize
