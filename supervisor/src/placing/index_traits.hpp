// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/appearance.hpp"
#include "helixnav/relocalize/landmark.hpp"

namespace helixnav::supervisor {

/// Class and size of a landmark as the index of a map knows them: the likeliest class, by a number that is the same for the
/// same name everywhere.
void tell_traits(const core::LandmarkAppearance& known, relocalize::Landmark& landmark);

}  // namespace helixnav::supervisor
