// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/reports/decision_sentence.hpp"

#include <cmath>
#include <cstdio>
#include <variant>

#include "helixnav/core/angle.hpp"
#include "systematic_errors_text.hpp"

namespace helixnav::reports {
namespace {

std::string degrees(double angle_rad) { return short_number(angle_rad * 180.0 / core::pi) + "°"; }

std::string sentence(const core::RollbackDecision& d) {
  return "The pose cannot be trusted: " + counted(d.missing, "landmark") +
         " mapped earlier that should be in view are missing, " + short_number(d.seen) + " were seen, and " +
         counted(d.spawned, "new one") + " matured meanwhile (" + short_number(d.nats) +
         " nats against the pose). The navigator rolls back by " + counted(d.scans, "scan") +
         " to its last trusted checkpoint and searches from there.";
}

std::string sentence(const core::TriggerDecision& d) {
  return "A search began: an observation was about to be matched with the old landmark " + std::to_string(d.landmark) +
         ", but it may also have come from one of " + short_number(d.expected_confusers) + " other expected objects, " +
         counted(d.neighbours, "old landmark") + " among them. The pose was uncertain by " +
         short_number(d.pose_sigma_m) + " m and " + short_number(d.heading_sigma_deg) +
         "°. The old landmarks are excluded until the search ends.";
}

std::string sentence(const core::SlipDecision& d) {
  return "The vehicle slipped: it is " + short_number(d.moved_m) + " m and " + short_number(d.turned_deg) +
         "° from where its odometry puts it. " + counted(d.pairs, "landmark") +
         " stand as they should from there, which explains the scan " + short_number(d.nats) +
         " nats better than no slip and " + short_number(d.rival_nats) +
         " better than a slip to anywhere else. The pose was widened by " + short_number(d.sigma_m) + " m.";
}

std::string sentence(const core::LostBySlipDecision& d) {
  return "The vehicle slipped, and one scan does not show where to: " + counted(d.missing, "landmark") +
         " of the scan before that should still be in view are missing, " + short_number(d.seen) +
         " were seen again, and " + counted(d.unknown, "unknown one") + " came instead (" + short_number(d.nats) +
         " nats for a slip). The pose was widened by " + short_number(d.sigma_m) +
         " m, and a search began. If it was carried, it may be anywhere: until landmarks tie its pose to the map "
         "again, the "
         "covariance reported covers the whole map.";
}

std::string sentence(const core::MovingDecision& d) {
  return "A moving object, at " + short_number(d.speed_mps) +
         " m/s, had been mapped: " + counted(d.landmarks, "landmark") + " dropped. Motion explains its sightings " +
         short_number(d.nats) + " nats better than a static landmark.";
}

std::string sentence(const core::SystematicDecision& d) {
  const bool is_whole = d.solved_again != 0;
  if (const std::string errors = systematic_errors_text(d); errors.empty()) {
    return "What had been taken out of odometry and detections was put back" +
           std::string(is_whole ? "" : " from here on") + ", since it has changed: without, " +
           short_number(d.stretches) + " stretches of the drive are explained " + short_number(d.nats) +
           " nats better than before.";
  }
  return "Odometry and detections contradict each other in the same way throughout: " + systematic_errors_text(d) +
         ". This explains " + short_number(d.stretches) + " stretches of the drive " + short_number(d.nats) +
         " nats better than before. It " +
         (is_whole ? "was taken out of the whole drive."
                   : "is taken out from here on; what was mapped before still has its effect.");
}

std::string sentence(const core::NoiseDecision& d) {
  std::string errors;
  const auto add = [&](const char* what, double times) {
    if (times != 1.0)
      errors += (errors.empty() ? "" : ", ") + std::string(what) + short_number(times) + " times as much";
  };
  add("odometry errs ", d.odometry);
  add("detections err ", d.detections);
  add("fixes err ", d.fixes);
  return "The drive shows other noise than was stated: " + (errors.empty() ? std::string("none, after all") : errors) +
         (d.solved_again != 0 ? ". What was driven before was solved again with it."
                              : ". That holds from now on; what was driven before stays as it was.");
}

std::string attempt_number(int attempt) { return "Attempt " + std::to_string(attempt); }

std::string sentence(const core::AttemptStarted& d) {
  return attempt_number(d.attempt) + ": the particle filter began on the helices of " + counted(d.helix_pairs, "pair") +
         " of observation and old landmark.";
}

std::string sentence(const core::AttemptEnded& d) {
  const std::string attempt = attempt_number(d.attempt);
  const std::string after = " after " + counted(d.scans, "scan");
  const std::string evidence = "log-evidence " + short_number(d.log_evidence) + " for old ground against new";
  switch (d.reason) {
    case core::AttemptEnded::Reason::timed_out:
      return attempt + " ended" + after + " without a single mode (" + evidence + ").";
    case core::AttemptEnded::Reason::nothing_here:
      return attempt + " ended" + after + ": this is not old ground (" + evidence + ").";
    case core::AttemptEnded::Reason::abandoned:
      return attempt + " was given up" + after + ": it held one mode, whose constellation was never accepted.";
    case core::AttemptEnded::Reason::outdone:
      return attempt + " ended" + after + ": a rival pose explains the constellation better.";
  }
  return {};
}

std::string sentence(const core::ReferenceUnusable& d) {
  return attempt_number(d.attempt) + " could not begin: the relative positions of the " +
         counted(d.reference_landmarks, "old landmark") + " in reach are not known well enough.";
}

std::string rival_sentence(const core::VerificationDecision& d) {
  const std::string tried = counted(d.rivals_tried, "other pose") + " tried";
  if (d.rival_matched == 0) return "Of " + tried + ", none matches enough to count as a rival.";
  const double away_m = (d.T_world_rival.position_m() - d.T_world_winner.position_m()).norm();
  const double turned_rad = std::abs(core::wrap_to_pi(d.T_world_rival.heading_rad - d.T_world_winner.heading_rad));
  return "Of " + tried + ", the best rival is " + short_number(away_m) + " m and " + degrees(turned_rad) +
         " away: it matches " + short_number(d.rival_matched) + " with a ratio of " + short_number(d.rival_ratio) +
         ", " + short_number(d.rival_share) + " of the winner's.";
}

std::string verdict_of(core::VerificationDecision::Verdict verdict) {
  switch (verdict) {
    case core::VerificationDecision::Verdict::accepted:
      return "The constellation test was passed";
    case core::VerificationDecision::Verdict::too_few_matches:
      return "The constellation test failed, too few landmarks matched";
    case core::VerificationDecision::Verdict::ratio_too_low:
      return "The constellation test failed, too many landmarks contradict it";
    case core::VerificationDecision::Verdict::rival_too_good:
      return "The constellation test failed, a rival pose explains nearly as much";
  }
  return {};
}

std::string sentence(const core::VerificationDecision& d) {
  return verdict_of(d.verdict) + ": at (" + short_number(d.T_world_winner.x_m) + ", " +
         short_number(d.T_world_winner.y_m) + ") m, heading " + degrees(d.T_world_winner.heading_rad) + ", " +
         counted(d.matched, "new landmark") +
         " matched to old ones; unmatched in the area covered by both drives: " + short_number(d.unmatched_branch) +
         " new and " + short_number(d.unmatched_old) + " old; ratio " + short_number(d.ratio) + ". " +
         rival_sentence(d);
}

std::string sentence(const core::ShapeDecision& d) {
  const auto fit = [](int pairs, int alone, double chi2, int dof) {
    return short_number(pairs) + " landmarks mapped since the search began match old ones, " + short_number(alone) +
           " have no partner, and χ² is " + short_number(chi2) + " with " + short_number(dof) + " degrees of freedom";
  };
  return "The surroundings of the vehicle look alike at " + counted(d.places, "place") +
         ", and the shape of the drive decides for one of them: " + fit(d.pairs, d.alone, d.chi2, d.dof) +
         ". At the best of the others " + fit(d.rival_pairs, d.rival_alone, d.rival_chi2, d.rival_dof) + ".";
}

std::string sentence(const core::UndecidedDecision& d) {
  return "Left undecided: no closing was accepted in " + short_number(d.driven_m) +
         " m. Mapping goes on as on new ground; the next ambiguous return begins a new search.";
}

std::string sentence(const core::NewGroundDecision& d) {
  return "New ground: after " + short_number(d.driven_m) + " m, " + counted(d.landmarks, "landmark") +
         " mapped recently fit nowhere on the old ground, although that many would be enough. Mapping goes on.";
}

std::string refusal(const core::ClosureDecision& d, const std::string& cost, const std::string& limit,
                    const std::string& dropped) {
  const bool too_costly = d.cost > d.limit;
  return "Refused: " + cost + (too_costly ? " exceeds " : " stands against ") + limit + " (" + dropped +
         (too_costly ? "): they cannot all be right. The map stays as it was." : "). The map stays as it was.");
}

std::string sentence(const core::ClosureDecision& d) {
  const std::string cost = "the cost " + short_number(d.cost) + " of " + counted(d.pairs, "pair");
  const std::string dropped = counted(d.dropped, "pair") + " dropped";
  const std::string limit = short_number(d.limit) + ", the limit for " + short_number(d.dof) + " degrees of freedom";
  if (!d.accepted && d.dof == 0) {
    return "Refused: the map is too uncertain for the cost of " + counted(d.pairs, "pair") +
           " to be computed. The map stays as it was.";
  }
  if (!d.accepted) return refusal(d, cost, limit, dropped);
  const std::string moved =
      "The pose moved by " + short_number(d.moved_m) + " m, " + short_number(d.driven_m) + " m after the trigger.";
  if (d.dof == 0) {
    return "Accepted: the pose is that of the particles, and what was mapped since the trigger is forgotten; the only "
           "evidence is " +
           counted(d.pairs, "pair") + ". " + moved;
  }
  return "Accepted: " + cost + " is within " + limit + " (" + dropped + "). " + moved;
}

std::string sentence(const core::SmoothingDecision& d) {
  const std::string cost = short_number(std::round(d.chi2));
  const std::string work = counted(d.poses, "pose") + ", " + counted(d.iterations, "front");
  const std::string limit =
      short_number(std::round(d.limit)) + " (the cost of the filter's own solution, with some slack)";
  if (!d.accepted) {
    return "The drive was not solved as a whole: least squares ended at " + cost + " (" + work +
           ") and had to end within " + limit + ". The map stays as the closing left it.";
  }
  return "Then the drive was solved as a whole: least squares ended at " + cost + " (" + work + "), within " + limit +
         ". The pose moved by another " + short_number(d.moved_m) + " m.";
}

std::string sentence(const core::FixDecision& d) {
  return std::string("A position fix was ") + (d.accepted ? "used" : "refused") + ": NIS " + short_number(d.nis) +
         (d.accepted ? " within the gate " : " beyond the gate ") + short_number(d.gate) + ".";
}

std::string why_carried(const core::CarriedDecision& d) {
  using Cause = core::CarriedDecision::Cause;
  if (d.cause == Cause::told) return "The vehicle was carried (event lost).";
  if (d.cause == Cause::broken_off) {
    return "The computation could not go on with a pose uncertain by " + short_number(d.pose_sigma_m) + " m and " +
           short_number(d.heading_sigma_deg) + "°.";
  }
  if (d.cause == Cause::no_odometry) {
    return "Odometry does not tell where the vehicle went since the previous scan: uncertain by " +
           short_number(d.pose_sigma_m) + " m and " + short_number(d.heading_sigma_deg) + "°.";
  }
  if (d.cause == Cause::by_place) {
    return "The vehicle was carried " + counted(d.scans, "scan") +
           " ago, which nobody noticed: the landmarks mapped since are elsewhere on the map.";
  }
  return "The vehicle was carried during a pause: after it " + std::to_string(d.missing) + " of " +
         counted(d.missing + d.seen, "landmark") + " that had been in view " + (d.missing == 1 ? "was" : "were") +
         " missing, and " + counted(d.unknown, "observation") +
         " fitted none of them: " + short_number(d.elsewhere_nats) + " nats likelier elsewhere than where it stopped.";
}

std::string sentence(const core::CarriedDecision& d) {
  if (d.cause == core::CarriedDecision::Cause::wrong_start) {
    return "The start differs from the one given, or from where the run of the map ended: the landmarks of the first "
           "scans are not around it on the map. The vehicle searches for its place there.";
  }
  if (d.cause == core::CarriedDecision::Cause::wrong_place) {
    return "The place that was found on another map is wrong: what was mapped since is elsewhere on it. The drive "
           "since then "
           "was processed again, as part " +
           std::to_string(d.part) + '.';
  }
  const std::string ended = why_carried(d) + " Part " + std::to_string(d.from_part) + " of the drive ends after " +
                            short_number(d.driven_m) + " m";
  const std::string kept = d.landmarks > 0 ? ": " + counted(d.landmarks, "landmark") + " of it " +
                                                 (d.landmarks == 1 ? "is" : "are") + " kept as a map of its own"
                                           : ", with too few landmarks to be found again: they are dropped";
  return ended + kept + ". Part " + std::to_string(d.part) +
         " begins where the vehicle is, maps on its own and searches for its place in " + counted(d.apart, "map") + '.';
}

std::string map_of(const core::PlacedDecision& d) {
  return d.part == 0 ? std::string("the earlier map") : "the map of part " + std::to_string(d.part);
}

/// Where the session was on the earlier map when it began.
std::string begin_of(const core::PlacedDecision& d) {
  return "it began at (" + short_number(d.T_map_session.x_m) + ", " + short_number(d.T_map_session.y_m) +
         ") m, heading " + degrees(d.T_map_session.heading_rad);
}

template <class OfPlace>
std::string evidence_of(const OfPlace& d, const char* which = " around the vehicle") {
  return short_number(d.pairs) + " of " + counted(d.landmarks, "landmark") + which + " agree with the map, " +
         short_number(d.evidence) + " nats better than chance and " + short_number(d.lead) +
         " ahead of any other place (" + short_number(d.needed) + " are needed for each)";
}

std::string sentence(const core::PlacedDecision& d) {
  const std::string after = " after " + short_number(d.driven_m) + " m, question " + std::to_string(d.questions) + ": ";
  switch (d.verdict) {
    case core::PlacedDecision::Verdict::sought:
      return "This session does not know where it is on a map of " + counted(d.earlier_landmarks, "landmark") +
             " from an earlier one: it maps on its own and searches for its place.";
    case core::PlacedDecision::Verdict::accepted:
      return "Found its place on " + map_of(d) + after + evidence_of(d) + "; their joint cost " + short_number(d.cost) +
             " is within " + short_number(d.limit) + ". From here on both are one map (" +
             counted(d.merged, "landmark") + " merged); " + begin_of(d) + " of it.";
    case core::PlacedDecision::Verdict::ambiguous:
      return "Not placed" + after + "a place fits, and others may as well: " + evidence_of(d) + '.';
    case core::PlacedDecision::Verdict::refused:
      if (d.cost <= d.limit) {
        return "Not placed" + after + "the drive could not be solved together with that of the map. " + evidence_of(d) +
               '.';
      }
      return "Not placed" + after + "the pairs contradict each other, their joint cost " + short_number(d.cost) +
             " exceeds " + short_number(d.limit) + ". " + evidence_of(d) + '.';
    case core::PlacedDecision::Verdict::not_here:
      return "Not placed" + after + "no place on " + map_of(d) + " fits the " + counted(d.landmarks, "landmark") +
             " around the vehicle better than chance" + (d.pairs > 0 ? "; the best: " + evidence_of(d) : "") + '.';
  }
  return {};
}

/// How odometry was made to agree with the place.
std::string odometry_of(const core::WholeMapDecision& d) {
  const std::string apart = "Odometry puts the vehicle " + short_number(d.displaced_m) + " m from there";
  if (d.odometry_factor == 1.0) return apart + ", which is within its noise.";
  const std::string forbids = apart + ", and the pairs would cost " + short_number(d.cost) + " (limit " +
                              short_number(d.limit) + "): it was wrong. ";
  if (d.odometry_factor == 0.0) return forbids + "The drive was cut, as if the vehicle had been carried there.";
  return forbids + "The noise of the last " + short_number(d.loop_m) + " m is taken to be " +
         short_number(std::sqrt(d.odometry_factor)) + " times as large.";
}

std::string sentence(const core::WholeMapDecision& d) {
  const std::string asked = "The whole map of " + counted(d.old_landmarks, "old landmark") +
                            " was searched (question " + std::to_string(d.questions) + "): ";
  switch (d.verdict) {
    case core::WholeMapDecision::Verdict::accepted:
      return asked + evidence_of(d) + ". " + odometry_of(d);
    case core::WholeMapDecision::Verdict::ambiguous:
      return asked + "a place fits, and others may as well: " + evidence_of(d) + '.';
    case core::WholeMapDecision::Verdict::refused:
      return asked + "the pairs of the best place contradict each other. " + evidence_of(d) + '.';
    case core::WholeMapDecision::Verdict::not_here:
      return asked + "no place fits the " + counted(d.landmarks, "landmark") +
             " around the vehicle better than chance.";
  }
  return {};
}

std::string sentence(const core::PostponedDecision& d) {
  switch (d.work) {
    case core::PostponedDecision::Work::association:
      return "The search for the best association of " + counted(d.size, "observation") + " was ended after " +
             short_number(d.limit) + " hypotheses: the best one found is reported; it is not proven optimal.";
    case core::PostponedDecision::Work::window:
      return "The filter could not be handed over to another part of the map, which could not be solved: it goes on "
             "with its " +
             counted(d.size, "landmark") + " (the target is " + short_number(d.limit) + ") and tries again later.";
    case core::PostponedDecision::Work::drive:
      return "The drive of " + counted(d.size, "scan") + " and fixes is not solved as a whole: it is kept for up to " +
             short_number(d.limit) + " of them (search.smooth_up_to_scans).";
  }
  return {};
}

std::string sentence(const core::OtherDecision& d) {
  std::string sentence = d.kind + " " + d.verdict;
  char separator = ':';
  for (const auto& [name, value] : d.numbers) {
    sentence += std::string(1, separator) + ' ' + name + " = " + short_number(value);
    separator = ',';
  }
  return sentence + '.';
}

}  // namespace

std::string short_number(double value) {
  if (std::isnan(value)) return "an unknown number";
  char text[40];
  const bool whole = std::abs(value) < 1e9 && (value == std::round(value) || std::abs(value) >= 100.0);
  std::snprintf(text, sizeof(text), whole ? "%.0f" : "%.3g", value);
  return text;
}

std::string counted(double value, const std::string& noun) {
  return short_number(value) + ' ' + noun + (value == 1.0 ? "" : "s");
}

std::string sentence_of_join(const core::PlacedDecision& d) {
  const std::string best = evidence_of(d, " of the best question");
  const std::string asked =
      " (" + counted(d.questions, "question") + " to a map of " + counted(d.earlier_landmarks, "landmark") + "): ";
  switch (d.verdict) {
    case core::PlacedDecision::Verdict::sought:
      return "Defines the frame of its component; no question was asked.";
    case core::PlacedDecision::Verdict::accepted:
      return "Found its place" + asked + best + "; their joint cost " + short_number(d.cost) + " is within " +
             short_number(d.limit) + ". Both are one map (" + counted(d.merged, "landmark") + " merged); " +
             begin_of(d) + " of it.";
    case core::PlacedDecision::Verdict::ambiguous:
      return "Not placed" + asked + "a place fits, and others may as well: " + best + '.';
    case core::PlacedDecision::Verdict::refused:
      return "Not placed" + asked + "the pairs contradict each other, their joint cost " + short_number(d.cost) +
             " exceeds " + short_number(d.limit) + ". " + best + '.';
    case core::PlacedDecision::Verdict::not_here:
      return "Not placed" + asked + "no place fits better than chance" + (d.pairs > 0 ? "; the best: " + best : "") +
             '.';
  }
  return {};
}

std::string sentence_of(const core::Decision& decision) {
  return std::visit([](const auto& typed) { return sentence(typed); }, decision);
}

}  // namespace helixnav::reports
