// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdio>

#include "degrees.hpp"
#include "helixnav/reports/summary.hpp"
#include "json.hpp"

namespace helixnav::reports {

namespace {

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  const int length = std::snprintf(nullptr, 0, pattern, values...);
  std::string text(static_cast<std::size_t>(length) + 1, '\0');
  std::snprintf(text.data(), text.size(), pattern, values...);
  text.pop_back();
  return text;
}

/// One in ten or more: the limit, not their errors, determines what remains.
bool too_many_left_out(const evaluation::PositionEvaluation& position) {
  return 10 * position.fixes_left_out > position.fixes_used + position.fixes_left_out;
}

/// Nearly all of the error is in position and heading: the truth may be in another frame, or the run be elsewhere.
bool is_displaced(const evaluation::PositionEvaluation& position) {
  constexpr double least_m = 1.0;
  constexpr double times = 10.0;
  return position.against_poses && !position.aligned && position.error_m.rmse > least_m &&
         position.error_m.rmse > times * position.rmse_aligned_m;
}

std::string against_text(const evaluation::PositionEvaluation& position) {
  if (!position.against_poses) return "  against            position fixes, after rigid alignment\n";
  if (position.aligned) {
    return "  against            true poses, after rigid alignment: where the map lies in their frame is not known\n";
  }
  if (position.off_earlier_map) {
    return "  against            true poses, since the session began: its place on the earlier map was not found\n";
  }
  std::string text = "  against            true poses, in the map frame as it is\n";
  if (!is_displaced(position)) return text;
  return text + format(
                    "  after alignment    RMSE %.3f m: map and truth lie apart; is the truth given in the frame of the "
                    "earlier map's, or of the start?\n",
                    position.rmse_aligned_m);
}

std::string position_text(const evaluation::PositionEvaluation& position) {
  const evaluation::ErrorStatistics& e = position.error_m;
  if (e.count == 0 && position.fixes_in_gaps > 0) {
    return format(
        "position error       unknown: %zu positions of truth lie in gaps, between scans farther apart than %.3g s\n",
        position.fixes_in_gaps, position.gap_s);
  }
  if (e.count == 0) {
    return format("position error       unknown: none of %zu positions of truth lies within the time of the run\n",
                  position.fixes_outside + position.fixes_left_out);
  }
  std::string text = format("position error       RMSE %.3f m, median %.3f m, 95 %% %.3f m, maximum %.3f m\n", e.rmse,
                            e.median, e.p95, e.max);
  text += against_text(position);
  text += format("  fixes used         %zu\n", position.fixes_used);
  if (position.aligned && !position.against_poses) {
    text += format("  fixes left out     %zu (farther than %g m)%s\n", position.fixes_left_out, position.limit_m,
                   too_many_left_out(position) ? ": too many to be outliers, so that the errors above are too small; "
                                                 "helixnav evaluate RUN --fix-limit-m takes more"
                                               : "");
  }
  if (position.aligned) {
    text += format("  alignment          x %.3f m, y %.3f m, heading %.3f deg (map in the frame of the %s)\n",
                   position.T_truth_map.x_m, position.T_truth_map.y_m, in_degrees(position.T_truth_map.heading_rad),
                   position.against_poses ? "true poses" : "fixes");
  }
  if (position.steps_moved > 0) {
    text +=
        format("  judged elsewhere   %zu scans, reported up to %.3g m from where they are known to have been since\n",
               position.steps_moved, position.moved_m);
  }
  if (position.fixes_outside > 0) text += format("  outside the run    %zu\n", position.fixes_outside);
  if (position.fixes_in_gaps > 0) {
    text += format("  in gaps            %zu, left out: between scans farther apart than %.3g s\n",
                   position.fixes_in_gaps, position.gap_s);
  }
  return text;
}

std::string final_position_text(const evaluation::PositionEvaluation& position) {
  const evaluation::ErrorStatistics& e = position.error_m;
  if (e.count == 0) return {};
  return format(
      "of the final path    RMSE %.3f m, median %.3f m, 95 %% %.3f m, maximum %.3f m (trajectory_final.tum)\n", e.rmse,
      e.median, e.p95, e.max);
}

std::string pose_text(const evaluation::PoseEvaluation& pose) {
  const evaluation::ErrorStatistics& e = pose.heading_error_rad;
  if (e.count == 0) return {};
  std::string text = format("heading error        RMSE %.3f deg, median %.3f deg, 95 %% %.3f deg, maximum %.3f deg\n",
                            in_degrees(e.rmse), in_degrees(e.median), in_degrees(e.p95), in_degrees(e.max));
  if (pose.nees_count > 0) {
    text += format("NEES                 mean %.3f (3 when consistent), %.1f %% inside the 95 %% band, %zu instants\n",
                   pose.nees_mean, 100.0 * pose.nees_inside_95, pose.nees_count);
    if (pose.is_on_given_map) {
      text += "  on the given map   the covariance leaves out the errors of that map, which count here\n";
    }
  }
  if (pose.nees_in_own_frame > 0) {
    text += format("  before placed      %zu instants, by the truth since the session or part began\n",
                   pose.nees_in_own_frame);
  }
  if (pose.nees_left_out > 0) {
    text += format("  left out           %zu instants, reported in a frame that the truth does not know\n",
                   pose.nees_left_out);
  }
  return text;
}

std::string map_text(const evaluation::MapEvaluation& map) {
  const evaluation::ErrorStatistics& e = map.error_m;
  std::string text = e.count == 0
                         ? "landmark error       unknown: no mature landmark has a true one beside it\n"
                         : format("landmark error       RMSE %.3f m, median %.3f m, 95 %% %.3f m, maximum %.3f m\n",
                                  e.rmse, e.median, e.p95, e.max);
  text += format("  pairs              %zu ", e.count);
  text += map.by_label ? std::string("(by label)\n")
                       : format("(nearest first, within %g m, or 4 standard deviations)\n", map.limit_m);
  text += format("  missing            %zu\n  duplicates         %zu\n  spurious           %zu\n", map.missing,
                 map.duplicates, map.spurious);
  return text;
}

std::string particles_text(const evaluation::ParticleEvaluation& particles) {
  return format("particles            effective size %.1f %% in the mean, %zu resamplings in %zu scans\n",
                100.0 * particles.mean_effective_share, particles.resamplings, particles.scans) +
         format(
             "  ancestors          %.1f in the mean, %zu at least: particles a loop ago that all of today descend "
             "from\n",
             particles.mean_ancestors, particles.least_ancestors);
}

Json particles_to_json(const evaluation::ParticleEvaluation& particles) {
  return {{"scans", particles.scans},
          {"effective_share", particles.mean_effective_share},
          {"resamplings", particles.resamplings},
          {"ancestors_mean", particles.mean_ancestors},
          {"ancestors_least", particles.least_ancestors}};
}

Json statistics_to_json(const evaluation::ErrorStatistics& statistics, const std::string& unit) {
  return {{"rmse_" + unit, statistics.rmse},
          {"median_" + unit, statistics.median},
          {"p95_" + unit, statistics.p95},
          {"max_" + unit, statistics.max}};
}

Json position_to_json(const evaluation::PositionEvaluation& position) {
  Json json = statistics_to_json(position.error_m, "m");
  json["fixes_used"] = position.fixes_used;
  json["fixes_left_out"] = position.fixes_left_out;
  json["fixes_outside"] = position.fixes_outside;
  json["fixes_in_gaps"] = position.fixes_in_gaps;
  json["gap_s"] = position.gap_s;
  json["against"] = position.against_poses ? "poses" : "positions";
  json["aligned"] = position.aligned;
  if (position.against_poses) json["rmse_aligned_m"] = position.rmse_aligned_m;
  if (position.off_earlier_map) json["off_earlier_map"] = true;
  if (position.steps_moved > 0) json["moved"] = {{"scans", position.steps_moved}, {"most_m", position.moved_m}};
  if (!position.against_poses) json["limit_m"] = position.limit_m;
  if (position.aligned) {
    json["alignment"] = {{"x_m", position.T_truth_map.x_m},
                         {"y_m", position.T_truth_map.y_m},
                         {"heading_rad", position.T_truth_map.heading_rad}};
  }
  return json;
}

Json map_to_json(const evaluation::MapEvaluation& map) {
  Json json = statistics_to_json(map.error_m, "m");
  json["pairs"] = map.error_m.count;
  json["by"] = map.by_label ? "label" : "distance";
  if (!map.by_label) json["limit_m"] = map.limit_m;
  json["missing"] = map.missing;
  json["duplicates"] = map.duplicates;
  json["spurious"] = map.spurious;
  return json;
}

}  // namespace

