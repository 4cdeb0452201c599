// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "helixnav/team/team_options.hpp"
#include "state.hpp"

namespace helixnav::team {

/// Where one component may be in another's frame, and what ties them.
struct Candidate {
  std::size_t into = 0, from = 0;  ///< components
  TeamJoin::By by = TeamJoin::By::names;
  core::PoseGaussian T_into_from;
  std::vector<std::pair<core::LandmarkId, core::LandmarkId>> same;  ///< landmarks of `into` and of `from`
  std::vector<std::size_t> sightings;                               ///< rows of State::sighting_rows
  std::vector<std::pair<core::LandmarkId, core::LandmarkId>>
      left_out;  ///< of one name, yet two according to most other names
};

/// Joins the components if χ² of the joint least squares exceeds that of both apart by no more than its quantile; no change otherwise. With
/// JoinOptions::by_names what both call by the same name is merged, whatever the candidate rests on; if that fails, once more without the
/// names that contradict most others (fit_names). Of two such landmarks the one that has less than half the sightings of the other is
/// forgotten: its name was misread. Sightings between the two that the solution explains are used from then on, the others refused; if
/// there are more of these, nothing is joined.
bool join_components(Candidate candidate, core::Nanoseconds t_ns, const TeamOptions& options, State& state);

}  // namespace helixnav::team
