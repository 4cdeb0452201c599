// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "helixnav/smoothing/problem.hpp"

namespace helixnav::smoothing {

/// The measurements leave open where a landmark stands: what a solver raises whose normal equations are singular there. `name` is that
/// of the graph. Test: smoothing/optimize_test.cpp
class UndeterminedLandmark : public core::NumericalError {
 public:
  UndeterminedLandmark(const std::string& message, std::int64_t landmark)
      : core::NumericalError(message), name(landmark) {}

  std::int64_t name;
};

/// Landmarks (indices, ascending) of which one coordinate has a standard deviation above a fifth of the distance that they are seen
/// from, even if all poses were known: bearings from nearly one side, of which the least squares may lie at infinity.
/// Test: smoothing/undetermined_test.cpp
std::vector<int> hardly_determined_landmarks(const core::LandmarkGraph& graph);

}  // namespace helixnav::smoothing