std::string evaluation_text(const evaluation::Evaluation& evaluation) {
  std::string text = format("steps                %zu\n", evaluation.steps);
  if (evaluation.position) text += position_text(*evaluation.position);
  if (evaluation.final_position) text += final_position_text(*evaluation.final_position);
  if (evaluation.pose) text += pose_text(*evaluation.pose);
  if (evaluation.map) text += map_text(*evaluation.map);
  if (!evaluation.position && !evaluation.map) text += "no truth             nothing to compare the run with\n";
  if (evaluation.nis.updates > 0) {
    text += format("NIS                  mean %.3f per degree of freedom (95 %% band %.3f to %.3f)\n",
                   evaluation.nis.mean_per_dof, evaluation.nis.mean_low_95, evaluation.nis.mean_high_95);
    text += format("  single updates     %.1f %% inside their 95 %% bands, %zu updates\n",
                   100.0 * evaluation.nis.inside_95, evaluation.nis.updates);
  }
  if (evaluation.revisits.revisits > 0) {
    text += format("NIS of revisits      mean %.3f per degree of freedom, %zu landmarks unseen for %d steps\n",
                   evaluation.revisits.mean_nis_per_dof, evaluation.revisits.revisits,
                   static_cast<int>(evaluation::RevisitEvaluation::unseen_steps));
  }
  if (evaluation.particles) text += particles_text(*evaluation.particles);
  return text;
}

