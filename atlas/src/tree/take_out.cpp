// SPDX-License-Identifier: BSD-3-Clause
#include "tree/take_out.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "solve/estimates.hpp"
#include "tree/front_shape.hpp"

namespace helixnav::atlas {
namespace {

/// Leaves that hold a variable of the phase.
std::vector<int> leaves_on_ground_of(const State& state, int phase) {
  std::vector<int> leaves;
  for (const int v : variables_of(state.leaf(phase))) {
    for (const int other : *state.phases_of[State::index(v)]) {
      leaves.push_back(state.leaf_of_phase[State::index(other)]);
    }
  }
  std::sort(leaves.begin(), leaves.end());
  leaves.erase(std::unique(leaves.begin(), leaves.end()), leaves.end());
  return leaves;
}

void let_go(State& state, int phase) {
  for (const int v : variables_of(state.leaf(phase))) {
    auto phases = std::make_shared<std::vector<int>>(*state.phases_of[State::index(v)]);
    phases->erase(std::find(phases->begin(), phases->end(), phase));
    Variable& variable = state.variables.write(State::index(v));
    variable.leaves -= 1;
    if (variable.leaves == 0) variable.at = -1;
    state.phases_of.write(State::index(v)) = std::move(phases);
  }
}

void free_node(State& state, int id) {
  // never destroyed: a thread may still be here when the process ends
  static const auto& nothing = *new auto(std::make_shared<const FrontShape>());
  TreeNode node;
  node.parent = state.free_node;
  node.dirty = false;
  node.shape = nothing;
  state.nodes.write(State::index(id)) = node;
  state.free_node = id;
}

/// Returns the sibling.
int cut_off(State& state, int leaf) {
  const int parent = state.node(leaf).parent;
  const std::array<int, 2> children = state.node(parent).child;
  const int sibling = children[0] == leaf ? children[1] : children[0];
  const int above = state.node(parent).parent;
  state.nodes.write(State::index(sibling)).parent = above;
  if (above < 0) {
    state.root = sibling;
  } else {
    auto& child = state.nodes.write(State::index(above)).child;
    (child[0] == parent ? child[0] : child[1]) = sibling;
  }
  free_node(state, leaf);
  free_node(state, parent);
  return sibling;
}

}  // namespace

void bring_ground_along(State& state, int phase) {
  Estimates estimates(state);
  for (const int leaf : leaves_on_ground_of(state, phase)) estimates.reach(leaf);
  estimates.store(state);
}

void take_out(State& state, int phase, int host) {
  std::vector<int> touched = leaves_on_ground_of(state, phase);
  const int leaf = state.leaf_of_phase[State::index(phase)];
  touched.erase(std::find(touched.begin(), touched.end(), leaf));
  const auto begin_of = [&state](int one) {
    return core::Pose2(Eigen::Vector3d(state.value(state.leaf(one).parts.front().variables[0])));
  };
  Leaf left;
  left.host = host;
  left.T_host_entry = core::between(begin_of(host), begin_of(phase));
  auto shape = std::make_shared<PhaseFactor>();
  shape->shape.T_entry_robot = state.leaf(phase).phase->shape.T_entry_robot;
  left.phase = std::move(shape);
  let_go(state, phase);
  state.phases.write(State::index(phase)) = std::make_shared<const Leaf>(std::move(left));
  state.leaf_of_phase.write(State::index(phase)) = -1;
  touched.push_back(cut_off(state, leaf));
  shape_paths(state, touched);
}

}  // namespace helixnav::atlas
