// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "helixnav/team/team_options.hpp"
#include "state.hpp"

namespace helixnav::team {

/// Landmarks of two components that have one name: of `into`, of `from`.
using SamePairs = std::vector<std::pair<core::LandmarkId, core::LandmarkId>>;

struct NamesFit {
  bool agree = false;     ///< χ² of those kept is within JoinOptions::probability
  bool hopeless = false;  ///< they do not agree, and χ² of all is beyond what any inaccuracy of a linear model explains
  core::PoseGaussian T_into_from;
  SamePairs kept, left_out;
};

/// Where component `from` is in `into`, from landmarks of one name: generalised least squares over both maps' covariances.
/// If χ² objects, names are left out one by one, each time the one without which χ² is least: a barcode may have been
/// misread. Each counts by the sightings of the map that has fewer, five at most; those left out may make up a quarter of
/// all. Test: team/misread_names_test.cpp.
NamesFit fit_names(std::size_t into, std::size_t from, const SamePairs& pairs, const JoinOptions& options,
                   const State& state);

}  // namespace helixnav::team
