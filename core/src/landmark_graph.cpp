// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/landmark_graph.hpp"

#include <map>
#include <string>
#include <utility>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/odometry.hpp"

namespace helixnav::core {
namespace {

/// Walks the events once, opening poses and edges as they come.
class GraphBuilder {
 public:
  GraphBuilder(const std::vector<std::vector<std::int64_t>>& ids, const Pose2& start) : ids_(ids) {
    result_.graph.poses.push_back({0, start});
  }

  void add(const Odometry& odometry) {
    pending_ = moved_ ? chain(pending_, odometry) : odometry;
    moved_ = true;
  }

  void add(const AbsoluteFix& fix) { result_.graph.fix_edges.push_back({pose_here(), fix}); }

  [[noreturn]] void add(const Lost& lost) const {
    throw InputError("the vehicle was carried at t = " + std::to_string(seconds(lost.t_ns)) +
                     " s: no motion ties the poses before to those after, as a graph needs it");
  }

  void add(const Scan& scan) {
    const std::size_t index = result_.pose_of_scan.size();
    const std::size_t labelled = index < ids_.size() ? ids_[index].size() : 0;
    if (labelled != scan.observations.size()) {
      throw PreconditionError("graph_from_events: scan " + std::to_string(index) + " has " +
                              std::to_string(scan.observations.size()) + " observations but " +
                              std::to_string(labelled) + " ids");
    }
    const int pose = pose_here();
    result_.pose_of_scan.push_back(pose);
    for (std::size_t k = 0; k < labelled; ++k) add_observation(pose, scan, k, ids_[index][k]);
  }

  GraphFromEvents finish() {
    if (result_.pose_of_scan.size() != ids_.size()) {
      throw PreconditionError("graph_from_events: ids of " + std::to_string(ids_.size()) + " scans for " +
                              std::to_string(result_.pose_of_scan.size()) + " scans");
    }
    leave_out_unlocated();
    locate_landmarks(result_.graph);
    return std::move(result_);
  }

 private:
  int pose_here() {
    LandmarkGraph& graph = result_.graph;
    if (moved_) {
      const int to = static_cast<int>(graph.poses.size());
      graph.pose_edges.push_back({to - 1, to, pending_.T_before_after, pending_.covariance});
      graph.poses.push_back({to, compose(graph.poses.back().T_world_robot, pending_.T_before_after)});
      moved_ = false;
    }
    return static_cast<int>(graph.poses.size()) - 1;
  }

  void add_observation(int pose, const Scan& scan, std::size_t k, std::int64_t id) {
    if (id < 0) {
      ++result_.unlabelled_observations;
      return;
    }
    const auto [it, is_new] = landmark_of_id_.try_emplace(id, static_cast<int>(result_.graph.landmarks.size()));
    if (is_new) {
      result_.graph.landmarks.push_back({id, Eigen::Vector2d::Zero()});
      rows_.push_back(0);
    }
    rows_[static_cast<std::size_t>(it->second)] += dimension(scan.observations[k].kind);
    result_.graph.landmark_edges.push_back({pose, it->second, scan.T_robot_sensor, scan.observations[k]});
  }

  void leave_out_unlocated() {
    std::vector<LandmarkGraph::Landmark> kept;
    std::vector<int> new_index(rows_.size(), -1);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (rows_[i] < 2) continue;
      new_index[i] = static_cast<int>(kept.size());
      kept.push_back(result_.graph.landmarks[i]);
    }
    result_.unlocated_landmarks = static_cast<int>(rows_.size() - kept.size());
    if (result_.unlocated_landmarks == 0) return;
    result_.graph.landmarks = std::move(kept);
    std::vector<LandmarkGraph::LandmarkEdge> edges;
    for (LandmarkGraph::LandmarkEdge& edge : result_.graph.landmark_edges) {
      edge.landmark = new_index[static_cast<std::size_t>(edge.landmark)];
      if (edge.landmark >= 0) edges.push_back(std::move(edge));
    }
    result_.graph.landmark_edges = std::move(edges);
  }

  const std::vector<std::vector<std::int64_t>>& ids_;
  GraphFromEvents result_;
  std::map<std::int64_t, int> landmark_of_id_;
  std::vector<int> rows_;  ///< of all observations of a landmark
  Odometry pending_;
  bool moved_ = false;
};

}  // namespace

GraphFromEvents graph_from_events(const std::vector<Event>& events, const std::vector<std::vector<std::int64_t>>& ids,
                                  const Pose2& start) {
  GraphBuilder builder(ids, start);
  for (const Event& event : events) {
    std::visit([&builder](const auto& e) { builder.add(e); }, event);
  }
  return builder.finish();
}

}  // namespace helixnav::core
