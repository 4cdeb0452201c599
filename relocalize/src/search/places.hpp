// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/relocalize/answer.hpp"
#include "search/candidates.hpp"
#include "search/hypothesis.hpp"

namespace helixnav::relocalize {

/// Refines and weighs candidates, and the best one shifted by all differences of neighbouring landmarks of the map, so that
/// the pitch of a lattice is never missed. Returns different places by falling evidence.
std::vector<Hypothesis> find_places(const Prepared& asked, const std::vector<Candidate>& candidates);

}  // namespace helixnav::relocalize
