// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "tree/state.hpp"

namespace helixnav::atlas {

/// Covariance of variables in the atlas' own frame, the gauge held. The state has to be clean.
Eigen::MatrixXd covariance_of(const State& state, const std::vector<int>& variables);

}  // namespace helixnav::atlas
