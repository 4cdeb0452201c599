// SPDX-License-Identifier: BSD-3-Clause
#include "smoothing/smooth_drive.hpp"

#include <utility>
#include <vector>

#include "helixnav/core/chi2.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/observation.hpp"
#include "helixnav/smoothing/optimize.hpp"
#include "smoothing/drive_graph.hpp"

namespace helixnav::supervisor {
namespace {

/// x, y, heading [m, m, rad]. Odometry of rank two, a certain start and an exact fix have no inverse; so much is added to them, a
/// few ten-thousandths of what the simulated truck drifts.
const Eigen::Vector3d softening(2e-5, 2e-5, 2e-6);

smoothing::Problem problem_of(const core::PoseGaussian& start, core::LandmarkGraph graph) {
  smoothing::Problem problem;
  problem.graph = std::move(graph);
  const Eigen::Matrix3d certain = softening.cwiseAbs2().asDiagonal();
  problem.pose_priors.push_back({0, start.mean, start.covariance + certain});
  smoothing::soften_odometry(problem, softening);
  for (auto& edge : problem.graph.fix_edges) edge.fix.covariance_m2 += certain.topLeftCorner<2, 2>();
  return problem;
}

/// Drives through the solved graph with measurements that are just what it predicts: the mean stays on it, and the
/// covariance comes to be that of all measurements linearised there.
class Refilter {
 public:
  Refilter(const core::PoseGaussian& start, const core::LandmarkGraph& graph, const cekf::CompressedEkf& before)
      : graph_(graph),
        before_(before),
        left_(graph.landmarks.size(), 0),
        filter_({graph.poses.front().T_world_robot, start.covariance}, before.options()) {
    for (const auto& edge : graph_.landmark_edges) ++left_[static_cast<std::size_t>(edge.landmark)];
  }

  cekf::CompressedEkf run() {
    std::size_t edge = 0;
    std::size_t fix = 0;
    for (int pose = 0; pose < static_cast<int>(graph_.poses.size()); ++pose) {
      reach(pose);
      std::vector<cekf::Match> known;
      for (; edge < graph_.landmark_edges.size() && graph_.landmark_edges[edge].pose == pose; ++edge) {
        see(graph_.landmark_edges[edge], known);
      }
      filter_.update(known);
      for (; fix < graph_.fix_edges.size() && graph_.fix_edges[fix].pose == pose; ++fix) {
        core::AbsoluteFix exact = graph_.fix_edges[fix].fix;
        exact.position_world_m = core::transform(at(pose), exact.antenna_robot_m);
        filter_.update_position(exact);
      }
      forget_lost();
      filter_.switch_region_if_due();
    }
    filter_.name_from(before_.next_name());
    return std::move(filter_);
  }

 private:
  const core::Pose2& at(int pose) const { return graph_.poses[static_cast<std::size_t>(pose)].T_world_robot; }

  void reach(int pose) {
    if (pose == 0) return;
    core::Odometry exact;
    exact.T_before_after = core::between(at(pose - 1), at(pose));
    exact.covariance = graph_.pose_edges[static_cast<std::size_t>(pose - 1)].covariance;
    filter_.predict(exact);
  }

  void see(const core::LandmarkGraph::LandmarkEdge& edge, std::vector<cekf::Match>& known) {
    const core::LandmarkGraph::Landmark& landmark = graph_.landmarks[static_cast<std::size_t>(edge.landmark)];
    cekf::Match exact{static_cast<core::LandmarkId>(landmark.name), edge.observation, edge.T_robot_sensor};
    exact.observation.z =
        core::predict_observation(edge.observation.kind, at(edge.pose), edge.T_robot_sensor, landmark.point_m).z_hat;
    if (--left_[static_cast<std::size_t>(edge.landmark)] == 0 && !before_.contains(exact.landmark)) {
      lost_.push_back(exact.landmark);
    }
    if (filter_.contains(exact.landmark)) {
      known.push_back(exact);
    } else {
      filter_.augment(exact.observation, exact.T_robot_sensor, exact.landmark);
    }
  }

  void forget_lost() {
    for (const core::LandmarkId id : lost_) filter_.remove(id);
    lost_.clear();
  }

  const core::LandmarkGraph& graph_;
  const cekf::CompressedEkf& before_;
  std::vector<int> left_;  ///< observations still to come, by landmark
  std::vector<core::LandmarkId> lost_;
  cekf::CompressedEkf filter_;
};

/// χ² of three more degrees of freedom, exceeded once in a million times: by less the two costs differ that would be one
/// if everything were linear. Measured: −12 to 17 (docs/adr/0010-solving-the-drive.md).
double slack() { return core::chi2_quantile(0.999999, 3); }

smoothing::Report solve(const core::PoseGaussian& start, core::LandmarkGraph& graph) {
  smoothing::Problem problem = problem_of(start, graph);
  smoothing::Options options;
  options.first_damping = 1e-8;  // from a good start
  options.ordering = smoothing::Ordering::amd;
  smoothing::Report report = smoothing::optimize(problem, options);
  graph.poses = std::move(problem.graph.poses);
  graph.landmarks = std::move(problem.graph.landmarks);
  return report;
}

}  // namespace

Smoothing smooth_drive(const cekf::CompressedEkf& filter, const core::PoseGaussian& start, const Tape& tape) {
  Smoothing result;
  result.limit = drive_cost(tape) + slack();
  try {
    core::LandmarkGraph graph = graph_of(start, tape, filter);
    result.poses = static_cast<int>(graph.poses.size());
    const smoothing::Report report = solve(start, graph);
    result.chi2 = report.chi2.total();
    result.iterations = static_cast<int>(report.iterations.size());
    if (report.reason != smoothing::Reason::converged || !(result.chi2 <= result.limit)) return result;
    result.solved.emplace(Refilter(start, graph, filter).run());
  } catch (const core::NumericalError&) {
    result.solved.reset();  // what cannot be solved leaves the filter as it is
  }
  return result;
}

}  // namespace helixnav::supervisor
