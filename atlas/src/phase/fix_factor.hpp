// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "helixnav/atlas/relative_gaussian.hpp"
#include "helixnav/core/events.hpp"

namespace helixnav::atlas {

/// A fix as a factor of a pose relative to the frame that it is given in, about `T_world_robot` (x, y, heading).
/// Linear except for the antenna's lever arm.
RelativeGaussian fix_factor(const core::AbsoluteFix& fix, const Eigen::Vector3d& T_world_robot);

}  // namespace helixnav::atlas
