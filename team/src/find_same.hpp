// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <set>
#include <tuple>
#include <utility>

#include "helixnav/team/team_options.hpp"
#include "state.hpp"

namespace helixnav::team {

/// Landmarks that were split in two again, by what began them.
using BirthKey = std::tuple<std::size_t, core::Nanoseconds, int>;
using RefusedSame = std::set<std::pair<BirthKey, BirthKey>>;

BirthKey key_of(const Birth& birth);

/// Merges landmarks of a solved component that are in one place, as far as χ² of least squares with them merged does not object;
/// no change otherwise. Robots that map the same ground begin the same landmarks more than once, before they are joined or while
/// their poses are poorly known. Twice: by their places; then those whose looks were shared out between two copies
/// (were_seen_in_turn), if the looks at both fit one thing by the noise of a look.
void find_same(std::size_t component, core::Nanoseconds t_ns, const TeamOptions& options, const RefusedSame& refused,
               State& state);

}  // namespace helixnav::team
