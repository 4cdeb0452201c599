// SPDX-License-Identifier: BSD-3-Clause
#include "report_data.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "frame_of_map.hpp"
#include "helixnav/core/decision_row.hpp"
#include "helixnav/reports/decision_sentence.hpp"
#include "helixnav/runs/words.hpp"
#include "player/report_particles.hpp"
#include "player/report_player.hpp"
#include "report_closures.hpp"
#include "report_numbers.hpp"
#include "report_opening.hpp"
#include "report_series.hpp"
#include "stride_for.hpp"

namespace helixnav::reports {

namespace {

constexpr std::size_t most_decisions = 1000;
constexpr std::size_t most_map_landmarks = 4000;

/// Every n-th: more would overlap in a chart, and cost it seconds and the page megabytes. The player has all.
Json landmarks_json(const std::vector<core::MapLandmark>& map, std::size_t stride) {
  Json json = Json::array();
  for (std::size_t i = 0; i < map.size(); i += stride) {
    const core::MapLandmark& landmark = map[i];
    const Eigen::Matrix2d& P = landmark.point.covariance_m2;
    json.push_back({{"id", landmark.id},
                    {"x", rounded(landmark.point.mean_m.x())},
                    {"y", rounded(landmark.point.mean_m.y())},
                    {"sxx", rounded(P(0, 0), 1e-8)},
                    {"sxy", rounded(P(0, 1), 1e-8)},
                    {"syy", rounded(P(1, 1), 1e-8)},
                    {"observations", landmark.observations},
                    {"state", runs::word_of(runs::state_words, landmark.state)}});
  }
  return json;
}

Json true_landmarks_json(const runs::Run& run, const evaluation::Evaluation& evaluation) {
  const std::vector<Eigen::Vector2d> points_m = true_landmarks_in_map(run, evaluation);
  Json json = Json::array();
  for (std::size_t i = 0; i < points_m.size(); i += stride_for(points_m.size(), most_map_landmarks)) {
    json.push_back({run.truth.landmarks[i].label, rounded(points_m[i].x(), 1e-3), rounded(points_m[i].y(), 1e-3)});
  }
  return json;
}

Json decision_json(const core::StepReport& step, const core::Decision& decision) {
  const core::DecisionRow row = core::row_of(decision);
  Json numbers = Json::array();
  for (const auto& [name, value] : row.numbers) numbers.push_back({name, Json(value)});
  return {{"step", step.step},
          {"t", time_of(step.t_ns)},
          {"x", rounded(step.pose.mean.x_m)},
          {"y", rounded(step.pose.mean.y_m)},
          {"kind", row.kind},
          {"verdict", row.verdict},
          {"numbers", numbers},
          {"sentence", sentence_of(decision)}};
}

/// With the error before and after it, as far as known.
Json closure_json(const runs::Run& run, std::size_t k, const core::Decision& decision,
                  const evaluation::Evaluation& evaluation) {
  Json json = decision_json(run.steps[k], decision);
  const ErrorAround error = error_around(run, k, evaluation);
  if (error.before_m) json["error_before_m"] = rounded(*error.before_m);
  if (error.after_m) json["error_after_m"] = rounded(*error.after_m);
  return json;
}

/// The vehicle was carried, or found its place on what was mapped before.
bool is_placing(const core::Decision& decision) {
  const auto* placed = std::get_if<core::PlacedDecision>(&decision);
  return std::holds_alternative<core::CarriedDecision>(decision) ||
         (placed != nullptr && placed->verdict == core::PlacedDecision::Verdict::accepted);
}

// All closures and placings, and the first most_decisions of the rest.
void put_decisions(Json& json, const runs::Run& run, const evaluation::Evaluation& evaluation) {
  Json& list = json["decisions"] = Json::array();
  std::size_t others = 0;
  for (std::size_t k = 0; k < run.steps.size(); ++k) {
    for (const core::Decision& decision : run.steps[k].decisions) {
      if (core::is_closure(decision) || is_placing(decision)) {
        list.push_back(closure_json(run, k, decision, evaluation));
      } else if (others++ < most_decisions) {
        list.push_back(decision_json(run.steps[k], decision));
      }
    }
  }
  json["decisions_left_out"] = others > most_decisions ? others - most_decisions : 0;
}

// What the map chart shows at first: the path, the truth and the landmarks, and not a fix left out or one seen from
// afar. Tentative landmarks count if there are no others, as after a single scan.
Json map_extent(const runs::Run& run, const evaluation::Evaluation& evaluation) {
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array2d high = -low;
  const auto hold = [&](const Eigen::Vector2d& point_m) {
    if (!point_m.allFinite()) return;
    low = low.min(point_m.array());
    high = high.max(point_m.array());
  };
  for (const core::StepReport& step : run.steps) hold(step.pose.mean.position_m());
  const auto is_mature = [](const core::MapLandmark& landmark) {
    return landmark.state == core::LandmarkState::mature;
  };
  const bool has_mature = std::any_of(run.map.begin(), run.map.end(), is_mature);
  for (const core::MapLandmark& landmark : run.map) {
    if (!has_mature || is_mature(landmark)) hold(landmark.point.mean_m);
  }
  if (evaluation.position) {
    for (const evaluation::PositionError& error : evaluation.position->errors) {
      if (error.used) hold(error.true_map_m);
    }
  }
  if (!(low <= high).all()) return {-10.0, 10.0, -10.0, 10.0};
  const double margin_m = 1.0 + 0.04 * (high - low).maxCoeff();
  return {rounded(low.x() - margin_m), rounded(high.x() + margin_m), rounded(low.y() - margin_m),
          rounded(high.y() + margin_m)};
}

/// {number: name} for labels that the map gives as words; null if it has only numbers.
Json names_json(const runs::Run& run) {
  Json json;
  for (const auto& [id, name] : run.names) json[std::to_string(id)] = name;
  return json;
}

/// Where the antenna of the fixes is on the vehicle, whose path is drawn; null if they are of one point.
Json antenna_json(const runs::Run& run) {
  const Eigen::Vector2d& antenna_m = run.truth.antenna_robot_m;
  if (run.truth.positions.empty() || antenna_m.isZero(0.0)) return nullptr;
  return {rounded(antenna_m.x(), 1e-3), rounded(antenna_m.y(), 1e-3)};
}

Json time_range_s(const std::vector<core::StepReport>& steps) {
  if (steps.empty()) return {0.0, 1.0};
  const double begin_s = core::seconds(steps.front().t_ns);
  const double end_s = core::seconds(steps.back().t_ns);
  const double margin_s = 0.01 * (end_s - begin_s) + 1e-3;
  return {rounded(begin_s - margin_s, 1e-3), rounded(end_s + margin_s, 1e-3)};
}

double path_length_m(const std::vector<core::StepReport>& steps) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < steps.size(); ++i) {
    length_m += (steps[i].pose.mean.position_m() - steps[i - 1].pose.mean.position_m()).norm();
  }
  return length_m;
}

}  // namespace

