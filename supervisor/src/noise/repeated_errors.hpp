// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>

#include <Eigen/Core>

#include "helixnav/core/landmark_id.hpp"
#include "noise/fading_errors.hpp"

namespace helixnav::supervisor {

/// Errors of one landmark in successive looks, summed over eight of them. If they are independent, the sum has eight
/// times the variance of one look. If they repeat (the same side of a trunk, the same neighbour that hides half of it), it has
/// up to 64 times that variance, while each look agrees with the last and seems to be better than it is.
/// O(landmarks in view) bytes. Test: supervisor/noise/repeated_errors_test.cpp.
class RepeatedErrors {
 public:
  void next_scan();

  /// A normalised error, in axes that do not turn with the vehicle.
  void add(core::LandmarkId id, const Eigen::Vector2d& error);

  double weight() const { return sums_.weight(); }

  /// Factor on the assumed variance that makes sums of eight looks as large as they are.
  double scale() const { return sums_.mean_scale(); }

 private:
  struct Run {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    int looks = 0;
    long scan = 0;
  };

  std::map<core::LandmarkId, Run> runs_;
  FadingErrors sums_{1.0 - 1.0 / 1000.0};
  long scan_ = 0;
};

}  // namespace helixnav::supervisor
