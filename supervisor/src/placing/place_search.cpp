// SPDX-License-Identifier: BSD-3-Clause
#include "placing/place_search.hpp"

#include "helixnav/relocalize/elsewhere.hpp"

namespace helixnav::supervisor {
namespace {

core::PlacedDecision::Verdict verdict_of(relocalize::Verdict verdict) {
  if (verdict == relocalize::Verdict::closed) return core::PlacedDecision::Verdict::accepted;
  const bool ambiguous = verdict == relocalize::Verdict::ambiguous;
  return ambiguous ? core::PlacedDecision::Verdict::ambiguous : core::PlacedDecision::Verdict::not_here;
}

}  // namespace

PlaceSearch::PlaceSearch(const core::JointMap& earlier, const relocalize::IndexOptions& lengths)
    : earlier_(earlier), index_(earlier_.index(lengths)) {}

relocalize::Answer PlaceSearch::ask(const relocalize::Question& question, const Asked& before,
                                    core::PlacedDecision& decision) const {
  const relocalize::AskOptions options = session_options(before.next_alpha());
  relocalize::Answer answer = relocalize::ask_where_places_repeat(index_, question, options);
  decision.verdict = verdict_of(answer.verdict);
  decision.earlier_landmarks = static_cast<int>(earlier_.landmarks().ids.size());
  decision.questions = before.questions + 1;
  decision.landmarks = static_cast<int>(question.landmarks.size());
  decision.needed = relocalize::evidence_needed(options);
  decision.lead = answer.gap;
  if (answer.places.empty()) return answer;
  const relocalize::Place& best = answer.places.front();
  decision.pairs = static_cast<int>(best.pairs.size());
  decision.evidence = best.evidence;
  decision.T_map_session = best.T_map_branch;
  return answer;
}

}  // namespace helixnav::supervisor
