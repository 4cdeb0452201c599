// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "helixnav/core/errors.hpp"
#include "helixnav/files/file.hpp"
#include "helixnav/files/number_text.hpp"
#include "helixnav/logs/graph_files.hpp"
#include "observation_forms.hpp"

namespace helixnav::logs {
namespace {

using Graph = core::LandmarkGraph;

/// Lines of numbers about a graph.
class GraphText {
 public:
  explicit GraphText(const Graph& graph) : graph_(graph), landmark_shift_(shift(graph)) {
    if (!graph.fix_edges.empty()) throw core::InputError("this graph format cannot hold absolute fixes");
  }

  std::int64_t pose(int index) const { return graph_.poses.at(static_cast<std::size_t>(index)).name; }
  std::int64_t landmark(int index) const {
    return graph_.landmarks.at(static_cast<std::size_t>(index)).name + landmark_shift_;
  }

  void begin(const char* tag) { text += tag; }
  void number(std::int64_t value) {
    text += ' ';
    files::append_number(text, value);
  }
  void number(double value) {
    text += ' ';
    files::append_number(text, value == 0.0 ? 0.0 : value);
  }
  template <class Matrix>
  void upper_triangle(const Matrix& matrix) {
    for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
      for (Eigen::Index c = r; c < matrix.cols(); ++c) number(matrix(r, c));
    }
  }
  void end() { text += '\n'; }

  std::string text;

 private:
  /// 0 when the names of landmarks and poses do not overlap.
  static std::int64_t shift(const Graph& graph) {
    std::set<std::int64_t> names;
    for (const auto& pose : graph.poses) names.insert(pose.name);
    const bool apart = std::none_of(graph.landmarks.begin(), graph.landmarks.end(),
                                    [&names](const auto& landmark) { return names.count(landmark.name) > 0; });
    return apart || names.empty() ? 0 : *names.rbegin() + 1;
  }

