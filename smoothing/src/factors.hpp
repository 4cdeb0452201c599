// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/smoothing/problem.hpp"

namespace helixnav::smoothing {

/// The values that are optimised.
struct State {
  std::vector<core::Pose2> poses;
  std::vector<Eigen::Vector2d> landmarks;
};

State state_of(const core::LandmarkGraph& graph);
void put_state(const State& state, core::LandmarkGraph& graph);

/// A residual of D rows over variables of NA and NB coordinates, with derivatives by (x, y, heading) or (x, y).
template <int D, int NA, int NB>
struct BinaryFactor {
  Eigen::Matrix<double, D, 1> e;
  Eigen::Matrix<double, D, NA> J_a;
  Eigen::Matrix<double, D, NB> J_b;
};
template <int D, int NA>
struct UnaryFactor {
  Eigen::Matrix<double, D, 1> e;
  Eigen::Matrix<double, D, NA> J_a;
};

/// between(T_from, T_to) − T_from_to with J₃ and J₄ of dlr_kurlbaum2009 eq (6), (7).
BinaryFactor<3, 3, 3> odometry_factor(const core::LandmarkGraph::PoseEdge& edge, const core::Pose2& T_world_from,
                                      const core::Pose2& T_world_to);

/// ẑ − z; D = core::dimension(kind). NumericalError when the landmark stands at the sensor.
template <int D>
BinaryFactor<D, 3, 2> observation_factor(const core::LandmarkGraph::LandmarkEdge& edge,
                                         const core::Pose2& T_world_robot, const Eigen::Vector2d& landmark_m) {
  const core::PredictedObservation predicted =
      core::predict_observation(edge.observation.kind, T_world_robot, edge.T_robot_sensor, landmark_m);
  return {-core::innovation(edge.observation.kind, edge.observation.z, predicted.z_hat), predicted.H_pose,
          predicted.H_landmark};
}

/// Where the antenna should be minus where the fix says it is.
UnaryFactor<2, 3> fix_factor(const core::AbsoluteFix& fix, const core::Pose2& T_world_robot);

/// Value minus mean; the derivative is the identity.
UnaryFactor<3, 3> prior_factor(const PosePrior& prior, const core::Pose2& T_world_robot);
UnaryFactor<2, 2> prior_factor(const LandmarkPrior& prior, const Eigen::Vector2d& point_m);

}  // namespace helixnav::smoothing
