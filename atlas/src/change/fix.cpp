// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include <Eigen/LU>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/gaussian.hpp"
#include "phase/fix_factor.hpp"
#include "phase/world_form.hpp"
#include "solve/estimates.hpp"
#include "solve/settle.hpp"
#include "tree/front_shape.hpp"

namespace helixnav::atlas {

RelativeGaussian fix_factor(const core::AbsoluteFix& fix, const Eigen::Vector3d& T_world_robot) {
  const Eigen::Vector2d arm_m = core::rotation(T_world_robot.z()) * fix.antenna_robot_m;
  Eigen::Matrix<double, 2, 3> J;
  J << 1.0, 0.0, -arm_m.y(), 0.0, 1.0, arm_m.x();
  const Eigen::Vector2d r = fix.position_world_m - T_world_robot.head<2>() - arm_m;
  const Eigen::Matrix2d W = fix.covariance_m2.inverse();
  RelativeGaussian factor;
  factor.information = J.transpose() * W * J;
  factor.vector = J.transpose() * (W * r);
  factor.mean = T_world_robot;
  factor.chi2 = r.dot(W * r);
  return factor;
}

void Atlas::fix(int clone, const core::AbsoluteFix& fix) {
  if (clone < 0 || clone >= static_cast<int>(working_->variable_of_clone.size()) || working_->root < 0) {
    throw core::PreconditionError("atlas: fix of clone " + std::to_string(clone) + ", which no phase has");
  }
  if (!fix.position_world_m.allFinite() || !fix.antenna_robot_m.allFinite() ||
      !core::is_symmetric_positive_definite(fix.covariance_m2)) {
    throw core::PreconditionError("atlas: a fix is not finite, or its covariance not symmetric positive definite");
  }
  finish_descent(*working_);
  State& state = *working_;
  const int v = state.variable_of_clone[State::index(clone)];
  const int phase = std::max(clone - 1, 0);
  const int node = state.leaf_of_phase[State::index(phase)];
  if (node < 0) throw core::PreconditionError("atlas: fix of a phase that was condensed");
  Estimates estimates(state);
  estimates.reach(node);
  estimates.reach(state.variable(state.world).at);
  estimates.store(state);
  auto own = fix;
  if (state.world == state.variable_of_clone[0]) {  // the map frame has that clone at the start's mean
    const core::Pose2 T_world_map = core::inverse(state.start.mean);
    const Eigen::Matrix2d R = core::rotation(T_world_map.heading_rad);
    own.position_world_m = core::transform(T_world_map, fix.position_world_m);
    own.covariance_m2 = R * fix.covariance_m2 * R.transpose();
  }
  if (v == state.world) throw core::PreconditionError("atlas: fix of the clone that stands for the map frame");
  const Eigen::VectorXd T_world_robot = relative_coordinates({state.value(state.world), state.value(v)});
  Leaf leaf = state.leaf(phase);
  leaf.parts.push_back({{state.world, v},
                        std::make_shared<const RelativeGaussian>(fix_factor(own, T_world_robot)),
                        std::make_shared<const core::AbsoluteFix>(own)});
  const std::vector<int> before = variables_of(state.leaf(phase));
  state.phases.write(State::index(phase)) = std::make_shared<const Leaf>(std::move(leaf));
  if (!std::binary_search(before.begin(), before.end(), state.world)) {
    state.variables.write(State::index(state.world)).leaves += 1;
    auto phases = std::make_shared<std::vector<int>>(*state.phases_of[State::index(state.world)]);
    phases->insert(std::lower_bound(phases->begin(), phases->end(), phase), phase);
    state.phases_of.write(State::index(state.world)) = std::move(phases);
  }
  shape_paths(state, {node, state.variable(state.world).at});
}

}  // namespace helixnav::atlas
