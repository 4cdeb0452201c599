// SPDX-License-Identifier: BSD-3-Clause
#include "report_particles.hpp"

#include <algorithm>
#include <vector>

#include "report/report_numbers.hpp"
#include "stride_for.hpp"

namespace helixnav::reports {
namespace {

constexpr double least_share =
    0.5;  ///< of a landmark of the mixture that is drawn: most particles do not have the others
constexpr std::size_t most_paths = 200;

/// Blocks of scans: the mean of the effective size, the minimum of the ancestors, which is the alarm.
Json particle_health_json(const std::vector<core::StepReport>& steps) {
  std::vector<const core::StepReport*> scans;
  for (const core::StepReport& step : steps) {
    if (step.particles) scans.push_back(&step);
  }
  Json json = {
      {"t", Json::array()}, {"effective", Json::array()}, {"hypotheses", Json::array()}, {"ancestors", Json::array()}};
  const std::size_t block = stride_for(scans.size(), most_dots);
  for (std::size_t begin = 0; begin < scans.size(); begin += block) {
    const std::size_t end = std::min(begin + block, scans.size());
    double effective = 0.0, hypotheses = 0.0;
    std::size_t ancestors = scans[begin]->particles->distinct_ancestors;
    for (std::size_t i = begin; i < end; ++i) {
      effective += scans[i]->particles->effective_size;
      hypotheses += static_cast<double>(scans[i]->particles->hypotheses);
      ancestors = std::min(ancestors, scans[i]->particles->distinct_ancestors);
    }
    const auto count = static_cast<double>(end - begin);
    json["t"].push_back(time_of(scans[begin]->t_ns));
    json["effective"].push_back(rounded(effective / count, 0.1));
    json["hypotheses"].push_back(rounded(hypotheses / count, 0.1));
    json["ancestors"].push_back(ancestors);
  }
  json["block"] = block;
  return json;
}

/// From the end of each path back to where it joins one already drawn, all in one line with gaps.
Json paths_json(const std::vector<core::PathPoint>& points) {
  std::vector<bool> has_next(points.size(), false), drawn(points.size(), false);
  std::vector<std::ptrdiff_t> ends;
  for (const core::PathPoint& point : points) {
    if (point.before >= 0) has_next[static_cast<std::size_t>(point.before)] = true;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!has_next[i]) ends.push_back(static_cast<std::ptrdiff_t>(i));
  }
  Json x = Json::array(), y = Json::array();
  const std::size_t stride = stride_for(ends.size(), most_paths);
  for (std::size_t k = 0; k < ends.size(); k += stride) {
    for (std::ptrdiff_t at = ends[k]; at >= 0;) {
      const auto i = static_cast<std::size_t>(at);
      x.push_back(rounded(points[i].T_world_robot.x_m, 1e-3));
      y.push_back(rounded(points[i].T_world_robot.y_m, 1e-3));
      at = drawn[i] ? -1 : points[i].before;
      drawn[i] = true;
    }
    x.push_back(nullptr);
    y.push_back(nullptr);
  }
  return {{"x", x}, {"y", y}, {"ends", ends.size()}};
}

Json mixture_json(const std::vector<core::MixedLandmark>& mixture) {
  Json json = Json::array();
  for (const core::MixedLandmark& landmark : mixture) {
    if (landmark.mature_share < least_share) continue;
    const Eigen::Matrix2d& P = landmark.point.covariance_m2;
    json.push_back({{"id", landmark.id},
                    {"x", rounded(landmark.point.mean_m.x())},
                    {"y", rounded(landmark.point.mean_m.y())},
                    {"sxx", rounded(P(0, 0), 1e-8)},
                    {"sxy", rounded(P(0, 1), 1e-8)},
                    {"syy", rounded(P(1, 1), 1e-8)},
                    {"share", rounded(landmark.share, 1e-3)}});
  }
  return json;
}

}  // namespace

Json particles_data(const runs::Run& run) {
  Json json = {{"health", particle_health_json(run.steps)}};
  if (run.particle_end) {
    json["paths"] = paths_json(run.particle_end->paths);
    json["mixture"] = mixture_json(run.particle_end->mixture);
  }
  return json;
}

}  // namespace helixnav::reports
