// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/reports/run_warnings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>
#include <utility>
#include <variant>

#include "closing_warnings.hpp"
#include "frame_of_map.hpp"
#include "helixnav/reports/decision_sentence.hpp"
#include "helixnav/runs/only_localized.hpp"
#include "known_by_name.hpp"
#include "left_twice_text.hpp"
#include "never_placed_text.hpp"
#include "numerics_text.hpp"
#include "open_searches.hpp"
#include "place_questions.hpp"
#include "scans_apart.hpp"
#include "systematic_errors_text.hpp"
#include "wrong_place_text.hpp"

namespace helixnav::reports {
namespace {

/// What became of the observations of a run.
struct ObservationCounts {
  std::size_t seen = 0, matched = 0, began = 0;
  std::size_t waiting = 0;  ///< ranges or bearings alone of landmarks that they have not yet placed
};

/// Whether the place on the map is known after the step, if it was before.
bool knows_place_after(const core::StepReport& step, bool knows) {
  for (const core::Decision& decision : step.decisions) {
    const auto* placed = std::get_if<core::PlacedDecision>(&decision);
    if (placed != nullptr) knows = placed->verdict == core::PlacedDecision::Verdict::accepted;
    if (std::holds_alternative<core::CarriedDecision>(decision)) knows = false;
  }
  return knows;
}

/// Who only localises matches nothing before the place is found, which says nothing against odometry and detections.
ObservationCounts count_observations(const runs::Run& run) {
  ObservationCounts counts;
  bool counts_step = true;
  const bool by_name = known_by_name(run);
  for (const core::StepReport& step : run.steps) {
    if (runs::only_localized(run)) counts_step = knows_place_after(step, counts_step);
    if (!counts_step) continue;
    counts.seen += step.associations.size();
    for (const core::AssociationReport& a : step.associations) {
      counts.matched += a.outcome == core::Outcome::matched ? 1 : 0;
      counts.began += a.outcome == core::Outcome::augmented ? 1 : 0;
      counts.waiting += by_name && a.outcome == core::Outcome::ambiguous ? 1 : 0;
    }
  }
  return counts;
}

template <class... Values>
std::string warning(const char* format, Values... values) {
  std::array<char, 600> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, values...);
  return buffer.data();
}

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

/// Landmarks that were begun and never matched.
std::size_t never_seen_again(const runs::Run& run) {
  std::set<core::LandmarkId> began, matched;
  for (const core::StepReport& step : run.steps) {
    for (const core::AssociationReport& a : step.associations) {
      if (a.outcome == core::Outcome::augmented) began.insert(a.landmark);
      if (a.outcome == core::Outcome::matched) matched.insert(a.landmark);
    }
  }
  return static_cast<std::size_t>(
      std::count_if(began.begin(), began.end(), [&](core::LandmarkId id) { return matched.count(id) == 0; }));
}

std::string no_landmark_text(const ObservationCounts& counts, const runs::Run& run) {
  if (run.steps.empty()) return "no scan came in: there is neither a path nor a map";
  if (counts.seen == 0) return "the scans hold no detections: nothing was mapped, and the path is odometry alone";
  constexpr int enough_to_tell = 10;  // scans; a landmark needs looks from three places, so each look had three chances
  const auto seeing = std::count_if(run.steps.begin(), run.steps.end(),
                                    [](const core::StepReport& step) { return !step.associations.empty(); });
  if (seeing < enough_to_tell) return {};
  return warning(
      "the map has no landmark: of %zu detections %zu were matched, and %zu of the %zu landmarks begun were never seen "
      "again. Are reach, mounting and noise right for this sensor? 'helixnav check' shows what was understood",
      counts.seen, counts.matched, never_seen_again(run), counts.began);
}

bool has_mature_landmark(const runs::Run& run) {
  return std::any_of(run.map.begin(), run.map.end(),
                     [](const core::MapLandmark& landmark) { return landmark.state == core::LandmarkState::mature; });
}

std::string waiting_text(const ObservationCounts& counts) {
  return warning(
      "%.0f %% of %zu detections are ranges or bearings of landmarks that could not be placed from them: while they "
      "pass, the odometry errs by more than what is seen of them changes, or the view is too narrow. 'helixnav smooth' "
      "solves the whole drive at once and places what can be placed",
      100.0 * share(counts.waiting, counts.seen), counts.seen);
}

std::string collapse_text(const ObservationCounts& counts, const runs::Run& run) {
  if (const std::string text = scans_apart_text(run); !text.empty()) {
    return warning("of %zu detections %.0f %% were matched; %s", counts.seen,
                   100.0 * share(counts.matched, counts.seen), text.c_str());
  }
  return warning(
      "matching collapsed: of %zu detections only %.0f %% were matched and %.0f %% started landmarks. Odometry or "
      "detections are worse than assumed, or mounting, units or times are wrong. "
      "'helixnav check' shows what was understood, 'helixnav calibrate' estimates the noise from the log",
      counts.seen, 100.0 * share(counts.matched, counts.seen), 100.0 * share(counts.began, counts.seen));
}

/// Empty unless the particles hardly know other paths than one, which ESS and NIS do not show.
std::string ancestors_text(const evaluation::Evaluation& evaluation) {
  constexpr std::size_t few = 3;
  if (!evaluation.particles || evaluation.particles->least_ancestors > few) return {};
  return warning(
      "the covariance of this run is not to be trusted: all particles descend from %zu of those a loop's length ago, "
      "so that the path before is a single guess, wrong by as much as the odometry was (docs/fastslam.md). The default "
      "filter keeps the uncertainty of a loop",
      evaluation.particles->least_ancestors);
}

std::string nis_text(double mean_per_dof) {
  const double factor = std::sqrt(std::max(mean_per_dof, 1e-6));
  if (mean_per_dof > 1.0) {
    return warning(
        "innovations are %.2g times larger than the assumed noise predicts (NIS %.3g per degree of freedom): "
        "the covariances are too small; 'helixnav calibrate' estimates the noise from the log",
        factor, mean_per_dof);
  }
  return warning(
      "innovations are %.2g times smaller than the assumed noise predicts (NIS %.3g per degree of freedom): the "
      "detections are better than assumed. Loops are harder to close than they need be, and odometry that is worse "
      "than "
      "assumed does not show. 'helixnav calibrate' estimates both from the log",
      1.0 / factor, mean_per_dof);
}

/// Empty unless the gate refused more of the position fixes than outliers of a receiver are.
std::string fixes_text(const runs::Run& run) {
  std::size_t used = 0, refused = 0;
  for (const core::StepReport& step : run.steps) {
    for (const core::Decision& decision : step.decisions) {
      const auto* fix = std::get_if<core::FixDecision>(&decision);
      if (fix != nullptr) ++(fix->accepted ? used : refused);
    }
  }
  constexpr std::size_t enough = 20;
  constexpr double most_refused = 0.2;
  if (used + refused < enough || share(refused, used + refused) <= most_refused) return {};
  return warning(
      "%zu of %zu position fixes were refused: they are noisier than stated (sigma, gps.sigma_m), [antenna] gives a "
      "wrong position, their clock differs from the log's, or the first ones, which align the start, were wrong",
      refused, used + refused);
}

/// Empty unless fixes were found to err alike, or to be far noisier than stated, when the run ended.
std::string widened_fixes_text(const runs::Run& run) {
  double widened = 1.0;
  for (const core::StepReport& step : run.steps) {
    for (const core::Decision& decision : step.decisions) {
      const auto* fix = std::get_if<core::FixDecision>(&decision);
      if (fix != nullptr) widened = fix->widened;
    }
  }
  constexpr double worth_saying = 4.0;
  if (widened < worth_saying) return {};
  return warning(
      "position fixes err alike over many of them, or by more than stated (sigma, gps.sigma_m): each of the last ones "
      "was used with %.1f times its standard deviation, and the path may be off by as much as they are. An antenna "
      "that is not where [antenna] says and a clock that is not the log's look like this, too",
      std::sqrt(widened));
}

/// By more than the pose is uncertain: pairs of the right place may contradict each other, too.
bool is_elsewhere(const core::WholeMapDecision& asked, const core::PoseGaussian& pose) {
  constexpr double sigmas = 3.0;
  return asked.displaced_m > sigmas * std::sqrt(std::max(0.0, pose.covariance.topLeftCorner<2, 2>().trace()));
}

/// How often in a row the whole map surely had another place for what was mapped than the vehicle was believed to be at, and nothing
/// came of it.
struct ContradictedPlaces {
  int times = 0;
  int by_far = 0;       ///< of these, by more than any map is bent
  double away_m = 0.0;  ///< the last one
};

ContradictedPlaces contradicted_places(const runs::Run& run) {
  constexpr double far = 30.0;  // times what the pairs of a closing may cost
  ContradictedPlaces places;
  for (const core::StepReport& step : run.steps) {
    for (const core::Decision& decision : step.decisions) {
      const auto* placed = std::get_if<core::PlacedDecision>(&decision);
      const auto* asked = std::get_if<core::WholeMapDecision>(&decision);
      const auto* closure = std::get_if<core::ClosureDecision>(&decision);
      const bool accepted = (closure != nullptr && closure->accepted) ||
                            (placed != nullptr && placed->verdict == core::PlacedDecision::Verdict::accepted) ||
                            (asked != nullptr && asked->verdict == core::WholeMapDecision::Verdict::accepted);
      if (accepted || std::holds_alternative<core::CarriedDecision>(decision)) places = {};
      if (asked == nullptr || asked->verdict != core::WholeMapDecision::Verdict::refused) continue;
      if (asked->lead < asked->needed) continue;  // another place may fit as well
      if (!is_elsewhere(*asked, step.pose)) continue;
      ++places.times;
      places.by_far += asked->cost > far * asked->limit ? 1 : 0;
      places.away_m = asked->displaced_m;
    }
  }
  return places;
}

/// Empty unless the odometry and what is seen contradict each other all along, as with a mounting, a delay or a scale that is far
/// off. Of 230 runs that were well calibrated none had 17 % of its detections rejected (with walkers among them), nor slips decided
/// in 2 % of its scans (with slips in the odometry); badly calibrated ones had 27 % and more, or 9 % and more.
std::string calibration_text(const runs::Run& run) {
  std::size_t seen = 0, rejected = 0, slips = 0;
  for (const core::StepReport& step : run.steps) {
    seen += step.associations.size();
    for (const core::AssociationReport& a : step.associations) {
      rejected += a.outcome == core::Outcome::rejected && a.landmark == core::no_landmark ? 1 : 0;
    }
    for (const core::Decision& decision : step.decisions) {
      slips += std::holds_alternative<core::SlipDecision>(decision) ? 1 : 0;
    }
  }
  constexpr std::size_t enough = 200, many_slips = 10;
  constexpr double most_rejected = 0.2, most_slips = 0.04;
  const char* const advice =
      "mounting, delay, scale or bias differ from what is assumed; do not trust the map. 'helixnav calibrate' "
      "estimates them from the log, 'helixnav check' shows what was understood";
  if (slips >= many_slips && share(slips, run.steps.size()) > most_slips) {
    return warning("the odometry seems to have slipped in %zu of %zu scans, which no wheel does: %s", slips,
                   run.steps.size(), advice);
  }
  if (seen >= enough && share(rejected, seen) > most_rejected) {
    return warning("%.0f %% of %zu detections were rejected because they fit nothing: unless that much is moving, %s",
                   100.0 * share(rejected, seen), seen, advice);
  }
  return {};
}

bool has_match(const core::StepReport& step) {
  return std::any_of(step.associations.begin(), step.associations.end(),
                     [](const core::AssociationReport& a) { return a.outcome == core::Outcome::matched; });
}

bool was_carried(const runs::Run& run) {
  return std::any_of(run.steps.begin(), run.steps.end(), [](const core::StepReport& step) {
    return std::any_of(step.decisions.begin(), step.decisions.end(), core::begins_part);
  });
}

bool was_placed(const runs::Run& run) {
  return std::any_of(run.steps.begin(), run.steps.end(),
                     [](const core::StepReport& step) { return knows_place_after(step, false); });
}

/// A place on an earlier map was sought and never found, or not after the vehicle was carried last.
bool sought_in_vain(const runs::Run& run) {
  bool sought = false;
  bool found = false;
  for (const core::StepReport& step : run.steps) {
    for (const core::Decision& decision : step.decisions) {
      if (std::holds_alternative<core::CarriedDecision>(decision)) found = false;
      const auto* placed = std::get_if<core::PlacedDecision>(&decision);
      sought = sought || placed != nullptr || std::holds_alternative<core::CarriedDecision>(decision);
      found = found || (placed != nullptr && placed->verdict == core::PlacedDecision::Verdict::accepted);
    }
  }
  return sought && !found;
}

/// [begin, end) of the longest stretch of steps without a match.
std::pair<std::size_t, std::size_t> longest_without_match(const std::vector<core::StepReport>& steps) {
  std::size_t begin = 0, longest_begin = 0, longest_end = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (has_match(steps[i])) begin = i + 1;
    if (i + 1 - begin > longest_end - longest_begin) {
      longest_begin = begin;
      longest_end = i + 1;
    }
  }
  return {longest_begin, longest_end};
}

}  // namespace

