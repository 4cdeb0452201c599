// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <string>
#include <unordered_map>
#include <utility>

#include <Eigen/LU>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/logs/graph_files.hpp"
#include "input_files.hpp"
#include "plausible.hpp"
#include "text_cursor.hpp"

namespace helixnav::logs {
namespace {

/// Edges may name vertices that come later: lines are read twice, vertices first.
class G2oReader {
 public:
  G2oReader(std::string_view text, std::string file_name) : text_(text), file_name_(std::move(file_name)) {}

  core::LandmarkGraph read() {
    for_each_line(&G2oReader::read_vertex);
    for_each_line(&G2oReader::read_edge);
    return std::move(graph_);
  }

 private:
  void for_each_line(void (G2oReader::*action)(TextCursor&, std::string_view)) {
    TextCursor cursor(text_, file_name_);
    while (!cursor.at_end()) {
      const std::string_view tag = cursor.word();
      if (tag.front() == '#' || tag == "FIX") {
        cursor.skip_line();
      } else {
        (this->*action)(cursor, tag);
      }
    }
  }

  void read_vertex(TextCursor& cursor, std::string_view tag) {
    if (tag == "VERTEX_SE2") {
      const std::int64_t name = new_name(cursor, pose_of_name_, graph_.poses.size());
      const double x_m = cursor.number_between(-most_coordinate_m, most_coordinate_m, "x [m]");
      const double y_m = cursor.number_between(-most_coordinate_m, most_coordinate_m, "y [m]");
      graph_.poses.push_back({name, core::Pose2(x_m, y_m, heading(cursor))});
      cursor.end_line("VERTEX_SE2 has (4 after the tag)");
    } else if (tag == "VERTEX_XY") {
      const std::int64_t name = new_name(cursor, landmark_of_name_, graph_.landmarks.size());
      const double x_m = cursor.number_between(-most_coordinate_m, most_coordinate_m, "x [m]");
      const double y_m = cursor.number_between(-most_coordinate_m, most_coordinate_m, "y [m]");
      graph_.landmarks.push_back({name, {x_m, y_m}});
      cursor.end_line("VERTEX_XY has (3 after the tag)");
    } else {
      cursor.skip_line();
    }
  }

  void read_edge(TextCursor& cursor, std::string_view tag) {
    if (tag == "EDGE_SE2") {
      read_pose_edge(cursor);
    } else if (tag == "EDGE_SE2_XY") {
      read_point_edge(cursor);
    } else if (tag == "EDGE_BEARING_SE2_XY") {
      read_bearing_edge(cursor);
    } else if (tag == "VERTEX_SE2" || tag == "VERTEX_XY") {
      cursor.skip_line();
    } else {
      cursor.fail("unknown tag '" + std::string(tag.substr(0, 24)) +
                  "'; expected VERTEX_SE2, VERTEX_XY, EDGE_SE2, EDGE_SE2_XY, EDGE_BEARING_SE2_XY or FIX");
    }
  }

  static double heading(TextCursor& cursor) {
    return cursor.number_between(-most_turn_rad, most_turn_rad, "heading [rad]");
  }

  using IndexOfName = std::unordered_map<std::int64_t, int>;

  std::int64_t new_name(TextCursor& cursor, IndexOfName& names, std::size_t index) {
    const std::int64_t name = read_name(cursor, "a vertex number");
    if (pose_of_name_.count(name) + landmark_of_name_.count(name) > 0) {
      cursor.fail("vertex " + std::to_string(name) + " is given twice");
    }
    names[name] = static_cast<int>(index);
    return name;
  }

  int known(TextCursor& cursor, const IndexOfName& names, const std::string& tag) {
    const std::int64_t name = cursor.integer("the number of a " + tag);
    const auto found = names.find(name);
    if (found == names.end()) cursor.fail("there is no " + tag + " " + std::to_string(name));
    return found->second;
  }

  template <int N>
  Eigen::Matrix<double, N, N> covariance(TextCursor& cursor) {
    Eigen::Matrix<double, N, N> information;
    for (int r = 0; r < N; ++r) {
      for (int c = r; c < N; ++c)
        information(r, c) = information(c, r) = cursor.number("an element of the information");
    }
    if (!core::is_symmetric_positive_definite(information))
      cursor.fail("the information matrix is not positive definite");
    const Eigen::Matrix<double, N, N> inverse = information.inverse();
    const Eigen::Matrix<double, N, N> C = 0.5 * (inverse + inverse.transpose());
    if (const auto fault = fault_of_covariance(C)) cursor.fail("the inverse of the information matrix " + *fault);
    return C;
  }

  void read_pose_edge(TextCursor& cursor) {
    core::LandmarkGraph::PoseEdge edge;
    edge.from = known(cursor, pose_of_name_, "VERTEX_SE2");
    edge.to = known(cursor, pose_of_name_, "VERTEX_SE2");
    const double x_m = cursor.number_between(-most_motion_m, most_motion_m, "x [m]");
    const double y_m = cursor.number_between(-most_motion_m, most_motion_m, "y [m]");
    edge.T_from_to = core::Pose2(x_m, y_m, heading(cursor));
    edge.covariance = covariance<3>(cursor);
    cursor.end_line("EDGE_SE2 has (11 after the tag)");
    graph_.pose_edges.push_back(edge);
  }

  void read_point_edge(TextCursor& cursor) {
    core::LandmarkGraph::LandmarkEdge edge;
    edge.pose = known(cursor, pose_of_name_, "VERTEX_SE2");
    edge.landmark = known(cursor, landmark_of_name_, "VERTEX_XY");
    check_count(cursor, seen_from_[edge.pose]++);
    const double x_m = cursor.number_between(-most_distance_m, most_distance_m, "x [m]");
    const double y_m = cursor.number_between(-most_distance_m, most_distance_m, "y [m]");
    edge.observation = core::make_cartesian({x_m, y_m}, covariance<2>(cursor));
    cursor.end_line("EDGE_SE2_XY has (7 after the tag)");
    graph_.landmark_edges.push_back(edge);
  }

  void read_bearing_edge(TextCursor& cursor) {
    core::LandmarkGraph::LandmarkEdge edge;
    edge.pose = known(cursor, pose_of_name_, "VERTEX_SE2");
    edge.landmark = known(cursor, landmark_of_name_, "VERTEX_XY");
    check_count(cursor, seen_from_[edge.pose]++);
    const double bearing_rad = cursor.number_between(-2.0 * core::pi, 2.0 * core::pi, "a bearing [rad]");
    edge.observation = core::make_bearing(bearing_rad, std::sqrt(covariance<1>(cursor)(0, 0)));
    cursor.end_line("EDGE_BEARING_SE2_XY has (4 after the tag)");
    graph_.landmark_edges.push_back(edge);
  }

  std::string_view text_;
  std::string file_name_;
  core::LandmarkGraph graph_;
  IndexOfName pose_of_name_;
  IndexOfName landmark_of_name_;
  std::unordered_map<int, std::size_t> seen_from_;  ///< landmarks, by the index of the pose
};

}  // namespace

core::LandmarkGraph read_g2o(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  return G2oReader(text, path.string()).read();
}

}  // namespace helixnav::logs
