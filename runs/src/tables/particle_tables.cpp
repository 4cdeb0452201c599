// SPDX-License-Identifier: BSD-3-Clause
#include "particle_tables.hpp"

#include "helixnav/files/append_cells.hpp"
#include "run_tables.hpp"

namespace helixnav::runs {

void append_particles(std::string& text, std::int64_t step, const core::CloudReport& cloud) {
  files::append_number(text, step);
  files::append_counts(text, {static_cast<std::int64_t>(cloud.hypotheses)});
  files::append_cells(text, {cloud.effective_size});
  files::append_counts(text, {cloud.resampled});
  files::append_cells(text, {cloud.log_evidence});
  files::append_counts(text, {static_cast<std::int64_t>(cloud.distinct_ancestors)});
  text += '\n';
}

std::string paths_text(const std::vector<core::PathPoint>& paths) {
  std::string text = std::string(paths_table.header) + '\n';
  std::int64_t index = 0;
  for (const core::PathPoint& point : paths) {
    const core::Pose2& pose = point.T_world_robot;
    files::append_number(text, index++);
    files::append_counts(text, {static_cast<std::int64_t>(point.before), point.step});
    files::append_cells(text, {pose.x_m, pose.y_m, pose.heading_rad, point.share});
    text += '\n';
  }
  return text;
}

std::string mixture_text(const std::vector<core::MixedLandmark>& mixture) {
  std::string text = std::string(mixture_table.header) + '\n';
  for (const core::MixedLandmark& landmark : mixture) {
    const Eigen::Matrix2d& P = landmark.point.covariance_m2;
    files::append_number(text, std::int64_t{landmark.id});
    files::append_cells(text, {landmark.point.mean_m.x(), landmark.point.mean_m.y(), P(0, 0), P(0, 1), P(1, 1),
                               landmark.share, landmark.mature_share});
    text += '\n';
  }
  return text;
}

}  // namespace helixnav::runs
