// SPDX-License-Identifier: BSD-3-Clause
#include "report_smoothing.hpp"

#include <algorithm>
#include <cmath>

#include "stride_for.hpp"

namespace helixnav::reports {
namespace {

constexpr std::size_t most_path_points = 3600;
constexpr std::size_t most_residuals = 4000;

Json to_millimetres(double value) { return std::round(value * 1e3) / 1e3; }

Json path_json(const std::vector<core::Pose2>& poses) {
  Json json = {{"x", Json::array()}, {"y", Json::array()}};
  for (std::size_t i = 0; i < poses.size(); i += stride_for(poses.size(), most_path_points)) {
    json["x"].push_back(to_millimetres(poses[i].x_m));
    json["y"].push_back(to_millimetres(poses[i].y_m));
  }
  return json;
}

Json map_json(const std::vector<core::MapLandmark>& map) {
  Json json = {{"id", Json::array()}, {"x", Json::array()}, {"y", Json::array()}};
  for (const core::MapLandmark& landmark : map) {
    json["id"].push_back(landmark.id);
    json["x"].push_back(to_millimetres(landmark.point.mean_m.x()));
    json["y"].push_back(to_millimetres(landmark.point.mean_m.y()));
  }
  return json;
}

Json residuals_json(const std::vector<runs::SmoothedRun::Normalised>& residuals) {
  Json json = {{"step", Json::array()}, {"value", Json::array()}};
  std::size_t inside = 0;
  for (const runs::SmoothedRun::Normalised& residual : residuals) inside += std::abs(residual.value) <= 2.0 ? 1 : 0;
  for (std::size_t i = 0; i < residuals.size(); i += stride_for(residuals.size(), most_residuals)) {
    json["step"].push_back(residuals[i].step);
    json["value"].push_back(to_millimetres(residuals[i].value));
  }
  json["inside_2sigma"] = residuals.empty() ? 0.0 : static_cast<double>(inside) / static_cast<double>(residuals.size());
  return json;
}

}  // namespace

Json smoothing_data(const runs::SmoothedRun& smoothed) {
  Json largest = Json::array();
  for (const runs::SmoothedRun::LargeResidual& residual : smoothed.largest) {
    largest.push_back(
        {{"step", residual.step}, {"name", residual.name}, {"nis", residual.nis}, {"rows", residual.rows}});
  }
  return {{"alone", smoothed.alone},
          {"path_before", path_json(smoothed.poses_before)},
          {"path", path_json(smoothed.poses)},
          {"before", map_json(smoothed.map_before)},
          {"after", map_json(smoothed.map_after)},
          {"chi2", smoothed.chi2},
          {"chi2_odometry", smoothed.chi2_odometry},
          {"chi2_landmarks", smoothed.chi2_landmarks},
          {"dof", smoothed.dof},
          {"largest", largest},
          {"residuals", residuals_json(smoothed.normalised_residuals)}};
}

}  // namespace helixnav::reports
