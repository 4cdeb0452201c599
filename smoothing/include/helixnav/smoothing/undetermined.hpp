// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "helixnav/smoothing/problem.hpp"

namespace helixnav::smoothing {

/// The measurements do not determine where a landmark is: thrown by a solver whose normal equations are singular there.
/// `name` is its name in the graph. Test: smoothing/optimize_test.cpp
class UndeterminedLandmark : public core::NumericalError {
 public:
  UndeterminedLandmark(const std::string& message, std::int64_t landmark)
      : core::NumericalError(message), name(landmark) {}

  std::int64_t name;
};

/// Landmarks (indices, ascending) with one coordinate whose standard deviation is above a fifth of the distance they
/// are seen from, even if all poses were known: bearings from nearly one side, whose least-squares solution may be at
/// infinity.
/// Test: smoothing/undetermined_test.cpp
std::vector<int> hardly_determined_landmarks(const core::LandmarkGraph& graph);

}  // namespace helixnav::smoothing
