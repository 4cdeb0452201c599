// SPDX-License-Identifier: BSD-3-Clause
#include "smoothing/drive_graph.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/observation.hpp"
#include "helixnav/core/odometry.hpp"
#include "helixnav/core/pose_on_map.hpp"

namespace helixnav::supervisor {
namespace {

using core::LandmarkGraph;

/// The stops of the drive with its landmarks by their present ids.
std::vector<Stop> present_stops(const Tape& tape) {
  std::vector<Stop> stops = stops_of(tape);
  const core::MergedIds ids = merged_ids(tape);
  for (Stop& stop : stops) {
    for (cekf::Match& match : stop.seen) match.landmark = ids.now(match.landmark);
  }
  return stops;
}

/// How often each landmark was observed that is worth a place in the graph: one lost again after a single look says nothing.
std::map<core::LandmarkId, int> sightings(const std::vector<Stop>& stops, const cekf::CompressedEkf& filter) {
  std::map<core::LandmarkId, int> count;
  for (const Stop& stop : stops) {
    for (const cekf::Match& match : stop.seen) ++count[match.landmark];
  }
  for (auto one = count.begin(); one != count.end();) {
    one = one->second > 1 || filter.contains(one->first) ? std::next(one) : count.erase(one);
  }
  return count;
}

class Builder {
 public:
  Builder(const core::PoseGaussian& start, const Tape& tape, const cekf::CompressedEkf& filter,
          const std::set<core::LandmarkId>& displaced)
      : stops_(present_stops(tape)),
        last_motion_(motion_after_stops(tape)),
        filter_(filter),
        displaced_(displaced),
        sightings_(sightings(stops_, filter)),
        vehicle_(start) {
    open_pose();
  }

  DriveGraph build() {
    for (const Stop& stop : stops_) {
      drive(stop.motion);
      const std::vector<cekf::Match> seen = worthwhile(stop);
      const bool observed = stop.fix || !seen.empty();
      if (observed && motion_) reach_pose();
      if (observed) observe(stop, seen);
      places_.push_back({stop.t_ns, last_pose(), motion_ ? motion_->T_before_after : core::Pose2{}});
    }
    drive(last_motion_);
    if (motion_) reach_pose();  // where the vehicle is now, even if nothing is seen from there
    return {std::move(graph_), std::move(places_)};
  }

 private:
  int last_pose() const { return static_cast<int>(graph_.poses.size()) - 1; }

  void open_pose() {
    const auto name = static_cast<std::int64_t>(graph_.poses.size());
    graph_.poses.push_back({name, vehicle_.mean()});
  }

  void drive(const std::optional<core::Odometry>& motion) {
    if (!motion) return;
    vehicle_.move(*motion);
    motion_ = motion_ ? core::chain(*motion_, *motion) : *motion;
  }

  void reach_pose() {
    open_pose();
    graph_.pose_edges.push_back({last_pose() - 1, last_pose(), motion_->T_before_after, motion_->covariance});
    motion_.reset();
  }

  std::vector<cekf::Match> worthwhile(const Stop& stop) const {
    std::vector<cekf::Match> seen;
    for (const cekf::Match& match : stop.seen) {
      if (sightings_.count(match.landmark) > 0) seen.push_back(match);
    }
    return seen;
  }

  /// Landmarks whose places are known say where the vehicle is, and it says where the others are.
  void observe(const Stop& stop, const std::vector<cekf::Match>& seen) {
    for (const cekf::Match& match : seen) {
      if (const auto point_m = place_of(match.landmark))
        vehicle_.see(match.observation, match.T_robot_sensor, *point_m);
    }
    for (const cekf::Match& match : seen) {
      graph_.landmark_edges.push_back({last_pose(), index_of(match), match.T_robot_sensor, match.observation});
    }
    if (stop.fix) graph_.fix_edges.push_back({last_pose(), *stop.fix});
    graph_.poses.back().T_world_robot = vehicle_.mean();
  }

  std::optional<Eigen::Vector2d> place_of(core::LandmarkId id) const {
    const auto found = index_of_landmark_.find(id);
    if (found != index_of_landmark_.end()) return graph_.landmarks[static_cast<std::size_t>(found->second)].point_m;
    if (filter_.contains(id) && displaced_.count(id) == 0) return filter_.landmark_mean(id);
    return std::nullopt;
  }

  int index_of(const cekf::Match& match) {
    const auto next = static_cast<int>(graph_.landmarks.size());
    const std::optional<Eigen::Vector2d> known_m = place_of(match.landmark);
    const auto [found, is_new] = index_of_landmark_.emplace(match.landmark, next);
    if (!is_new) return found->second;
    const core::Pose2 here = vehicle_.mean();
    graph_.landmarks.push_back(
        {match.landmark,
         known_m ? *known_m : core::locate_landmark(match.observation, here, match.T_robot_sensor).point_world_m});
    return next;
  }

  std::vector<Stop> stops_;
  std::optional<core::Odometry> last_motion_;
  const cekf::CompressedEkf& filter_;
  const std::set<core::LandmarkId>& displaced_;
  std::map<core::LandmarkId, int> sightings_;
  core::PoseOnMap vehicle_;
  std::optional<core::Odometry> motion_;  ///< since the last pose
  LandmarkGraph graph_;
  std::map<core::LandmarkId, int> index_of_landmark_;
  std::vector<StopInGraph> places_;
};

}  // namespace

DriveGraph graph_of(const core::PoseGaussian& start, const Tape& tape, const cekf::CompressedEkf& filter,
                    const std::set<core::LandmarkId>& displaced) {
  return Builder(start, tape, filter, displaced).build();
}

std::vector<core::StampedPose> path_of(const LandmarkGraph& graph, const std::vector<StopInGraph>& stops) {
  std::vector<core::StampedPose> path;
  path.reserve(stops.size());
  for (const StopInGraph& stop : stops) {
    const core::Pose2& T_world_pose = graph.poses[static_cast<std::size_t>(stop.pose)].T_world_robot;
    path.push_back({stop.t_ns, core::compose(T_world_pose, stop.T_pose_robot)});
  }
  return path;
}

}  // namespace helixnav::supervisor
