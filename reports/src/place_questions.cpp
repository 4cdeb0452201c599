// SPDX-License-Identifier: BSD-3-Clause
#include "place_questions.hpp"

#include <algorithm>
#include <variant>

#include "helixnav/reports/decision_sentence.hpp"

namespace helixnav::reports {
namespace {

using Verdict = core::PlacedDecision::Verdict;

/// What is lacking of evidence or lead, in nats; not positive where neither is.
double lacking_nats(const core::PlacedDecision& d) { return d.needed - std::min(d.evidence, d.lead); }

void count(const core::PlacedDecision& d, PlaceQuestions& asked) {
  asked.most_landmarks = std::max(asked.most_landmarks, d.landmarks);
  if (d.verdict == Verdict::sought) return;
  if (d.verdict == Verdict::accepted) asked.accepted = d;
  if (asked.questions == 0) asked.from_m = d.driven_m;
  asked.to_m = d.driven_m;
  asked.questions = d.questions;
  asked.last = d;
  if (!asked.best || lacking_nats(d) < lacking_nats(*asked.best)) asked.best = d;
}

std::string had(double nats, double needed) {
  return " of " + short_number(nats) + " nats" + (nats < needed ? " (" + short_number(needed) + " are needed)" : "");
}

std::string answer_text(const core::PlacedDecision& d) {
  const std::string question = "question " + std::to_string(d.questions) + " after " + short_number(d.driven_m) +
                               " m, with " + std::to_string(d.landmarks) + " landmarks around the vehicle: ";
  if (d.pairs == 0) return question + "they agree with no place on the map.";
  const std::string pairs = std::to_string(d.pairs) + " of them agree with the map, with evidence" +
                            had(d.evidence, d.needed) + " and a lead over other places" + had(d.lead, d.needed);
  if (d.verdict != Verdict::refused) return question + pairs + ".";
  return question + pairs +
         (d.cost <= d.limit ? "; but the drive could not be solved together with the map's."
                            : "; but the pairs contradict each other.");
}

}  // namespace

PlaceQuestions questions_in(const runs::Run& run) {
  PlaceQuestions asked;
  for (const core::StepReport& step : run.steps) {
    for (const core::Decision& decision : step.decisions) {
      if (std::holds_alternative<core::CarriedDecision>(decision)) asked = {};
      if (const auto* placed = std::get_if<core::PlacedDecision>(&decision)) count(*placed, asked);
    }
  }
  return asked;
}

std::string best_answer_text(const PlaceQuestions& asked) {
  if (!asked.best) {
    return "no question was asked, because never more than " + std::to_string(asked.most_landmarks) +
           " landmarks around the vehicle were known well enough at once";
  }
  std::string text = "closest to an answer was " + answer_text(*asked.best);
  text.pop_back();
  return text;
}

std::string questions_text(const PlaceQuestions& asked) {
  if (asked.questions == 0) {
    return "  No question was asked: never more than " + std::to_string(asked.most_landmarks) +
           " landmarks around the vehicle were known well enough at once, too few to identify a place.\n";
  }
  std::string text = "  " + std::to_string(asked.questions) +
                     (asked.questions == 1 ? " question was" : " questions were") + " asked, from " +
                     short_number(asked.from_m) + " to " + short_number(asked.to_m) + " m.\n";
  text += "  Closest to an answer was " + answer_text(*asked.best) + '\n';
  if (asked.last->questions != asked.best->questions) text += "  The last was " + answer_text(*asked.last) + '\n';
  return text;
}

}  // namespace helixnav::reports
