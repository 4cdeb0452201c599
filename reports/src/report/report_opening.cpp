// SPDX-License-Identifier: BSD-3-Clause
#include "report_opening.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <variant>
#include <vector>

#include "helixnav/core/decision_row.hpp"
#include "helixnav/reports/decision_sentence.hpp"
#include "helixnav/reports/run_warnings.hpp"
#include "slip_spans.hpp"
#include "wrong_place_text.hpp"

namespace helixnav::reports {
namespace {

std::string length(double value_m) {
  return value_m < 1000.0 ? short_number(std::round(value_m)) + " m" : short_number(value_m / 1000.0) + " km";
}

std::string duration(double seconds) {
  const double minutes = std::round(seconds / 60.0);
  if (std::floor(seconds / 60.0) < 3.0) return short_number(std::round(seconds)) + " s";
  if (minutes < 120.0) return short_number(minutes) + " min";
  return short_number(std::floor(minutes / 60.0)) + " h " + short_number(std::fmod(minutes, 60.0)) + " min";
}

std::string drive_sentence(const runs::Run& run) {
  double driven_m = 0.0;
  for (std::size_t i = 1; i < run.steps.size(); ++i) {
    driven_m += (run.steps[i].pose.mean.position_m() - run.steps[i - 1].pose.mean.position_m()).norm();
  }
  const auto mature = std::count_if(run.map.begin(), run.map.end(), [](const core::MapLandmark& landmark) {
    return landmark.state == core::LandmarkState::mature;
  });
  const std::string map = ", and a map of " + counted(static_cast<double>(mature), "landmark") + '.';
  if (run.steps.size() == 1) return "A single scan was taken" + map;  // what was driven before it is not recorded
  const double time_s = core::seconds(run.steps.back().t_ns - run.steps.front().t_ns);
  return "The vehicle drove " + length(driven_m) + " in " + duration(time_s) + ": " +
         counted(static_cast<double>(run.steps.size()), "scan") + map;
}

std::string times(int count) {
  if (count <= 2) return count == 1 ? "once" : "twice";
  return std::to_string(count) + " times";
}

std::string closings_sentence(const runs::Run& run) {
  if (run.steps.back().particles) {
    return "It was navigated by a cloud of particles, each of which associates for itself: there are no searches and "
           "no closings to tell of.";
  }
  int accepted = 0, refused = 0, undecided = 0, new_ground = 0;
  for (const core::StepReport& step : run.steps) {
    for (const core::Decision& decision : step.decisions) {
      if (!core::is_closure(decision)) continue;
      const std::string verdict = core::row_of(decision).verdict;
      accepted += verdict == "accepted";
      refused += verdict == "refused";
      undecided += verdict == "undecided";
      new_ground += verdict == "new-ground";
    }
  }
  if (accepted + refused + undecided + new_ground == 0) return "No search for an old place began.";
  std::string text = accepted > 0 ? "The map was closed " + times(accepted) : "The map was never closed";
  text += refused > 0 ? "; a closing was refused " + times(refused) : "; no closing was refused";
  text += new_ground > 0 ? "; a search ended on new ground " + times(new_ground) : "";
  return text + (undecided > 0 ? "; a search was left undecided " + times(undecided) + "." : ".");
}

/// Empty when the vehicle did not slip.
std::string slips_sentence(const runs::Run& run) {
  const std::vector<SlipSpan> slips = slip_spans(run);
  if (slips.empty()) return {};
  const SlipSpan& most = *std::max_element(slips.begin(), slips.end(),
                                           [](const SlipSpan& a, const SlipSpan& b) { return a.moved_m < b.moved_m; });
  return "The vehicle slipped " + times(static_cast<int>(slips.size())) + ", by " + short_number(most.moved_m) + " m" +
         (slips.size() == 1 ? ", " : " at most, ") + when_slipped(run, most) +
         ", and its odometry did not show it: the landmarks did.";
}

/// Empty when nothing that moves was mapped.
std::string movers_sentence(const runs::Run& run) {
  int movers = 0, landmarks = 0;
  for (const core::StepReport& step : run.steps) {
    for (const core::Decision& decision : step.decisions) {
      const auto* moving = std::get_if<core::MovingDecision>(&decision);
      if (moving == nullptr) continue;
      ++movers;
      landmarks += moving->landmarks;
    }
  }
  if (movers == 0) return {};
  return "A moving object had been mapped " + times(movers) + ": " + counted(landmarks, "landmark") +
         (landmarks == 1 ? " was" : " were") + " dropped.";
}

/// How often the vehicle was carried, and whether its place was found again, or that of the session on an earlier map; else empty.
std::string places_sentence(const runs::Run& run) {
  int carried = 0, found_again = 0, wrong = 0;
  bool is_start_wrong = false;
  std::string found;
  for (const core::StepReport& step : run.steps) {
    for (const core::Decision& decision : step.decisions) {
      wrong += is_wrong_place(decision);
      is_start_wrong = is_start_wrong || is_wrong_start(decision);
      carried += is_carried_off(decision);
      const auto* placed = std::get_if<core::PlacedDecision>(&decision);
      if (placed == nullptr || placed->verdict != core::PlacedDecision::Verdict::accepted) continue;
      found_again += carried > 0;
      if (carried == 0) found = "It found its place on the earlier map after " + length(placed->driven_m) + '.';
    }
  }
  if (is_start_wrong) {
    found = "The start given on the earlier map was wrong" + std::string(found.empty() ? "" : ". ") + found;
    if (found.back() != '.') found += ", and the place was not found.";
  }
  if (wrong > 0) found += " A place found before was wrong.";
  if (carried == 0) return found;
  return found + (found.empty() ? "" : " ") + "The vehicle was carried " + times(carried) +
         "; afterwards its place on the map from before was " +
         (found_again == 0         ? "never found."
          : carried == 1           ? "found."
          : found_again >= carried ? "found each time."
                                   : "found " + times(found_again) + '.');
}

std::string figures_of(const evaluation::ErrorStatistics& error) {
  return short_number(error.rmse) + " m RMSE, " + short_number(error.median) + " m median, " + short_number(error.max) +
         " m at most";
}

std::string error_sentence(const evaluation::Evaluation& evaluation) {
  if (!evaluation.position || evaluation.position->error_m.count == 0) {
    return "No truth is known, so the error of the estimate cannot be stated.";
  }
  std::string text = "Position error as estimated on the way: " + figures_of(evaluation.position->error_m);
  if (evaluation.final_position && evaluation.final_position->error_m.count > 0) {
    text += "; of the path as corrected since: " + figures_of(evaluation.final_position->error_m);
  }
  text += '.';
  const evaluation::PositionEvaluation& position = *evaluation.position;
  if (position.steps_moved == 0) return text;
  return text + ' ' + counted(static_cast<double>(position.steps_moved), "scan") +
         (position.steps_moved == 1 ? " was" : " were") + " reported at another place at the time, up to " +
         short_number(position.moved_m) + " m from the one found since, and " +
         (position.steps_moved == 1 ? "is" : "are") + " judged there.";
}

}  // namespace

ErrorAround error_around(const runs::Run& run, std::size_t k, const evaluation::Evaluation& evaluation) {
  ErrorAround around;
  if (!evaluation.position || k == 0) return around;
  constexpr core::Nanoseconds near_ns = 15'000'000'000;
  const auto& errors = evaluation.position->errors;
  const core::Nanoseconds before_ns = run.steps[k - 1].t_ns;
  const core::Nanoseconds after_ns = run.steps[k].t_ns;
  const auto by_time = [](const evaluation::PositionError& e, core::Nanoseconds t_ns) { return e.t_ns < t_ns; };
  for (auto it = std::lower_bound(errors.begin(), errors.end(), before_ns + 1, by_time); it != errors.begin();) {
    --it;
    if (before_ns - it->t_ns > near_ns) break;
    if (!it->used) continue;
    around.before_m = it->error_m.norm();
    break;
  }
  for (auto it = std::lower_bound(errors.begin(), errors.end(), after_ns, by_time); it != errors.end(); ++it) {
    if (it->t_ns - after_ns > near_ns) break;
    if (!it->used) continue;
    around.after_m = it->error_m.norm();
    break;
  }
  return around;
}

Json opening_data(const runs::Run& run, const evaluation::Evaluation& evaluation) {
  Json json = {{"sentences", Json::array()}, {"warnings", Json::array()}};
  if (run.steps.empty()) {
    json["warnings"] = warnings_of(run, evaluation);
    return json;
  }
  if (!(run.smoothed && run.smoothed->alone)) {
    json["sentences"] = {drive_sentence(run), closings_sentence(run)};
    for (const std::string& said : {slips_sentence(run), movers_sentence(run), places_sentence(run)}) {
      if (!said.empty()) json["sentences"].push_back(said);
    }
    for (const std::string& warning : warnings_of(run, evaluation)) json["warnings"].push_back(warning);
    for (const std::string& warning : warnings_of_place(run)) json["warnings"].push_back(warning);
    for (const std::string& remark : run.remarks) json["warnings"].push_back("the log: " + remark);
    for (const std::string& warning : run.warnings) json["warnings"].push_back(warning);
  }
  json["sentences"].push_back(error_sentence(evaluation));
  return json;
}

}  // namespace helixnav::reports
