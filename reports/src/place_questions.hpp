// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "helixnav/core/decision.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::reports {

/// The queries to maps on which the vehicle's place was unknown, since the session began or the vehicle was last carried.
struct PlaceQuestions {
  int questions = 0;
  double from_m = 0.0, to_m = 0.0;                ///< path length, first and last
  int most_landmarks = 0;                         ///< about the vehicle at once
  std::optional<core::PlacedDecision> last = {};  ///< the answer
  std::optional<core::PlacedDecision> best = {};  ///< the one that came nearest to acceptance
  std::optional<core::PlacedDecision> accepted =
      {};  ///< its place was found: any queries after that concern other parts
};

PlaceQuestions questions_in(const runs::Run& run);

/// Two or three sentences, indented, on lines of their own: how many queries, and what the best and the last answer lacked.
std::string questions_text(const PlaceQuestions& asked);

/// How near it came: one sentence without a full stop, in lower case.
std::string best_answer_text(const PlaceQuestions& asked);

}  // namespace helixnav::reports
