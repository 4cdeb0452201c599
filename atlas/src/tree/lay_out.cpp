// SPDX-License-Identifier: BSD-3-Clause
#include "tree/lay_out.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "solve/estimates.hpp"
#include "tree/front_shape.hpp"

namespace helixnav::atlas {
namespace {

struct Item {
  int leaf;
  Eigen::Vector2d where_m;
  std::vector<int> variables;
};

using Order = std::vector<const Item*>;

/// Where to cut an order of phases: cost and the number of phases before the cut.
struct Cut {
  double cost = std::numeric_limits<double>::infinity();
  std::size_t before = 0;
};

class Layout {
 public:
  Layout(State& state, std::vector<int> nodes) : state_(state), free_(std::move(nodes)) {}

  int build(Order items, int parent) {
    if (items.size() == 1) {
      state_.nodes.write(State::index(items[0]->leaf)).parent = parent;
      return items[0]->leaf;
    }
    const int id = free_.back();
    free_.pop_back();
    std::size_t before = 0;
    Order order = best_order(items, before);
    items = Order();
    const int left = build(Order(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(before)), id);
    const int right = build(Order(order.begin() + static_cast<std::ptrdiff_t>(before), order.end()), id);
    TreeNode node;
    node.parent = parent;
    node.child = {left, right};
    state_.nodes.write(State::index(id)) = node;
    shape_front(state_, id);
    return id;
  }

 private:
  Order best_order(const Order& items, std::size_t& before) {
    Order best;
    Cut least;
    for (int axis = 0; axis < 2; ++axis) {
      Order order = items;
      std::sort(order.begin(), order.end(), [axis](const Item* a, const Item* b) {
        return a->where_m[axis] != b->where_m[axis] ? a->where_m[axis] < b->where_m[axis] : a->leaf < b->leaf;
      });
      const Cut cut = best_cut(order);
      if (cut.cost < least.cost) {
        least = cut;
        best = std::move(order);
      }
    }
    before = least.before;
    return best;
  }

  /// States shared by both sides, weighted by imbalance, at each place from 30 to 70 % of the order.
  Cut best_cut(const Order& order) {
    const std::size_t n = order.size();
    first_.clear();
    std::vector<int> change(n + 1, 0);
    for (std::size_t i = 0; i < n; ++i) {
      for (const int v : order[i]->variables) {
        const auto [span, is_new] = first_.try_emplace(v, i, i);
        if (is_new) continue;
        const int dim = state_.variable(v).dim;
        if (span->second.second == span->second.first) change[span->second.first] += dim;
        change[span->second.second] += span->second.second == span->second.first ? 0 : dim;
        change[i] -= dim;
        span->second.second = i;
      }
    }
    const std::size_t low = n < 4 ? 0 : static_cast<std::size_t>(0.3 * static_cast<double>(n));
    const std::size_t high = n < 4 ? n - 1 : static_cast<std::size_t>(0.7 * static_cast<double>(n));
    Cut best;
    int shared = 0;
    for (std::size_t i = 0; i + 1 < n; ++i) {
      shared += change[i];
      if (i < low || i >= std::max(high, low + 1)) continue;
      const double share = (static_cast<double>(i) + 1.0) / static_cast<double>(n);
      const double cost = (shared + 1.0) * (1.0 + 2.0 * std::abs(share - 0.5));
      if (cost < best.cost) best = {cost, i + 1};
    }
    return best;
  }

  State& state_;
  std::vector<int> free_;
  std::unordered_map<int, std::pair<std::size_t, std::size_t>> first_;
};

void collect(const State& state, int id, std::vector<int>& leaves, std::vector<int>& inner) {
  if (state.is_leaf(id)) {
    leaves.push_back(id);
    return;
  }
  for (const int child : state.node(id).child) collect(state, child, leaves, inner);
  inner.push_back(id);
}

std::vector<Item> items_of(const State& state, const std::vector<int>& leaves) {
  std::vector<Item> items;
  for (const int leaf : leaves) {
    const Leaf& content = state.leaf(state.node(leaf).phase);
    const std::vector<int>& phase = content.parts.front().variables;
    items.push_back({leaf, 0.5 * (state.value(phase[0]) + state.value(phase[1])).head<2>(), variables_of(content)});
  }
  return items;
}

}  // namespace

void lay_out(State& state, int subtree) {
  std::vector<int> leaves;
  std::vector<int> inner;
  collect(state, subtree, leaves, inner);
  if (inner.empty()) return;
  Estimates estimates(state);
  estimates.reach(subtree);
  estimates.update_all(subtree);
  estimates.store(state);
  const int parent = state.node(subtree).parent;
  const std::vector<Item> items = items_of(state, leaves);
  Order order;
  for (const Item& item : items) order.push_back(&item);
  std::sort(inner.begin(), inner.end());
  inner.erase(std::find(inner.begin(), inner.end(), subtree));
  inner.push_back(subtree);  // comes off first: the root keeps its number, and so does the child of the parent
  Layout(state, inner).build(std::move(order), parent);
  mark_dirty(state, parent);
}

namespace {

/// Which phases hold each variable, how many those are, and no tree.
void count_leaves(State& state) {
  std::vector<std::vector<int>> phases_of(state.variables.size());
  for (std::size_t phase = 0; phase < state.phases.size(); ++phase) {
    for (const int v : variables_of(*state.phases[phase]))
      phases_of[State::index(v)].push_back(static_cast<int>(phase));
  }
  for (std::size_t v = 0; v < phases_of.size(); ++v) {
    Variable& variable = state.variables.write(v);
    variable.leaves = static_cast<int>(phases_of[v].size());
    variable.at = -1;
    state.phases_of.write(v) = std::make_shared<const std::vector<int>>(std::move(phases_of[v]));
  }
}

void drop_tree(State& state) {
  state.nodes = {};
  state.leaf_of_phase = {};
  state.free_node = state.root = -1;
  state.descending = false;
  state.to_open.clear();
  state.rounds = 0;
  state.begun = nullptr;
}

}  // namespace

void lay_out_anew(State& state) {
  drop_tree(state);
  count_leaves(state);
  std::vector<int> leaves;
  for (std::size_t phase = 0; phase < state.phases.size(); ++phase) {
    state.leaf_of_phase.push_back(-1);
    if (state.phases[phase]->parts.empty()) continue;
    TreeNode node;
    node.phase = static_cast<int>(phase);
    leaves.push_back(add_node(state, node));
    state.leaf_of_phase.write(phase) = leaves.back();
  }
  std::vector<int> inner;
  while (inner.size() + 1 < leaves.size()) inner.push_back(add_node(state, TreeNode()));
  state.root = inner.empty() ? leaves.back() : inner.back();  // comes off first
  for (const int leaf : leaves) shape_front(state, leaf);
  if (inner.empty()) return;
  const std::vector<Item> items = items_of(state, leaves);
  Order order;
  for (const Item& item : items) order.push_back(&item);
  Layout(state, inner).build(std::move(order), -1);
}

void rebalance(State& state, int leaf) {
  int height = 0;
  int node = leaf;
  const auto deepest = [&state](int id) { return 4.0 + 2.2 * std::log2(static_cast<double>(state.node(id).leaves)); };
  while (node != state.root) {
    node = state.node(node).parent;
    ++height;
  }
  if (height <= deepest(state.root)) return;
  height = 0;
  for (node = leaf; node != state.root && height <= deepest(node); ++height) node = state.node(node).parent;
  lay_out(state, node);
}

}  // namespace helixnav::atlas