std::string contradicted_place_text(const runs::Run& run) {
  const auto [times, by_far, away_m] = contradicted_places(run);
  constexpr int least = 3;  // once or twice the pairs of a right place are refused for a bent map
  if (times < least && by_far == 0) return {};
  const bool on_earlier_map = has_earlier_map(run);
  if (on_earlier_map && was_placed(run)) {
    return warning(
        "the landmarks seen fit another place on the map, %.3g m from the estimated pose: the search of the whole map "
        "found it (times: %d), but it was not adopted. The place found before is wrong, or was lost since, and the map "
        "may hold landmarks twice: do not continue in it. 'helixnav join' brings a run without --map together with the "
        "earlier one, by all that both have mapped",
        away_m, times);
  }
  return warning(
      "the landmarks seen fit another place on the map, %.3g m from the estimated pose: the search of the whole map "
      "found it (times: %d), but it was not adopted. %s",
      away_m, times,
      on_earlier_map ? "The start given (--start) is wrong, or the place was lost, and the map may hold landmarks "
                       "twice. 'replay --map RUN --start unknown' finds the start itself"
                     : "The place was lost, and the map may hold landmarks twice: odometry, mounting or delay "
                       "differ from what is assumed. 'helixnav calibrate' estimates them from the log");
}

std::string place_not_found_text(const runs::Run& run) {
  if (!sought_in_vain(run)) return {};
  const char* const what =
      runs::only_localized(run)
          ? "the vehicle never found its place on the earlier map: its poses are not in the frame of that map; "
      : was_carried(run) ? "the vehicle has not found its place since it was carried: the map covers only the last "
                           "part of the drive; "
                         : "the vehicle never found its place on the earlier map: the map covers this session "
                           "only; ";
  return what + best_answer_text(questions_in(run));
}

