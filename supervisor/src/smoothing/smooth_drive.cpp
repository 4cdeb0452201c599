// SPDX-License-Identifier: BSD-3-Clause
#include "smoothing/smooth_drive.hpp"

#include <optional>
#include <utility>
#include <vector>

#include "helixnav/core/chi2.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/smoothing/minimum.hpp"
#include "smoothing/drive_graph.hpp"

namespace helixnav::supervisor {
namespace {

/// The pose at the end of the drive and the landmarks that `before` has as all measurements linearised at the minimum make them,
/// everything else eliminated.
core::JointGaussian joint_at(const smoothing::Minimum& minimum, const core::LandmarkGraph& graph,
                             const cekf::CompressedEkf& before) {
  core::JointGaussian joint;
  std::vector<int> landmarks;
  for (std::size_t k = 0; k < graph.landmarks.size(); ++k) {
    const auto id = static_cast<core::LandmarkId>(graph.landmarks[k].name);
    if (!before.contains(id)) continue;
    joint.ids.push_back(id);
    joint.points_m.push_back(graph.landmarks[k].point_m);
    landmarks.push_back(static_cast<int>(k));
  }
  joint.pose = graph.poses.back().T_world_robot;
  joint.covariance = minimum.joint_covariance({static_cast<int>(graph.poses.size()) - 1}, landmarks);
  return joint;
}

smoothing::Options from_a_good_start() {
  smoothing::Options options;
  options.first_damping = 1e-8;
  options.ordering = smoothing::Ordering::amd;
  return options;
}

}  // namespace

/// χ² of three more degrees of freedom, exceeded once in a million times: by less the two costs differ that would be one
/// if everything were linear. Measured: −12 to 17 (docs/adr/0010-solving-the-drive.md).
double slack() { return core::chi2_quantile(0.999999, 3); }

// Odometry of rank two, a certain start and an exact fix have no inverse; so much is added to them, a few ten-thousandths of
// what the simulated truck drifts.
Eigen::Vector3d softening() { return {2e-5, 2e-5, 2e-6}; }

smoothing::Problem problem_of(const core::PoseGaussian& start, core::LandmarkGraph graph) {
  smoothing::Problem problem;
  problem.graph = std::move(graph);
  const Eigen::Matrix3d certain = softening().cwiseAbs2().asDiagonal();
  problem.pose_priors.push_back({0, start.mean, start.covariance + certain});
  smoothing::soften_odometry(problem, softening());
  for (auto& edge : problem.graph.fix_edges) edge.fix.covariance_m2 += certain.topLeftCorner<2, 2>();
  return problem;
}

namespace {

/// Everything of the solution but the filter, and the joint estimate that this is to begin with, where it is accepted. Graph, factors and
/// minimum are gone when the filter is made: that is where a drive needs most memory.
std::optional<core::JointGaussian> solve(const cekf::CompressedEkf& filter, const core::PoseGaussian& start,
                                         const Tape& tape, const std::set<core::LandmarkId>& displaced,
                                         Smoothing& result) {
  DriveGraph drive = graph_of(start, tape, filter, displaced);
  smoothing::Problem problem = problem_of(start, std::move(drive.graph));
  result.poses = static_cast<int>(problem.graph.poses.size());
  const smoothing::Minimum minimum(problem, from_a_good_start());
  const smoothing::Report& report = minimum.report();
  result.chi2 = report.chi2.total();
  result.iterations = static_cast<int>(report.iterations.size());
  if (report.reason != smoothing::Reason::converged || !(result.chi2 <= result.limit)) return std::nullopt;
  core::JointGaussian joint = joint_at(minimum, problem.graph, filter);
  result.path = path_of(problem.graph, drive.stops);
  return joint;
}

}  // namespace

Smoothing smooth_drive(const cekf::CompressedEkf& filter, const core::PoseGaussian& start, const Tape& tape,
                       const std::set<core::LandmarkId>& displaced) {
  Smoothing result;
  result.limit = drive_cost(tape) + slack();
  try {
    const std::optional<core::JointGaussian> joint = solve(filter, start, tape, displaced, result);
    if (joint) result.solved.emplace(*joint, filter.next_name(), filter.options());
  } catch (const core::NumericalError&) {
    result.failed = true;
    result.path.clear();    // as that of a drive not solved
    result.solved.reset();  // what cannot be solved leaves the filter as it is
  }
  return result;
}

}  // namespace helixnav::supervisor
