// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "helixnav/core/gaussian.hpp"
#include "helixnav/relocalize/landmark.hpp"

namespace helixnav::supervisor {

/// Some landmarks of a joint estimate, as a question to another map: covariances relative to each other on top of half of the
/// variance of a pair.
std::vector<relocalize::Landmark> question_landmarks(const core::JointGaussian& joint,
                                                     const std::vector<std::size_t>& chosen, double pair_noise_m);

}  // namespace helixnav::supervisor
