// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "helixnav/core/decision.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::reports {

/// What was asked of maps on which the vehicle's place was not known, since the session began or the vehicle was carried last.
struct PlaceQuestions {
  int questions = 0;
  double from_m = 0.0, to_m = 0.0;                ///< of the drive, first and last
  int most_landmarks = 0;                         ///< about the vehicle at once
  std::optional<core::PlacedDecision> last = {};  ///< the answer
  std::optional<core::PlacedDecision> best = {};  ///< the one that lacked least to be accepted
  std::optional<core::PlacedDecision> accepted =
      {};  ///< its place was found: what is asked after that is of other parts
};

PlaceQuestions questions_in(const runs::Run& run);

/// Two or three sentences, indented, on lines of their own: how much was asked, and what the best and the last answer lacked.
std::string questions_text(const PlaceQuestions& asked);

/// How near it came: one sentence without its end, in small letters.
std::string best_answer_text(const PlaceQuestions& asked);

}  // namespace helixnav::reports
