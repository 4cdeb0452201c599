// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/decision_row.hpp"

#include <algorithm>
#include <string_view>
#include <type_traits>

namespace helixnav::core {
namespace {

// numbers(decision, visit): every number of a decision with its name, in the order of the row.

template <class Visit>
void numbers(TriggerDecision& d, Visit&& visit) {
  visit("landmark", d.landmark);
  visit("expected_confusers", d.expected_confusers);
  visit("neighbours", d.neighbours);
  visit("gate_area", d.gate_area);
  visit("pose_sigma_m", d.pose_sigma_m);
  visit("heading_sigma_deg", d.heading_sigma_deg);
  visit("old_in_gate", d.old_in_gate);
}

template <class Visit>
void numbers(RollbackDecision& d, Visit&& visit) {
  visit("missing", d.missing);
  visit("seen", d.seen);
  visit("spawned", d.spawned);
  visit("nats", d.nats);
  visit("scans", d.scans);
}

template <class Visit>
void numbers(SlipDecision& d, Visit&& visit) {
  visit("pairs", d.pairs);
  visit("nats", d.nats);
  visit("same_pairs_nats", d.same_pairs_nats);
  visit("rival_nats", d.rival_nats);
  visit("moved_m", d.moved_m);
  visit("turned_deg", d.turned_deg);
  visit("sigma_m", d.sigma_m);
  visit("pattern_nats", d.pattern_nats);
}

template <class Visit>
void numbers(LostBySlipDecision& d, Visit&& visit) {
  visit("missing", d.missing);
  visit("seen", d.seen);
  visit("unknown", d.unknown);
  visit("nats", d.nats);
  visit("sigma_m", d.sigma_m);
}

template <class Visit>
void numbers(MovingDecision& d, Visit&& visit) {
  visit("landmarks", d.landmarks);
  visit("nats", d.nats);
  visit("speed_mps", d.speed_mps);
}

template <class Visit>
void numbers(SystematicDecision& d, Visit&& visit) {
  visit("too_long", d.too_long);
  visit("turn_rad_per_s", d.turn_rad_per_s);
  visit("turn_rad_per_m", d.turn_rad_per_m);
  visit("heading_rad", d.heading_rad);
  visit("short_m", d.short_m);
  visit("nats", d.nats);
  visit("stretches", d.stretches);
  visit("solved_again", d.solved_again);
}

template <class Visit>
void numbers(NoiseDecision& d, Visit&& visit) {
  visit("odometry", d.odometry);
  visit("detections", d.detections);
  visit("fixes", d.fixes);
  visit("solved_again", d.solved_again);
}

template <class Visit>
void numbers(AttemptStarted& d, Visit&& visit) {
  visit("attempt", d.attempt);
  visit("reference_landmarks", d.reference_landmarks);
  visit("helix_pairs", d.helix_pairs);
  visit("log_evidence", d.log_evidence);
}

template <class Visit>
void numbers(AttemptEnded& d, Visit&& visit) {
  visit("attempt", d.attempt);
  visit("scans", d.scans);
  visit("log_evidence", d.log_evidence);
  visit("largest_mode", d.largest_mode);
  visit("driven_m", d.driven_m);
}

template <class Visit>
void numbers(ReferenceUnusable& d, Visit&& visit) {
  visit("attempt", d.attempt);
  visit("reference_landmarks", d.reference_landmarks);
  visit("least_eigenvalue", d.least_eigenvalue);
}

template <class Visit>
void numbers(VerificationDecision& d, Visit&& visit) {
  visit("matched", d.matched);
  visit("unmatched_branch", d.unmatched_branch);
  visit("unmatched_old", d.unmatched_old);
  visit("ratio", d.ratio);
  visit("rival_matched", d.rival_matched);
  visit("rival_ratio", d.rival_ratio);
  visit("rival_share", d.rival_share);
  visit("rivals_tried", d.rivals_tried);
  visit("adopted", d.adopted);
  visit("x_m", d.T_world_winner.x_m);
  visit("y_m", d.T_world_winner.y_m);
  visit("heading_rad", d.T_world_winner.heading_rad);
  visit("rival_x_m", d.T_world_rival.x_m);
  visit("rival_y_m", d.T_world_rival.y_m);
  visit("rival_heading_rad", d.T_world_rival.heading_rad);
}

template <class Visit>
void numbers(ShapeDecision& d, Visit&& visit) {
  visit("place", d.place);
  visit("places", d.places);
  visit("pairs", d.pairs);
  visit("alone", d.alone);
  visit("chi2", d.chi2);
  visit("dof", d.dof);
  visit("rival_pairs", d.rival_pairs);
  visit("rival_alone", d.rival_alone);
  visit("rival_chi2", d.rival_chi2);
  visit("rival_dof", d.rival_dof);
}

template <class Visit>
void numbers(ClosureDecision& d, Visit&& visit) {
  visit("pairs", d.pairs);
  visit("dropped", d.dropped);
  visit("merged", d.merged);
  visit("cost", d.cost);
  visit("dof", d.dof);
  visit("limit", d.limit);
  visit("driven_m", d.driven_m);
  visit("moved_m", d.moved_m);
}

template <class Visit>
void numbers(UndecidedDecision& d, Visit&& visit) {
  visit("driven_m", d.driven_m);
}

template <class Visit>
void numbers(NewGroundDecision& d, Visit&& visit) {
  visit("driven_m", d.driven_m);
  visit("landmarks", d.landmarks);
}

template <class Visit>
void numbers(SmoothingDecision& d, Visit&& visit) {
  visit("chi2", d.chi2);
  visit("limit", d.limit);
  visit("poses", d.poses);
  visit("iterations", d.iterations);
  visit("moved_m", d.moved_m);
}

template <class Visit>
void numbers(FixDecision& d, Visit&& visit) {
  visit("nis", d.nis);
  visit("gate", d.gate);
  visit("x_m", d.position_world_m.x());
  visit("y_m", d.position_world_m.y());
  visit("pose_sigma_m", d.pose_sigma_m);
  visit("widened", d.widened);
}

template <class Visit>
void numbers(CarriedDecision& d, Visit&& visit) {
  visit("part", d.part);
  visit("from_part", d.from_part);
  visit("landmarks", d.landmarks);
  visit("dropped", d.dropped);
  visit("apart", d.apart);
  visit("driven_m", d.driven_m);
  if (d.cause == CarriedDecision::Cause::broken_off || d.cause == CarriedDecision::Cause::no_odometry) {
    visit("pose_sigma_m", d.pose_sigma_m);
    visit("heading_sigma_deg", d.heading_sigma_deg);
  }
  const bool has_scans = d.cause == CarriedDecision::Cause::by_place || d.cause == CarriedDecision::Cause::wrong_place;
  if (has_scans) visit("scans", d.scans);
  if (d.cause != CarriedDecision::Cause::found_out) return;
  visit("missing", d.missing);
  visit("seen", d.seen);
  visit("unknown", d.unknown);
  visit("elsewhere_nats", d.elsewhere_nats);
}

template <class Visit>
void numbers(PlacedDecision& d, Visit&& visit) {
  visit("earlier_landmarks", d.earlier_landmarks);
  visit("questions", d.questions);
  visit("landmarks", d.landmarks);
  visit("pairs", d.pairs);
  visit("evidence", d.evidence);
  visit("lead", d.lead);
  visit("needed", d.needed);
  visit("merged", d.merged);
  visit("cost", d.cost);
  visit("dof", d.dof);
  visit("limit", d.limit);
  visit("driven_m", d.driven_m);
  visit("x_m", d.T_map_session.x_m);
  visit("y_m", d.T_map_session.y_m);
  visit("heading_rad", d.T_map_session.heading_rad);
  visit("part", d.part);
}

template <class Visit>
void numbers(WholeMapDecision& d, Visit&& visit) {
  visit("old_landmarks", d.old_landmarks);
  visit("questions", d.questions);
  visit("landmarks", d.landmarks);
  visit("pairs", d.pairs);
  visit("evidence", d.evidence);
  visit("lead", d.lead);
  visit("needed", d.needed);
  visit("cost", d.cost);
  visit("dof", d.dof);
  visit("limit", d.limit);
  visit("odometry_factor", d.odometry_factor);
  visit("loop_m", d.loop_m);
  visit("displaced_m", d.displaced_m);
}

template <class Visit>
void numbers(PostponedDecision& d, Visit&& visit) {
  visit("size", d.size);
  visit("limit", d.limit);
}

constexpr const char* carried_words[] = {"told",        "found-out",   "broken-off", "by-place",
                                         "no-odometry", "wrong-start", "wrong-place"};
constexpr const char* postponed_words[] = {"association", "window", "drive"};
constexpr const char* whole_map_words[] = {"accepted", "ambiguous", "refused", "not-here"};
constexpr const char* placed_words[] = {"sought", "accepted", "ambiguous", "refused", "not-here"};
constexpr const char* reason_words[] = {"timed-out", "nothing-here", "abandoned", "outdone"};
constexpr const char* verification_words[] = {"accepted", "too-few-matches", "ratio-too-low", "rival-too-good"};

/// Index of the word; −1 when it is none of them.
template <std::size_t n>
int index_in(const char* const (&words)[n], std::string_view word) {
  const auto found = std::find(words, words + n, word);
  return found == words + n ? -1 : static_cast<int>(found - words);
}

const char* word_of(bool accepted) { return accepted ? "accepted" : "refused"; }

struct KindAndVerdict {
  const char* kind;
  const char* verdict;
};

KindAndVerdict words_of(const TriggerDecision&) { return {"trigger", "started"}; }
KindAndVerdict words_of(const RollbackDecision&) { return {"trigger", "rolled-back"}; }
KindAndVerdict words_of(const SlipDecision&) { return {"slip", "accepted"}; }
KindAndVerdict words_of(const LostBySlipDecision&) { return {"slip", "lost"}; }
KindAndVerdict words_of(const MovingDecision&) { return {"moving", "dropped"}; }
KindAndVerdict words_of(const SystematicDecision&) { return {"systematic", "taken-out"}; }
KindAndVerdict words_of(const NoiseDecision&) { return {"noise", "learnt"}; }
KindAndVerdict words_of(const AttemptStarted&) { return {"search", "started"}; }
KindAndVerdict words_of(const AttemptEnded& d) { return {"search", reason_words[static_cast<int>(d.reason)]}; }
KindAndVerdict words_of(const ReferenceUnusable&) { return {"search", "reference-unusable"}; }
KindAndVerdict words_of(const VerificationDecision& d) {
  return {"constellation", verification_words[static_cast<int>(d.verdict)]};
}
KindAndVerdict words_of(const ShapeDecision&) { return {"shape", "decided"}; }
KindAndVerdict words_of(const ClosureDecision& d) { return {"closure", word_of(d.accepted)}; }
KindAndVerdict words_of(const UndecidedDecision&) { return {"closure", "undecided"}; }
KindAndVerdict words_of(const NewGroundDecision&) { return {"closure", "new-ground"}; }
KindAndVerdict words_of(const SmoothingDecision& d) { return {"smoothing", word_of(d.accepted)}; }
KindAndVerdict words_of(const FixDecision& d) { return {"fix", word_of(d.accepted)}; }
KindAndVerdict words_of(const CarriedDecision& d) { return {"carried", carried_words[static_cast<int>(d.cause)]}; }
KindAndVerdict words_of(const PlacedDecision& d) { return {"placed", placed_words[static_cast<int>(d.verdict)]}; }

KindAndVerdict words_of(const WholeMapDecision& d) {
  return {"whole-map", whole_map_words[static_cast<int>(d.verdict)]};
}

KindAndVerdict words_of(const PostponedDecision& d) { return {"postponed", postponed_words[static_cast<int>(d.work)]}; }

/// Names that rows of earlier versions have.
std::string_view former_name(std::string_view name) {
  return name == "expected_confusers" ? std::string_view("foreign_objects") : name;
}

const double* find_number(const DecisionRow& row, std::string_view name) {
  const auto has = [&](std::string_view wanted) {
    return std::find_if(row.numbers.begin(), row.numbers.end(), [&](const auto& one) { return one.first == wanted; });
  };
  auto found = has(name);
  if (found == row.numbers.end()) found = has(former_name(name));
  return found == row.numbers.end() ? nullptr : &found->second;
}

template <class Typed>
Decision fill(Typed decision, const DecisionRow& row) {
  numbers(decision, [&](const char* name, auto& number) {
    if (const double* value = find_number(row, name)) number = static_cast<std::decay_t<decltype(number)>>(*value);
  });
  return decision;
}

template <class Typed>
Decision fill(Typed decision, bool accepted, const DecisionRow& row) {
  decision.accepted = accepted;
  return fill(decision, row);
}

Decision search_decision(const DecisionRow& row) {
  if (row.verdict == "started") return fill(AttemptStarted{}, row);
  if (row.verdict == "reference-unusable") return fill(ReferenceUnusable{}, row);
  const int reason = index_in(reason_words, row.verdict);
  if (reason < 0) return OtherDecision{row.kind, row.verdict, row.numbers};
  AttemptEnded ended;
  ended.reason = static_cast<AttemptEnded::Reason>(reason);
  return fill(ended, row);
}

Decision carried_decision(const DecisionRow& row) {
  CarriedDecision decision;
  const int cause = index_in(carried_words, row.verdict);
  if (cause < 0) return OtherDecision{row.kind, row.verdict, row.numbers};
  decision.cause = static_cast<CarriedDecision::Cause>(cause);
  return fill(decision, row);
}

Decision postponed_decision(const DecisionRow& row) {
  const int work = index_in(postponed_words, row.verdict);
  if (work < 0) return OtherDecision{row.kind, row.verdict, row.numbers};
  PostponedDecision postponed;
  postponed.work = static_cast<PostponedDecision::Work>(work);
  return fill(postponed, row);
}

template <class Typed, std::size_t n>
Decision decision_with(const char* const (&words)[n], const DecisionRow& row) {
  const int verdict = index_in(words, row.verdict);
  if (verdict < 0) return OtherDecision{row.kind, row.verdict, row.numbers};
  Typed decision;
  decision.verdict = static_cast<typename Typed::Verdict>(verdict);
  return fill(decision, row);
}

}  // namespace

DecisionRow row_of(const Decision& decision) {
  return std::visit(
      [](auto typed) {
        if constexpr (std::is_same_v<decltype(typed), OtherDecision>) {
          return DecisionRow{typed.kind, typed.verdict, typed.numbers};
        } else {
          const KindAndVerdict words = words_of(typed);
          DecisionRow row{words.kind, words.verdict, {}};
          numbers(typed,
                  [&](const char* name, auto& number) { row.numbers.emplace_back(name, static_cast<double>(number)); });
          return row;
        }
      },
      decision);
}

Decision decision_of(const DecisionRow& row) {
  const bool accepted = row.verdict == "accepted";
  const bool judged = accepted || row.verdict == "refused";
  if (row.kind == "trigger" && row.verdict == "started") return fill(TriggerDecision{}, row);
  const bool rolled_back = row.verdict == "rolled-back" || row.verdict == "rewound";  // the latter in earlier versions
  if (row.kind == "trigger" && rolled_back) return fill(RollbackDecision{}, row);
  if (row.kind == "slip" && accepted) return fill(SlipDecision{}, row);
  if (row.kind == "slip" && row.verdict == "lost") return fill(LostBySlipDecision{}, row);
  if (row.kind == "moving" && row.verdict == "dropped") return fill(MovingDecision{}, row);
  if (row.kind == "systematic" && row.verdict == "taken-out") return fill(SystematicDecision{}, row);
  if (row.kind == "noise" && row.verdict == "learnt") return fill(NoiseDecision{}, row);
  if (row.kind == "search") return search_decision(row);
  if (row.kind == "carried") return carried_decision(row);
  if (row.kind == "placed") return decision_with<PlacedDecision>(placed_words, row);
  if (row.kind == "postponed") return postponed_decision(row);
  if (row.kind == "whole-map") return decision_with<WholeMapDecision>(whole_map_words, row);
  if (row.kind == "constellation") return decision_with<VerificationDecision>(verification_words, row);
  if (row.kind == "shape" && row.verdict == "decided") return fill(ShapeDecision{}, row);
  if (row.kind == "closure" && row.verdict == "undecided") return fill(UndecidedDecision{}, row);
  if (row.kind == "closure" && row.verdict == "new-ground") return fill(NewGroundDecision{}, row);
  if (row.kind == "closure" && judged) return fill(ClosureDecision{}, accepted, row);
  if (row.kind == "smoothing" && judged) return fill(SmoothingDecision{}, accepted, row);
  if (row.kind == "fix" && judged) return fill(FixDecision{}, accepted, row);
  return OtherDecision{row.kind, row.verdict, row.numbers};
}

}  // namespace helixnav::core
