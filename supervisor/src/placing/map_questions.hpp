// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/relocalize/map_index.hpp"
#include "helixnav/relocalize/question.hpp"
#include "placing/earlier_map.hpp"

namespace helixnav::supervisor {

/// A whole map as questions to another one: constellations of the 40 landmarks nearest to a centre, overlapping by
/// half, so that ground common to both maps is asked about wherever it is. None for fewer than eight landmarks.
std::vector<relocalize::Question> map_questions(const EarlierMap& map, const relocalize::IndexOptions& lengths);

}  // namespace helixnav::supervisor
