// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <limits>

#include "helixnav/relocalize/ask.hpp"

namespace helixnav::relocalize {

/// The greatest evidence that constellations of so many landmarks of this map, up to 32 of them spread over it, have for a place
/// on it where they are not. Below zero where landmarks stand irregularly; in a street with a tree every 8 m ± 0.3 m it reaches 23
/// nats for 15 landmarks. Constellations that fit elsewhere half as well as where they are stand on the map twice and are
/// left out, since the lead of an answer over that place reveals them. −∞ without any. As expensive as 32 questions; no more are asked
/// once one has `enough`. Method and figures: docs/relocalize.md, section 4. Test: relocalize/elsewhere_test.cpp.
double evidence_elsewhere(const MapIndex& map, std::size_t landmarks,
                          double enough = std::numeric_limits<double>::infinity());

/// A closed answer stays closed only if its evidence is ahead of evidence_elsewhere() as it has to be ahead of its rivals, and if the
/// independent_share() of its evidence and lead is enough by itself; else it becomes ambiguous. For whoever will act on a single
/// answer: where places repeat, the landmarks that make a wrong one fit are not independent, as α assumes.
void judge_where_places_repeat(const MapIndex& map, const Question& question, const AskOptions& options,
                               Answer& answer);

/// ask(), judged like that.
Answer ask_where_places_repeat(const MapIndex& map, const Question& question, const AskOptions& options = {});

}  // namespace helixnav::relocalize
