// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "helixnav/core/angle.hpp"
#include "phase/fix_factor.hpp"
#include "phase/rigid_fit.hpp"
#include "phase/world_form.hpp"
#include "solve/estimates.hpp"
#include "solve/settle.hpp"

namespace helixnav::atlas {
namespace {

/// Below this nothing moves, however small a bend is asked for.
constexpr double still_m = 1e-8;

/// By how much the options' limits are widened. After twenty rounds χ² has long settled, and what still moves is what little is known
/// of: a landmark seen once or twice, with phases that move it to and fro by a bit more than the limit.
double widened(const State& state) {
  constexpr int enough = 20;
  constexpr double rounds_to_double = 4.0;
  return std::exp2(std::max(0, state.rounds - enough) / rounds_to_double);
}

bool is_bent(const State& state, const Motion& motion) {
  return motion.rest_m > still_m && motion.bend_m > widened(state) * state.options.bend_m;
}

/// The parent took the child's message as it was then; turned on by φ, what is `reach` away is off by φ²/2 of that.
bool is_turned(const State& state, const Motion& motion, double was_turned_rad) {
  const double turn_rad = std::abs(core::wrap_to_pi(motion.rigid.turn_rad - was_turned_rad));
  const double off_m = turn_rad * (0.5 * turn_rad * motion.reach_m + motion.rest_m);
  return off_m > std::max(widened(state) * state.options.bend_m, still_m);
}

std::vector<Eigen::Vector2d> points_of(const Eigen::VectorXd& u) {
  std::vector<Eigen::Vector2d> points_m;
  for (Eigen::Index row = 3; row < u.size(); row += 2) points_m.emplace_back(u.segment<2>(row));
  return points_m;
}

/// True when the phase was derived again.
bool rederive_if_moved(State& state, int phase) {
  const Leaf& leaf = state.leaf(phase);
  if (leaf.log == nullptr) return false;
  Values values;
  for (const int v : leaf.parts.front().variables) values.push_back(state.value(v));
  const Eigen::VectorXd u = relative_coordinates(values);
  Eigen::VectorXd moved = (u - leaf.parts.front().gaussian->mean).cwiseAbs();
  const double turned_rad = std::abs(core::wrap_to_pi(moved[2]));
  moved[2] = 0.0;
  const double share = widened(state);
  if (moved.maxCoeff() <= std::max(share * state.options.rederive_m, still_m) &&
      turned_rad <= std::max(share * state.options.rederive_rad, still_m)) {
    return false;
  }
  Leaf changed = leaf;
  PhaseFactor factor = rederive_factor(*leaf.log, *leaf.phase, core::Pose2(Eigen::Vector3d(u.head<3>())), points_of(u));
  changed.phase = std::make_shared<const PhaseFactor>(std::move(factor));
  changed.parts.front().gaussian = gaussian_of(changed.phase);
  state.phases.write(State::index(phase)) = std::make_shared<const Leaf>(std::move(changed));
  return true;
}

/// Fixes of an antenna off the robot's origin turn with the robot. True when one was derived again.
bool rederive_turned_fixes(State& state, int phase) {
  Leaf changed = state.leaf(phase);
  bool any = false;
  for (Part& part : changed.parts) {
    if (part.fix == nullptr) continue;
    const Eigen::VectorXd u = relative_coordinates({state.value(part.variables[0]), state.value(part.variables[1])});
    const double turned_rad = core::wrap_to_pi(u[2] - part.gaussian->mean[2]);
    const double off_m = turned_rad * turned_rad * part.fix->antenna_robot_m.norm();
    if (off_m <= std::max(0.1 * state.options.bend_m, still_m * still_m)) continue;
    part.gaussian = std::make_shared<const RelativeGaussian>(fix_factor(*part.fix, u));
    any = true;
  }
  if (any) state.phases.write(State::index(phase)) = std::make_shared<const Leaf>(std::move(changed));
  return any;
}

void open_leaf(State& state, int id) {
  const TreeNode& node = state.node(id);
  const FrontShape& shape = *node.shape;
  const Motion motion = motion_of(state, shape, 0, node.front->linearised_at.data(),
                                  values_of(state, shape, 0, static_cast<int>(shape.variables.size())));
  const int phase = node.phase;
  const bool moved = rederive_if_moved(state, phase);
  const bool turned = state.leaf(phase).parts.size() > 1 && rederive_turned_fixes(state, phase);
  if (moved || turned || is_bent(state, motion)) mark_dirty(state, id);
}

void open_children(State& state, int id) {
  const std::array<int, 2> children = state.node(id).child;
  for (std::size_t c = 2; c-- > 0;) {
    const TreeNode& child = state.node(children[c]);
    const Motion motion = motion_of_boundary(state, children[c]);
    const bool bent = is_bent(state, motion);
    const bool follows = bent || child.fresh;
    if (bent) mark_dirty(state, children[c]);
    if (is_turned(state, motion, state.node(id).front->child_turn_rad[c])) mark_dirty(state, id);
    if (follows) state.to_open.push_back(children[c]);
  }
}

}  // namespace

void open(State& state, int id) {
  const FrontShape& shape = *state.node(id).shape;
  const Front& front = *state.node(id).front;
  Values boundary = values_of(state, shape, shape.eliminated, static_cast<int>(shape.variables.size()));
  const Motion motion =
      motion_of(state, shape, shape.eliminated, front.linearised_at.data() + shape.eliminated, boundary);
  const Values values = solve_down(state, shape, front, motion);
  for (std::size_t i = 0; i < values.size(); ++i) {
    state.values.write(State::index(shape.variables[i])) = values[i];
  }
  TreeNode& node = state.nodes.write(State::index(id));
  node.opened_at = std::make_shared<const Values>(std::move(boundary));
  node.fresh = false;
  if (node.phase >= 0) {
    open_leaf(state, id);
  } else {
    open_children(state, id);
  }
}

void finish_descent(State& state) {
  while (!state.to_open.empty()) {
    const int node = state.to_open.back();
    state.to_open.pop_back();
    open(state, node);
  }
  state.descending = false;
  state.begun = nullptr;
}

}  // namespace helixnav::atlas
