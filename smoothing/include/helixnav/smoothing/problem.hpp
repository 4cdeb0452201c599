// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/events.hpp"
#include "helixnav/core/landmark_graph.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::smoothing {

/// Prior knowledge of a pose: mean with covariance in (x, y, heading) of the world [m, m, rad].
struct PosePrior {
  int pose = 0;
  core::Pose2 T_world_robot;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
};

/// Prior knowledge of a landmark [m²].
struct LandmarkPrior {
  int landmark = 0;
  Eigen::Vector2d point_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Identity();
};

/// A nonlinear least-squares problem over the poses and landmarks of a graph. The values in the graph are the start and,
/// after optimize(), the solution. The cost minimised is χ² = Σ eᵀC⁻¹e over
///   odometry   e = between(T_from, T_to) − T_from_to, heading wrapped         (dlr_kurlbaum2009 eq (5))
///   landmarks  e = z − h(T_world_robot ∘ T_robot_sensor, m)                   (eq (8), (13) and polar forms)
///   fixes      e = position − transform(T_world_robot, antenna)
///   priors     e = mean − value, heading wrapped
/// Poses in `fixed_poses` stay where they are: the gauge.
struct Problem {
  core::LandmarkGraph graph;
  std::vector<int> fixed_poses;
  std::vector<PosePrior> pose_priors;
  std::vector<LandmarkPrior> landmark_priors;
};

/// The problem of a graph with its first pose fixed.
Problem problem_from_graph(core::LandmarkGraph graph);

/// core::graph_from_events with its first pose fixed; see there for ids. Odometry covariances of rank two (an Ackermann
/// model, a straight line) need soften_odometry before they can be inverted.
Problem build_problem(const std::vector<core::Event>& events, const std::vector<std::vector<std::int64_t>>& ids,
                      const core::Pose2& start = core::Pose2());

/// Adds sigma² (x, y, heading; metres, metres, radians) to every odometry covariance. With sigma well above the drift of
/// one step, observations outweigh odometry and a bad start is corrected: solve softened first, then the given problem
/// from there (THEORY §5). With a small sigma it makes covariances of rank two invertible.
void soften_odometry(Problem& problem, const Eigen::Vector3d& sigma);

/// Rows of all measurements minus free columns, the expected χ² when covariances are right: eq (11), (12).
int degrees_of_freedom(const Problem& problem);

/// "pose 203" or "landmark 17", by the variable's own name.
std::string pose_name(const Problem& problem, int pose);
std::string landmark_name(const Problem& problem, int landmark);

/// Throws InputError, naming the variable or the measurement, when the problem cannot have a unique solution: an index
/// out of range, a value that is not finite, a covariance that is not symmetric positive definite, a variable with
/// fewer rows than unknowns, a connected part without a gauge. What depends on values (parallel bearings) is found by
/// optimize() and thrown as NumericalError with the same names. Linear cost. Test: smoothing/check_test.cpp.
void check_problem(const Problem& problem);

}  // namespace helixnav::smoothing
