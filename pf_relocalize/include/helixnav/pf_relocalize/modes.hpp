// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "helixnav/core/gaussian.hpp"
#include "helixnav/pf_relocalize/particles.hpp"

namespace helixnav::pf_relocalize {

/// One hypothesis: the particles near a centre, their share of the weight, their mean and covariance.
struct Mode {
  double mass = 0.0;
  core::PoseGaussian pose;  ///< T_base_robot
  std::uint32_t best = 0;   ///< the particle of greatest weight in it
};

struct ModeRadius {
  double position_m = 2.0;
  double heading_rad = 6.0 * core::pi / 180.0;
};

/// Splits a cloud with normalised weights into modes: the heaviest particle not yet taken gathers what is within the
/// radius, the centre moves to their mean and gathers once more. Stops at `most` modes or when less than `rest` of the
/// weight is left. Heaviest mode first. `taken` is working memory, `modes` the result; both keep their capacity.
/// Cost O(modes · n). Test: pf_relocalize/modes_test.cpp.
void find_modes(const Particles& particles, const ModeRadius& radius, std::size_t most, double rest,
                std::vector<std::uint8_t>& taken, std::vector<Mode>& modes);

/// Mean and covariance of the whole cloud (normalised weights), headings about the direction of their mean vector.
core::PoseGaussian cloud_moments(const Particles& particles);

}  // namespace helixnav::pf_relocalize