std::string nothing_mapped_text(const runs::Run& run) {
  const ObservationCounts counts = count_observations(run);
  constexpr double most_waiting = 0.5;
  if (share(counts.waiting, counts.seen) > most_waiting) return waiting_text(counts);
  return has_mature_landmark(run) ? std::string() : no_landmark_text(counts, run);
}

std::vector<std::string> warnings_of(const runs::Run& run, const evaluation::Evaluation& evaluation) {
  std::vector<std::string> warnings;
  if (run.smoothed && run.smoothed->alone) return warnings;  // nothing was matched step by step
  const ObservationCounts counts = count_observations(run);
  constexpr std::size_t enough = 200;
  constexpr double least_matched = 0.15;
  if (const std::string text = nothing_mapped_text(run); !text.empty()) {
    warnings.push_back(text);
  } else if (has_mature_landmark(run) && counts.seen >= enough && share(counts.matched, counts.seen) < least_matched) {
    warnings.push_back(collapse_text(counts, run));
  }
  constexpr double least_nis = 0.5, most_nis = 2.0;
  const double nis = evaluation.nis.mean_per_dof;
  if (evaluation.nis.updates >= 50 && (nis < least_nis || nis > most_nis)) warnings.push_back(nis_text(nis));
  if (evaluation.position && evaluation.position->error_m.count == 0) {
    warnings.push_back(
        warning("none of the %zu true positions is within the time span of the run; do both use the same clock? "
                "'helixnav evaluate' takes --truth-offset-s",
                evaluation.position->fixes_outside));
  }
  for (const std::string& text :
       {runs::only_localized(run) ? std::string() : calibration_text(run), ancestors_text(evaluation), fixes_text(run),
        widened_fixes_text(run), contradicted_place_text(run), wrong_place_text(run), never_placed_text(run),
        numerics_text(numerics_of(run)), postponed_text(postponed_in(run)), open_search_text(run),
        left_twice_text(run)}) {
    if (!text.empty()) warnings.push_back(text);
  }
  for (const std::string& text : systematic_errors_texts(run)) warnings.push_back(text);
  for (const std::string& text : closing_warnings(run)) warnings.push_back(text);
  return warnings;
}

std::vector<std::string> warnings_of_place(const runs::Run& run) {
  std::vector<std::string> warnings;
  if (run.steps.empty() || (run.smoothed && run.smoothed->alone)) return warnings;
  const auto [begin, end] = longest_without_match(run.steps);
  constexpr std::size_t many = 100;
  constexpr double much = 0.1;
  if (end - begin >= many && static_cast<double>(end - begin) > much * static_cast<double>(run.steps.size())) {
    const double from_s = core::seconds(run.steps[begin].t_ns);
    warnings.push_back("no landmark was matched in " + counted(static_cast<double>(end - begin), "scan") +
                       " in a row, from " + short_number(from_s) + " s on: there the pose is odometry alone");
  }
  if (const std::string text = place_not_found_text(run); !text.empty()) warnings.push_back(text);
  if (run.steps.back().mode == core::Mode::searching && open_search_text(run).empty()) {
    warnings.emplace_back("a search was still open at the end: where on the map the vehicle was then is undecided");
  }
  return warnings;
}

}  // namespace helixnav::reports
