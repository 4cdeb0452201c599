// SPDX-License-Identifier: BSD-3-Clause
#include "report_data.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "degrees.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/core/decision_row.hpp"
#include "helixnav/runs/words.hpp"
#include "report_closures.hpp"
#include "stride_for.hpp"

namespace helixnav::reports {

namespace {

constexpr std::size_t most_line_points = 3600;
constexpr std::size_t most_dots = 2400;
constexpr std::size_t most_blocks = 240;
constexpr std::size_t most_path_ellipses = 80;
constexpr std::size_t most_decisions = 1000;

// Digits that no screen shows cost bytes: lengths to 0.1 mm, times to 1 ms.
Json rounded(double value, double unit = 1e-4) {
  if (!std::isfinite(value)) return nullptr;
  return std::round(value / unit) * unit == 0.0 ? 0.0 : std::round(value / unit) / std::round(1.0 / unit);
}

Json time_of(core::Nanoseconds t_ns) { return rounded(core::seconds(t_ns), 1e-3); }

double sigma(double variance) { return std::sqrt(std::max(variance, 0.0)); }

// {"name": [value(item) of every stride-th item], …}
template <typename Item>
struct Column {
  const char* name;
  Json (*value)(const Item&);
};

template <typename Item, std::size_t n>
Json columns(const std::vector<Item>& items, std::size_t stride, const Column<Item> (&wanted)[n]) {
  Json json = Json::object();
  for (const Column<Item>& column : wanted) {
    Json& list = json[column.name] = Json::array();
    for (std::size_t i = 0; i < items.size(); i += stride) list.push_back(column.value(items[i]));
  }
  return json;
}

constexpr Column<core::StepReport> path_columns[] = {
    {"t", [](const core::StepReport& s) { return time_of(s.t_ns); }},
    {"x", [](const core::StepReport& s) { return rounded(s.pose.mean.x_m, 1e-3); }},
    {"y", [](const core::StepReport& s) { return rounded(s.pose.mean.y_m, 1e-3); }}};

constexpr Column<core::StepReport> health_columns[] = {
    {"t", [](const core::StepReport& s) { return time_of(s.t_ns); }},
    {"mapped", [](const core::StepReport& s) -> Json { return s.mapped_landmarks; }},
    {"active", [](const core::StepReport& s) -> Json { return s.active_landmarks; }},
    {"sx", [](const core::StepReport& s) { return rounded(sigma(s.pose.covariance(0, 0))); }},
    {"sy", [](const core::StepReport& s) { return rounded(sigma(s.pose.covariance(1, 1))); }},
    {"sh", [](const core::StepReport& s) { return rounded(in_degrees(sigma(s.pose.covariance(2, 2)))); }}};

constexpr Column<evaluation::PositionError> error_columns[] = {
    {"t", [](const evaluation::PositionError& e) { return time_of(e.t_ns); }},
    {"x", [](const evaluation::PositionError& e) { return rounded(e.error_m.x()); }},
    {"y", [](const evaluation::PositionError& e) { return rounded(e.error_m.y()); }},
    {"sx", [](const evaluation::PositionError& e) { return rounded(e.sigma_m.x()); }},
    {"sy", [](const evaluation::PositionError& e) { return rounded(e.sigma_m.y()); }}};

constexpr Column<evaluation::HeadingError> heading_columns[] = {
    {"t", [](const evaluation::HeadingError& e) { return time_of(e.t_ns); }},
    {"e", [](const evaluation::HeadingError& e) { return rounded(in_degrees(e.error_rad)); }},
    {"s", [](const evaluation::HeadingError& e) { return rounded(in_degrees(e.sigma_rad)); }}};

constexpr Column<evaluation::PositionError> point_columns[] = {
    {"x", [](const evaluation::PositionError& e) { return rounded(e.true_map_m.x(), 1e-3); }},
    {"y", [](const evaluation::PositionError& e) { return rounded(e.true_map_m.y(), 1e-3); }}};

std::vector<evaluation::PositionError> errors_with(const evaluation::PositionEvaluation& position, bool used) {
  std::vector<evaluation::PositionError> chosen;
  std::copy_if(position.errors.begin(), position.errors.end(), std::back_inserter(chosen),
               [used](const evaluation::PositionError& error) { return error.used == used; });
  return chosen;
}

Json path_json(const std::vector<core::StepReport>& steps) {
  Json json = columns(steps, stride_for(steps.size(), most_line_points), path_columns);
  const std::size_t stride = stride_for(steps.size(), most_path_ellipses);
  json["ellipse_stride"] = stride;
  Json& ellipses = json["ellipses"] = Json::array();
  for (std::size_t i = 0; i < steps.size(); i += stride) {
    const core::PoseGaussian& pose = steps[i].pose;
    ellipses.push_back({rounded(pose.mean.x_m), rounded(pose.mean.y_m), rounded(pose.covariance(0, 0), 1e-8),
                        rounded(pose.covariance(0, 1), 1e-8), rounded(pose.covariance(1, 1), 1e-8)});
  }
  return json;
}

Json truth_json(const evaluation::PositionEvaluation& position) {
  const std::vector<evaluation::PositionError> used = errors_with(position, true);
  Json json = columns(used, stride_for(used.size(), position.aligned ? most_dots : most_line_points), point_columns);
  const Json left_out = columns(errors_with(position, false), 1, point_columns);
  json["left_out_x"] = left_out["x"];
  json["left_out_y"] = left_out["y"];
  json["aligned"] = position.aligned;
  return json;
}

Json errors_json(const evaluation::PositionEvaluation& position) {
  const std::vector<evaluation::PositionError> used = errors_with(position, true);
  Json json = columns(used, stride_for(used.size(), position.aligned ? most_dots : most_line_points), error_columns);
  json["aligned"] = position.aligned;
  return json;
}

Json landmarks_json(const std::vector<core::MapLandmark>& map) {
  Json json = Json::array();
  for (const core::MapLandmark& landmark : map) {
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

Json true_landmarks_json(const std::vector<core::TrueLandmark>& landmarks, const core::Pose2& T_truth_map) {
  const core::Pose2 T_map_truth = core::inverse(T_truth_map);
  Json json = Json::array();
  for (const core::TrueLandmark& landmark : landmarks) {
    const Eigen::Vector2d point_m = core::transform(T_map_truth, landmark.point_m);
    json.push_back({landmark.label, rounded(point_m.x(), 1e-3), rounded(point_m.y(), 1e-3)});
  }
  return json;
}

// A sum of independent χ² is χ² with the sum of their degrees of freedom: that gives the band of a block's mean.
void append_nis_block(Json& json, double t_s, double nis, int dof) {
  json["t"].push_back(rounded(t_s, 1e-3));
  json["mean"].push_back(rounded(nis / dof));
  json["low"].push_back(rounded(core::chi2_quantile(0.025, dof) / dof));
  json["high"].push_back(rounded(core::chi2_quantile(0.975, dof) / dof));
}

Json nis_json(const std::vector<core::StepReport>& steps) {
  std::vector<const core::StepReport*> updates;
  for (const core::StepReport& step : steps) {
    if (step.joint_dof > 0 && std::isfinite(step.joint_nis)) updates.push_back(&step);
  }
  Json json = {{"t", Json::array()},    {"mean", Json::array()},    {"low", Json::array()},
               {"high", Json::array()}, {"steps_t", Json::array()}, {"steps", Json::array()}};
  const std::size_t block = stride_for(updates.size(), most_blocks);
  for (std::size_t begin = 0; begin < updates.size(); begin += block) {
    const std::size_t end = std::min(begin + block, updates.size());
    double nis = 0.0;
    int dof = 0;
    for (std::size_t i = begin; i < end; ++i) {
      nis += updates[i]->joint_nis;
      dof += updates[i]->joint_dof;
    }
    append_nis_block(json, core::seconds(updates[(begin + end) / 2]->t_ns), nis, dof);
  }
  json["block"] = block;
  for (std::size_t i = 0; i < updates.size(); i += stride_for(updates.size(), most_dots)) {
    json["steps_t"].push_back(time_of(updates[i]->t_ns));
    json["steps"].push_back(rounded(updates[i]->joint_nis / updates[i]->joint_dof, 1e-3));
  }
  return json;
}

Json observations_json(const std::vector<core::StepReport>& steps) {
  Json json = {{"t", Json::array()}};
  for (const std::string_view word : runs::outcome_words) json[std::string(word)] = Json::array();
  const std::size_t block = stride_for(steps.size(), most_blocks);
  for (std::size_t begin = 0; begin < steps.size(); begin += block) {
    const std::size_t end = std::min(begin + block, steps.size());
    std::array<int, runs::outcome_words.size()> counts{};
    for (std::size_t i = begin; i < end; ++i) {
      for (const core::AssociationReport& a : steps[i].associations) ++counts[static_cast<std::size_t>(a.outcome)];
    }
    json["t"].push_back(time_of(steps[begin].t_ns));
    for (std::size_t i = 0; i < counts.size(); ++i) {
      json[std::string(runs::outcome_words[i])].push_back(rounded(counts[i] / static_cast<double>(end - begin), 1e-3));
    }
  }
  json["block"] = block;
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
          {"numbers", numbers}};
}

// All closures, and of the rest the first most_decisions.
void put_decisions(Json& json, const std::vector<core::StepReport>& steps) {
  Json& list = json["decisions"] = Json::array();
  std::size_t others = 0;
  for (const core::StepReport& step : steps) {
    for (const core::Decision& decision : step.decisions) {
      if (core::is_closure(decision) || others++ < most_decisions) list.push_back(decision_json(step, decision));
    }
  }
  json["decisions_left_out"] = others > most_decisions ? others - most_decisions : 0;
}

// What the map chart shows at first: the path, the truth and the landmarks, and not a fix left out or one seen from
// afar.
Json map_extent(const runs::Run& run, const evaluation::Evaluation& evaluation) {
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array2d high = -low;
  const auto hold = [&](const Eigen::Vector2d& point_m) {
    if (!point_m.allFinite()) return;
    low = low.min(point_m.array());
    high = high.max(point_m.array());
  };
  for (const core::StepReport& step : run.steps) hold(step.pose.mean.position_m());
  for (const core::MapLandmark& landmark : run.map) {
    if (landmark.state == core::LandmarkState::mature) hold(landmark.point.mean_m);
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
  const std::size_t stride = stride_for(steps.size(), most_line_points);
  Json json = Json::object();
  json["manifest"] = Json::parse(runs::manifest_json(run.manifest));  // as it stands in the file
  json["seed"] = std::to_string(run.manifest.seed);                   // JavaScript's numbers end at 2⁵³
  json["finished"] = run.finished;
  json["summary"] = summary_to_json(run, evaluation);
  json["duration_s"] = steps.empty() ? 0.0 : core::seconds(steps.back().t_ns - steps.front().t_ns);
  json["length_m"] = rounded(path_length_m(steps));
  json["time_range_s"] = time_range_s(steps);
  json["map_extent"] = map_extent(run, evaluation);
  json["path"] = path_json(steps);
  json["truth"] = evaluation.position ? truth_json(*evaluation.position) : Json(nullptr);
  json["errors"] = evaluation.position ? errors_json(*evaluation.position) : Json(nullptr);
  json["heading"] = nullptr;
  if (evaluation.pose) {
    const auto& errors = evaluation.pose->errors;
    json["heading"] = columns(errors, stride_for(errors.size(), most_line_points), heading_columns);
  }
  json["landmarks"] = landmarks_json(run.map);
  json["true_landmarks"] =
      true_landmarks_json(run.truth.landmarks, evaluation.position ? evaluation.position->T_truth_map : core::Pose2{});
  json["health"] = columns(steps, stride, health_columns);
  json["nis"] = nis_json(steps);
  json["observations"] = observations_json(steps);
  put_decisions(json, steps);
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
