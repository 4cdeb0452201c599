// SPDX-License-Identifier: BSD-3-Clause
#include "layout.hpp"

namespace helixnav::smoothing {

Layout make_layout(const Problem& problem) {
  Layout layout;
  layout.pose_column.assign(problem.graph.poses.size(), 0);
  for (const int pose : problem.fixed_poses) layout.pose_column[static_cast<std::size_t>(pose)] = -1;
  for (int& column : layout.pose_column) {
    if (column < 0) continue;
    column = layout.columns;
    layout.columns += 3;
  }
  for (std::size_t i = 0; i < problem.graph.landmarks.size(); ++i) {
    layout.landmark_column.push_back(layout.columns);
    layout.columns += 2;
  }
  return layout;
}

std::string name_of_column(const Problem& problem, const Layout& layout, int column) {
  for (std::size_t i = 0; i < layout.pose_column.size(); ++i) {
    const int first = layout.pose_column[i];
    if (first >= 0 && column >= first && column < first + 3) return pose_name(problem, static_cast<int>(i));
  }
  for (std::size_t i = 0; i < layout.landmark_column.size(); ++i) {
    const int first = layout.landmark_column[i];
    if (column >= first && column < first + 2) return landmark_name(problem, static_cast<int>(i));
  }
  return "column " + std::to_string(column);
}

void add_step(const Layout& layout, const Eigen::VectorXd& step, const State& from, State& to) {
  for (std::size_t i = 0; i < from.poses.size(); ++i) {
    const int column = layout.pose_column[i];
    to.poses[i] = column < 0 ? from.poses[i] : core::Pose2(from.poses[i].vector() + step.segment<3>(column));
  }
  for (std::size_t i = 0; i < from.landmarks.size(); ++i) {
    to.landmarks[i] = from.landmarks[i] + step.segment<2>(layout.landmark_column[i]);
  }
}

}  // namespace helixnav::smoothing
