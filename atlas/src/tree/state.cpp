// SPDX-License-Identifier: BSD-3-Clause
#include "tree/state.hpp"

#include <algorithm>

namespace helixnav::atlas {

std::vector<int> variables_of(const Leaf& leaf) {
  std::vector<int> all;
  for (const Part& part : leaf.parts) all.insert(all.end(), part.variables.begin(), part.variables.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

std::vector<int> landmarks_of(const Leaf& leaf) {
  const std::vector<int>& variables = leaf.parts.front().variables;
  std::vector<int> landmarks(variables.begin() + 2, variables.end());
  std::sort(landmarks.begin(), landmarks.end());
  landmarks.erase(std::unique(landmarks.begin(), landmarks.end()), landmarks.end());
  return landmarks;
}

int add_variable(State& state, int dim, int name, const Eigen::Vector3d& value) {
  // never destroyed: a thread may still be here when the process ends
  static const auto& nobody = *new auto(std::make_shared<const std::vector<int>>());
  Variable variable;
  variable.dim = dim;
  variable.name = name;
  state.variables.push_back(variable);
  state.values.push_back(value);
  state.phases_of.push_back(nobody);
  return static_cast<int>(state.variables.size()) - 1;
}

int add_node(State& state, const TreeNode& node) {
  if (state.free_node < 0) {
    state.nodes.push_back(node);
    return static_cast<int>(state.nodes.size()) - 1;
  }
  const int id = state.free_node;
  state.free_node = state.node(id).parent;
  state.nodes.write(State::index(id)) = node;
  return id;
}

void mark_dirty(State& state, int node) {
  for (; node >= 0 && !state.node(node).dirty; node = state.node(node).parent) {
    state.nodes.write(State::index(node)).dirty = true;
  }
}

Values values_of(const State& state, const FrontShape& shape, int begin, int end) {
  Values values;
  values.reserve(State::index(end - begin));
  for (int i = begin; i < end; ++i) values.push_back(state.value(shape.variables[State::index(i)]));
  return values;
}

}  // namespace helixnav::atlas
