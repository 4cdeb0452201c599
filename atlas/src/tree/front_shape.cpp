// SPDX-License-Identifier: BSD-3-Clause
#include "tree/front_shape.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace helixnav::atlas {
namespace {

struct Counted {
  int variable;
  int leaves;
};

/// Variables that come up to a node, increasing, with the leaves below that hold each.
std::vector<Counted> incoming(const State& state, int id) {
  const TreeNode& node = state.node(id);
  std::vector<Counted> all;
  if (node.phase >= 0) {
    for (const int v : variables_of(state.leaf(node.phase))) all.push_back({v, 1});
    return all;
  }
  for (const int child : node.child) {
    const FrontShape& below = *state.node(child).shape;
    for (int i = below.eliminated; i < static_cast<int>(below.variables.size()); ++i) {
      all.push_back({below.variables[State::index(i)], below.counts[State::index(i)]});
    }
  }
  std::sort(all.begin(), all.end(), [](const Counted& a, const Counted& b) { return a.variable < b.variable; });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (kept > 0 && all[kept - 1].variable == all[i].variable) {
      all[kept - 1].leaves += all[i].leaves;
    } else {
      all[kept++] = all[i];
    }
  }
  all.resize(kept);
  return all;
}

/// Offset in `shape` of each boundary variable of a child.
std::vector<int> offsets_of_boundary(const FrontShape& child, const FrontShape& shape) {
  std::vector<int> offsets;
  const auto begin = shape.variables.begin();
  const auto middle = begin + shape.eliminated;
  for (int i = child.eliminated; i < static_cast<int>(child.variables.size()); ++i) {
    const int v = child.variables[State::index(i)];
    auto found = std::lower_bound(begin, middle, v);
    if (found == middle || *found != v) found = std::lower_bound(middle, shape.variables.end(), v);
    offsets.push_back(shape.offsets[static_cast<std::size_t>(found - begin)]);
  }
  return offsets;
}

void collect_paths(const State& state, const std::vector<int>& nodes, std::vector<int>& all) {
  for (int node : nodes) {
    for (; node >= 0; node = state.node(node).parent) all.push_back(node);
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
}

void shape_marked(State& state, int id, const std::vector<int>& marked) {
  if (!std::binary_search(marked.begin(), marked.end(), id)) return;
  if (!state.is_leaf(id)) {
    const std::array<int, 2> child = state.node(id).child;
    shape_marked(state, child[0], marked);
    shape_marked(state, child[1], marked);
  }
  shape_front(state, id);
}

}  // namespace

void shape_front(State& state, int id) {
  auto shape = std::make_shared<FrontShape>();
  std::vector<Counted> all = incoming(state, id);
  const auto is_complete = [&state, id](const Counted& c) {
    const Variable& v = state.variable(c.variable);
    return id == state.root || c.leaves == v.leaves;
  };
  const auto boundary = std::stable_partition(all.begin(), all.end(), is_complete);
  shape->eliminated = static_cast<int>(boundary - all.begin());
  int offset = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const int v = all[i].variable;
    shape->variables.push_back(v);
    shape->counts.push_back(all[i].leaves);
    shape->offsets.push_back(offset);
    offset += state.variable(v).dim;
    if (static_cast<int>(i) < shape->eliminated) {
      shape->ne = offset;
      if (state.variable(v).at != id) state.variables.write(State::index(v)).at = id;
    }
  }
  shape->nb = offset - shape->ne;
  TreeNode& node = state.nodes.write(State::index(id));
  node.leaves = 1;
  if (node.phase < 0) {
    node.leaves = 0;
    for (std::size_t c = 0; c < 2; ++c) {
      shape->from_child[c] = offsets_of_boundary(*state.node(node.child[c]).shape, *shape);
      node.leaves += state.node(node.child[c]).leaves;
    }
  }
  node.shape = std::move(shape);
  node.front = nullptr;
  node.opened_at = nullptr;
  node.dirty = true;
}

void shape_paths(State& state, const std::vector<int>& nodes) {
  std::vector<int> marked;
  collect_paths(state, nodes, marked);
  shape_marked(state, state.root, marked);
}

}  // namespace helixnav::atlas