  const Graph& graph_;
  std::int64_t landmark_shift_;
};

PointInRobotFrame point_of(const Graph::LandmarkEdge& edge) {
  if (core::dimension(edge.observation.kind) != 2) {
    throw core::InputError("this graph format cannot hold bearings from a lever arm, or ranges, alone");
  }
  return in_robot_frame(edge.observation, edge.T_robot_sensor);
}

bool is_plain_bearing(const Graph::LandmarkEdge& edge) {
  return edge.observation.kind == core::ObservationKind::bearing && edge.T_robot_sensor.position_m().isZero(0.0);
}

void write_vertices(const Graph& graph, GraphText& out) {
  for (std::size_t i = 0; i < graph.poses.size(); ++i) {
    out.begin("VERTEX_SE2");
    out.number(graph.poses[i].name);
    for (const double value : graph.poses[i].T_world_robot.vector()) out.number(value);
    out.end();
  }
  for (std::size_t i = 0; i < graph.landmarks.size(); ++i) {
    out.begin("VERTEX_XY");
    out.number(out.landmark(static_cast<int>(i)));
    for (const double value : graph.landmarks[i].point_m) out.number(value);
    out.end();
  }
  if (!graph.poses.empty()) {
    out.begin("FIX");
    out.number(graph.poses.front().name);
    out.end();
  }
}

void write_landmark_edge(const Graph::LandmarkEdge& edge, GraphText& out) {
  out.begin(is_plain_bearing(edge) ? "EDGE_BEARING_SE2_XY" : "EDGE_SE2_XY");
  out.number(out.pose(edge.pose));
  out.number(out.landmark(edge.landmark));
  if (is_plain_bearing(edge)) {
    out.number(core::wrap_to_pi(edge.observation.z[0] + edge.T_robot_sensor.heading_rad));
    out.number(1.0 / edge.observation.R(0, 0));
  } else {
    const PointInRobotFrame point = point_of(edge);
    for (const double value : point.point_m) out.number(value);
    out.upper_triangle(Eigen::Matrix2d(point.covariance_m2.inverse()));
  }
  out.end();
}

/// Lines as a robot would have written them: motion into a pose before what is seen from it. `form` turns a covariance
/// into the matrix that the format requires.
template <class Form>
std::string chronological_text(const Graph& graph, Form&& form) {
  GraphText out(graph);
  std::vector<std::size_t> pose_edges(graph.pose_edges.size());
  std::vector<std::size_t> landmark_edges(graph.landmark_edges.size());
  std::iota(pose_edges.begin(), pose_edges.end(), std::size_t{0});
  std::iota(landmark_edges.begin(), landmark_edges.end(), std::size_t{0});
  const auto last_pose = [&graph](std::size_t i) { return std::max(graph.pose_edges[i].from, graph.pose_edges[i].to); };
  std::stable_sort(pose_edges.begin(), pose_edges.end(),
                   [&](std::size_t a, std::size_t b) { return last_pose(a) < last_pose(b); });
  std::stable_sort(landmark_edges.begin(), landmark_edges.end(), [&graph](std::size_t a, std::size_t b) {
    return graph.landmark_edges[a].pose < graph.landmark_edges[b].pose;
  });

  auto seen = landmark_edges.cbegin();
  const auto write_seen_before = [&](int pose) {
    for (; seen != landmark_edges.cend() && graph.landmark_edges[*seen].pose < pose; ++seen) {
      const Graph::LandmarkEdge& edge = graph.landmark_edges[*seen];
      const PointInRobotFrame point = point_of(edge);
      out.begin("LANDMARK");
      out.number(out.pose(edge.pose));
      out.number(out.landmark(edge.landmark));
      for (const double value : point.point_m) out.number(value);
      out.upper_triangle(form(Eigen::MatrixXd(point.covariance_m2)));
      out.end();
    }
  };
  for (const std::size_t i : pose_edges) {
    const Graph::PoseEdge& edge = graph.pose_edges[i];
    write_seen_before(static_cast<int>(last_pose(i)));
    out.begin("ODOMETRY");
    out.number(out.pose(edge.from));
    out.number(out.pose(edge.to));
    for (const double value : edge.T_from_to.vector()) out.number(value);
    out.upper_triangle(form(Eigen::MatrixXd(edge.covariance)));
    out.end();
  }
  write_seen_before(static_cast<int>(graph.poses.size()));
  return std::move(out.text);
}

/// Upper triangular U with UᵀU = C⁻¹: the transpose of the Cholesky factor of C⁻¹.
Eigen::MatrixXd square_root_information(const Eigen::MatrixXd& covariance) {
  return Eigen::MatrixXd(covariance.inverse()).llt().matrixU();
}

}  // namespace

void write_g2o(const core::LandmarkGraph& graph, const std::filesystem::path& path) {
  GraphText out(graph);
  write_vertices(graph, out);
  for (const Graph::PoseEdge& edge : graph.pose_edges) {
    out.begin("EDGE_SE2");
    out.number(out.pose(edge.from));
    out.number(out.pose(edge.to));
    for (const double value : edge.T_from_to.vector()) out.number(value);
    out.upper_triangle(Eigen::Matrix3d(edge.covariance.inverse()));
    out.end();
  }
  for (const Graph::LandmarkEdge& edge : graph.landmark_edges) write_landmark_edge(edge, out);
  files::write_whole_file(path.string(), out.text);
}

void write_isam(const core::LandmarkGraph& graph, const std::filesystem::path& path) {
  files::write_whole_file(path.string(), chronological_text(graph, square_root_information));
}

void write_gtsam(const core::LandmarkGraph& graph, const std::filesystem::path& path) {
  files::write_whole_file(path.string(),
                          chronological_text(graph, [](const Eigen::MatrixXd& covariance) { return covariance; }));
}

}  // namespace helixnav::logs
