// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/map_appearance.hpp"
#include "helixnav/relocalize/landmark.hpp"

namespace helixnav::supervisor {

/// Some landmarks of a joint estimate, as a question to another map: covariances relative to each other on top of half of the
/// variance of a pair. `appearance`: what they look like.
std::vector<relocalize::Landmark> question_landmarks(const core::JointGaussian& joint,
                                                     const std::vector<std::size_t>& chosen, double pair_noise_m,
                                                     const core::MapAppearance& appearance);

}  // namespace helixnav::supervisor
