// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/reports/decision_sentence.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "helixnav/core/angle.hpp"

namespace helixnav::reports {
namespace {

double number(const core::Decision& decision, const char* name) {
  const auto found = std::find_if(decision.numbers.begin(), decision.numbers.end(),
                                  [&](const auto& number) { return number.first == name; });
  return found == decision.numbers.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
}

std::string text(const core::Decision& decision, const char* name) { return short_number(number(decision, name)); }

std::string degrees(double angle_rad) { return short_number(angle_rad * 180.0 / core::pi) + "°"; }

std::string rewound_sentence(const core::Decision& d) {
  return "The pose is not to be trusted: " + counted(number(d, "missing"), "landmark") +
         " of earlier drives that should be in view are missing, " + text(d, "seen") + " are there, and " +
         counted(number(d, "spawned"), "new one") + " matured meanwhile (" + text(d, "nats") +
         " nats against the pose). A search begins from " + counted(number(d, "scans"), "scan") +
         " ago, when the pose was last beyond doubt.";
}

std::string trigger_sentence(const core::Decision& d) {
  if (d.verdict == "rewound") return rewound_sentence(d);
  return "A search began: an observation was about to be matched with the old landmark " + text(d, "landmark") +
         ", and it may as well have been one of " + text(d, "foreign_objects") + " other objects to be expected; " +
         counted(number(d, "neighbours"), "old landmark") + " of the map among them. The pose was uncertain by " +
         text(d, "pose_sigma_m") + " m and " + text(d, "heading_sigma_deg") +
         "°. The old landmarks are set aside until it is known which is which.";
}

std::string search_sentence(const core::Decision& d) {
  const std::string attempt = "Attempt " + text(d, "attempt");
  if (d.verdict == "started") {
    return attempt + ": the particle filter began on the helices of " + counted(number(d, "helix_pairs"), "pair") +
           " of observation and old landmark.";
  }
  const std::string after = " after " + counted(number(d, "scans"), "scan");
  const std::string evidence = "log-evidence " + text(d, "log_evidence") + " against nothing here being old";
  if (d.verdict == "timed-out") return attempt + " ended" + after + " without a single mode (" + evidence + ").";
  if (d.verdict == "nothing-here") return attempt + " ended" + after + ": this is no old ground (" + evidence + ").";
  if (d.verdict == "abandoned") {
    return attempt + " was given up" + after + ": it held one mode, whose constellation was never accepted.";
  }
  if (d.verdict == "outdone") return attempt + " ended" + after + ": its own rival explains the constellation better.";
  return attempt + ": " + d.verdict + after + " (" + evidence + ").";
}

std::string rival_sentence(const core::Decision& d) {
  const std::string tried = counted(number(d, "rivals_tried"), "other pose") + " tried";
  if (!(number(d, "rival_matched") > 0.0)) return "Of " + tried + ", none matches enough to count as a rival.";
  const double away_m =
      std::hypot(number(d, "rival_x_m") - number(d, "x_m"), number(d, "rival_y_m") - number(d, "y_m"));
  const double turned_rad = std::abs(core::wrap_to_pi(number(d, "rival_heading_rad") - number(d, "heading_rad")));
  return "Of " + tried + ", the best rival is " + short_number(away_m) + " m and " + degrees(turned_rad) +
         " away: it matches " + text(d, "rival_matched") + " with a ratio of " + text(d, "rival_ratio") + ", " +
         text(d, "rival_share") + " of the winner's.";
}

std::string constellation_verdict(const std::string& verdict) {
  if (verdict == "accepted") return "The constellation test was passed";
  if (verdict == "too-few-matches") return "The constellation test was not passed, too few landmarks matched";
  if (verdict == "ratio-too-low") return "The constellation test was not passed, too many landmarks contradict";
  if (verdict == "rival-too-good") return "The constellation test was not passed, another pose explains as much";
  return "The constellation test: " + verdict;
}

std::string constellation_sentence(const core::Decision& d) {
  return constellation_verdict(d.verdict) + ": at (" + text(d, "x_m") + ", " + text(d, "y_m") + ") m, heading " +
         degrees(number(d, "heading_rad")) + ", " + counted(number(d, "matched"), "new landmark") +
         " on old ones; unmatched on ground that both drives looked at: " + text(d, "unmatched_branch") + " new and " +
         text(d, "unmatched_old") + " old; ratio " + text(d, "ratio") + ". " + rival_sentence(d);
}

std::string closure_sentence(const core::Decision& d) {
  if (d.verdict == "undecided") {
    return "Left undecided: no closing was accepted in " + text(d, "driven_m") +
           " m. The map goes on as on new ground; the next ambiguous return asks again.";
  }
  const std::string cost = "the cost " + text(d, "cost") + " of " + counted(number(d, "pairs"), "pair");
  const std::string dropped = counted(number(d, "dropped"), "pair") + " dropped";
  const std::string limit = text(d, "limit") + ", the limit for " + text(d, "dof") + " degrees of freedom";
  if (d.verdict == "refused") {
    const bool too_dear = number(d, "cost") > number(d, "limit");
    return "Refused: " + cost + (too_dear ? " exceeds " : " stands against ") + limit + " (" + dropped +
           (too_dear ? "): they cannot all be right. The map stays as it was." : "). The map stays as it was.");
  }
  if (number(d, "dof") == 0.0) {
    return "Accepted: the pose is that of the particles, and what was mapped since the trigger is forgotten; nothing "
           "speaks "
           "for it but " +
           counted(number(d, "pairs"), "pair") + ". The pose moved by " + text(d, "moved_m") + " m, " +
           text(d, "driven_m") + " m after the trigger.";
  }
  return "Accepted: " + cost + " is within " + limit + " (" + dropped + "). The pose moved by " + text(d, "moved_m") +
         " m, " + text(d, "driven_m") + " m after the trigger.";
}

std::string smoothing_sentence(const core::Decision& d) {
  const std::string cost = short_number(std::round(number(d, "chi2")));
  const std::string work = counted(number(d, "poses"), "pose") + ", " + counted(number(d, "iterations"), "iteration");
  const std::string limit =
      short_number(std::round(number(d, "limit"))) + " (what the filter had come to, and some slack)";
  if (d.verdict != "accepted") {
    return "The drive was not solved as a whole: least squares ended at " + cost + " (" + work +
           ") and had to settle within " + limit + ". The map stays as the closing left it.";
  }
  return "Then the drive was solved as a whole: least squares ended at " + cost + " (" + work + "), within " + limit +
         ". The pose moved by another " + text(d, "moved_m") + " m.";
}

std::string fix_sentence(const core::Decision& d) {
  const bool used = d.verdict == "accepted";
  return std::string("A position fix was ") + (used ? "used" : "refused") + ": NIS " + text(d, "nis") +
         (used ? " within the gate " : " beyond the gate ") + text(d, "gate") + ".";
}

std::string plain_sentence(const core::Decision& d) {
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
  const bool whole = std::abs(value) < 1e9 && value == std::round(value);
  std::snprintf(text, sizeof(text), whole ? "%.0f" : "%.3g", value);
  return text;
}

std::string counted(double value, const std::string& noun) {
  return short_number(value) + ' ' + noun + (value == 1.0 ? "" : "s");
}

std::string sentence_of(const core::Decision& decision) {
  if (decision.kind == "trigger") return trigger_sentence(decision);
  if (decision.kind == "search") return search_sentence(decision);
  if (decision.kind == "constellation") return constellation_sentence(decision);
  if (decision.kind == "closure") return closure_sentence(decision);
  if (decision.kind == "smoothing") return smoothing_sentence(decision);
  if (decision.kind == "fix") return fix_sentence(decision);
  return plain_sentence(decision);
}

}  // namespace helixnav::reports
