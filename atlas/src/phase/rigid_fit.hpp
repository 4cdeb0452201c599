// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "tree/state.hpp"

namespace helixnav::atlas {

/// A rigid motion x ↦ to + R(turn)·(x − from); headings turn with it.
struct RigidMotion {
  double turn_rad = 0.0;
  Eigen::Matrix2d R = Eigen::Matrix2d::Identity();
  Eigen::Vector2d from_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d to_m = Eigen::Vector2d::Zero();
  bool is_identity = true;

  Eigen::Vector2d point(const Eigen::Vector2d& p) const;
  Eigen::Vector3d operator()(const Eigen::Vector3d& value, int dim) const;
};

/// The map frame may be a hundred kilometres away, and a part that turns by 1e-4 rad leaves it 10 m from where it would be if it moved along.
/// What the part measures relative to it are places of the part's own (fixes), so that only how the map frame has moved at the part's centre c
/// counts: its point there by u, and its heading by φ. The rest of its position is what the linear measurements of the part assume for it,
/// u − φJ(c − p), and not the chord p' − p: the difference, φ²/2 times the distance, would turn the part by the force of its fixes
/// at that lever.
struct FarFrame {
  Eigen::Index row = -1;                              ///< first of its rows; −1: not among the variables, or alone
  Eigen::Vector2d off_m = Eigen::Vector2d::Zero();    ///< u, in the frame linearised in
  Eigen::Vector2d lever_m = Eigen::Vector2d::Zero();  ///< J(R(φ) − I)(c − p): by its heading, beyond φJ(c − p)
};

/// How far some variables have moved since they were linearised: the rigid motion that explains most of it, and the rest.
struct Motion {
  RigidMotion rigid;
  Eigen::VectorXd rest;  ///< in the frame of linearisation; empty when nothing moved
  double rest_m = 0.0;   ///< largest |rest|, headings weighed by the span
  double bend_m = 0.0;   ///< second-order error of linearising there: max |rest|² / span
  double reach_m = 0.0;  ///< farthest variable from the centre, the map frame left out
  FarFrame world;        ///< of the map frame, where it is among others
};

/// Motion of the variables `shape.variables[begin …)` from `was` to `now`, both from `begin` on. The fit is least squares over
/// positions, and headings at an arm of one metre; the variable of the map frame, which may be far away, does not
/// take part while there are others. Equal values give the identity, exactly. Cost linear.
Motion motion_of(const State& state, const FrontShape& shape, int begin, const Eigen::Vector3d* was, const Values& now);

/// That of a node's boundary since the node was linearised, and the gradient of its rigid.turn_rad by the present values, as many
/// rows as `rest`.
Motion motion_of_boundary(const State& state, int node);
Eigen::VectorXd gradient_of_turn(const State& state, int node, const Motion& motion);

}  // namespace helixnav::atlas
