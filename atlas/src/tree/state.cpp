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