Json evaluation_to_json(const evaluation::Evaluation& evaluation) {
  Json json = Json::object();
  json["steps"] = evaluation.steps;
  if (evaluation.position) json["error"] = position_to_json(*evaluation.position);
  if (evaluation.final_position) json["error_final"] = position_to_json(*evaluation.final_position);
  if (evaluation.pose) {
    json["heading_error"] = statistics_to_json(evaluation.pose->heading_error_rad, "rad");
    json["nees"] = {{"count", evaluation.pose->nees_count},
                    {"mean", evaluation.pose->nees_mean},
                    {"inside_95", evaluation.pose->nees_inside_95}};
    if (evaluation.pose->nees_in_own_frame > 0) json["nees"]["own_frame"] = evaluation.pose->nees_in_own_frame;
    if (evaluation.pose->nees_left_out > 0) json["nees"]["left_out"] = evaluation.pose->nees_left_out;
  }
  if (evaluation.map) json["landmark_error"] = map_to_json(*evaluation.map);
  json["nis"] = {{"updates", evaluation.nis.updates},
                 {"mean_per_dof", evaluation.nis.mean_per_dof},
                 {"mean_low_95", evaluation.nis.mean_low_95},
                 {"mean_high_95", evaluation.nis.mean_high_95},
                 {"inside_95", evaluation.nis.inside_95}};
  json["revisits"] = {{"count", evaluation.revisits.revisits},
                      {"mean_nis_per_dof", evaluation.revisits.mean_nis_per_dof}};
  if (evaluation.particles) json["particles"] = particles_to_json(*evaluation.particles);
  return json;
}

std::string evaluation_json(const evaluation::Evaluation& evaluation) {
  return json_text(evaluation_to_json(evaluation));
}

}  // namespace helixnav::reports
