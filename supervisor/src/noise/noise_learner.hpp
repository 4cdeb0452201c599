// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "noise/fix_noise.hpp"
#include "noise/noise_pairs.hpp"
#include "noise/noise_scale.hpp"
#include "systematic/systematic_state.hpp"

namespace helixnav::supervisor {

/// What is known of the noise. It belongs to the sensors, not to the belief: rolling back does not undo it.
struct NoiseLearner {
  NoiseScale scale;
  SidesSeen sides;
  SystematicState systematic;
  FixNoise fixes;
  Eigen::Matrix3d moved = Eigen::Matrix3d::Zero();  ///< covariance of the motion since the last scan, as assumed
};

}  // namespace helixnav::supervisor