Json report_data(const runs::Run& run, const evaluation::Evaluation& evaluation) {
  const std::vector<core::StepReport>& steps = run.steps;
  Json json = Json::object();
  json["manifest"] = Json::parse(runs::manifest_json(run.manifest));  // as in the file
  json["seed"] = std::to_string(run.manifest.seed);                   // JavaScript's numbers end at 2⁵³
  json["finished"] = run.finished;
  json["opening"] = opening_data(run, evaluation);
  json["summary"] = summary_to_json(run, evaluation);
  json["duration_s"] = steps.empty() ? 0.0 : core::seconds(steps.back().t_ns - steps.front().t_ns);
  json["begin_s"] = steps.empty() ? 0.0 : core::seconds(steps.front().t_ns);
  json["length_m"] = rounded(path_length_m(steps));
  json["time_range_s"] = time_range_s(steps);
  json["names"] = names_json(run);
  json["antenna"] = antenna_json(run);
  json["frame"] = frame_of_map(run);
  json["map_extent"] = map_extent(run, evaluation);
  json["path"] = path_json(steps);
  json["final_path"] = final_path_json(run);
  json["truth"] = evaluation.position ? truth_json(*evaluation.position) : Json(nullptr);
  json["errors"] = evaluation.position ? errors_json(*evaluation.position) : Json(nullptr);
  json["heading"] = evaluation.pose ? heading_json(evaluation.pose->errors) : Json(nullptr);
  json["landmarks_stride"] = stride_for(run.map.size(), most_map_landmarks);
  json["landmarks"] = landmarks_json(run.map, json["landmarks_stride"]);
  json["true_landmarks"] = true_landmarks_json(run, evaluation);
  json["health"] = health_json(steps);
  json["nis"] = nis_json(steps);
  json["observations"] = observations_json(steps);
  json["particles"] = evaluation.particles ? particles_data(run) : Json(nullptr);
  put_decisions(json, run, evaluation);
  json["closures"] = closures_data(run);
  return json;
}

Json report_wall_clock(const runs::Run& run) {
  const std::size_t count = run.microseconds.size();
  const std::size_t block = count <= most_dots ? 1 : stride_for(count, most_dots / 2);
  Json blocks = {{"block", block}, {"t", Json::array()}, {"max_us", Json::array()}, {"median_us", Json::array()}};
  for (std::size_t begin = 0; begin < count; begin += block) {
    const auto first = run.microseconds.begin() + static_cast<std::ptrdiff_t>(begin);
    std::vector<double> of_block(first, first + static_cast<std::ptrdiff_t>(std::min(block, count - begin)));
    std::sort(of_block.begin(), of_block.end());
    blocks["t"].push_back(time_of(run.steps[begin].t_ns));
    blocks["max_us"].push_back(rounded(of_block.back(), 0.1));
    blocks["median_us"].push_back(rounded(evaluation::quantile_of_sorted(of_block, 0.5), 0.1));
  }
  return {{"timing", timing_to_json(run)}, {"steps", blocks}};
}

}  // namespace helixnav::reports
