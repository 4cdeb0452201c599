// SPDX-License-Identifier: BSD-3-Clause
#include "report_series.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include "degrees.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/runs/words.hpp"
#include "report_numbers.hpp"
#include "stride_for.hpp"

namespace helixnav::reports {
namespace {

constexpr std::size_t most_path_ellipses = 80;

double sigma(double variance) { return std::sqrt(std::max(variance, 0.0)); }

constexpr Column<core::StepReport> path_columns[] = {
    {"t", [](const core::StepReport& s) { return time_of(s.t_ns); }},
    {"x", [](const core::StepReport& s) { return rounded(s.pose.mean.x_m, 1e-3); }},
    {"y", [](const core::StepReport& s) { return rounded(s.pose.mean.y_m, 1e-3); }}};

constexpr Column<core::Pose2> pose_columns[] = {{"x", [](const core::Pose2& pose) { return rounded(pose.x_m, 1e-3); }},
                                                {"y", [](const core::Pose2& pose) { return rounded(pose.y_m, 1e-3); }}};

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

// A sum of independent χ² is χ² with the summed degrees of freedom: this gives the band of a block's mean.
void append_nis_block(Json& json, double t_s, double nis, int dof) {
  json["t"].push_back(rounded(t_s, 1e-3));
  json["mean"].push_back(rounded(nis / dof));
  json["low"].push_back(rounded(core::chi2_quantile(0.025, dof) / dof));
  json["high"].push_back(rounded(core::chi2_quantile(0.975, dof) / dof));
}

/// Where nothing was updated for long, as in a search: blocks and lines end there.
bool is_gap(const core::StepReport& update, const core::StepReport& next, std::size_t block) {
  constexpr std::size_t least = 20;  // scans
  return static_cast<std::size_t>(next.step - update.step) > std::max(least, 2 * block);
}

void append_nis_gap(Json& json, double t_s) {
  json["t"].push_back(rounded(t_s, 1e-3));
  for (const char* column : {"mean", "low", "high"}) json[column].push_back(nullptr);
}

}  // namespace

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

Json final_path_json(const runs::Run& run) {
  if (run.final_path.empty()) return nullptr;
  return columns(run.final_path, stride_for(run.final_path.size(), most_line_points), pose_columns);
}

Json truth_json(const evaluation::PositionEvaluation& position) {
  const std::vector<evaluation::PositionError> used = errors_with(position, true);
  Json json =
      columns(used, stride_for(used.size(), !position.against_poses ? most_dots : most_line_points), point_columns);
  const Json left_out = columns(errors_with(position, false), 1, point_columns);
  json["left_out_x"] = left_out["x"];
  json["left_out_y"] = left_out["y"];
  json["aligned"] = !position.against_poses;
  return json;
}

Json errors_json(const evaluation::PositionEvaluation& position) {
  const std::vector<evaluation::PositionError> used = errors_with(position, true);
  Json json =
      columns(used, stride_for(used.size(), !position.against_poses ? most_dots : most_line_points), error_columns);
  json["aligned"] = !position.against_poses;
  return json;
}

Json heading_json(const std::vector<evaluation::HeadingError>& errors) {
  return columns(errors, stride_for(errors.size(), most_line_points), heading_columns);
}

Json health_json(const std::vector<core::StepReport>& steps) {
  return columns(steps, stride_for(steps.size(), most_line_points), health_columns);
}

Json nis_json(const std::vector<core::StepReport>& steps) {
  std::vector<const core::StepReport*> updates;
  for (const core::StepReport& step : steps) {
    if (step.joint_dof > 0 && std::isfinite(step.joint_nis)) updates.push_back(&step);
  }
  const std::size_t block = stride_for(updates.size(), most_blocks);
  Json json = {{"t", Json::array()},    {"mean", Json::array()},    {"low", Json::array()},
               {"high", Json::array()}, {"steps_t", Json::array()}, {"steps", Json::array()}};
  for (std::size_t begin = 0, end = 0; begin < updates.size(); begin = end) {
    if (begin > 0 && is_gap(*updates[begin - 1], *updates[begin], block)) {
      append_nis_gap(json, 0.5 * (core::seconds(updates[begin - 1]->t_ns) + core::seconds(updates[begin]->t_ns)));
    }
    for (end = begin + 1; end < std::min(begin + block, updates.size()); ++end) {
      if (is_gap(*updates[end - 1], *updates[end], block)) break;
    }
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

}  // namespace helixnav::reports
