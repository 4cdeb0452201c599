// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstring>

#include "helixnav/atlas/atlas.hpp"
#include "solve/estimates.hpp"
#include "solve/settle.hpp"
#include "tree/front_shape.hpp"
#include "tree/state.hpp"

namespace helixnav::atlas {

/// What tests need to see of an atlas.
struct AtlasAccess {
  static State& working(Atlas& atlas) { return *atlas.working_; }
  static const State& settled(const Atlas& atlas) { return *atlas.settled_; }

  /// Marks every node, at mutually consistent values.
  static void dirty_all(State& state) {
    Estimates estimates(state);
    estimates.update_all(state.root);
    estimates.store(state);
    for (std::size_t i = 0; i < state.nodes.size(); ++i) state.nodes.write(i).dirty = true;
  }

  /// Linearises everything at the present values, which do not change.
  static void linearise_in_place(State& state) {
    dirty_all(state);
    int redone = 0;
    redo_dirty(state, redone, {});
    for (std::size_t i = 0; i < state.nodes.size(); ++i) {
      const FrontShape& shape = *state.nodes[i].shape;
      state.nodes.write(i).opened_at = std::make_shared<const Values>(
          values_of(state, shape, shape.eliminated, static_cast<int>(shape.variables.size())));
    }
  }

  /// Linearises everything again, under other options.
  static void settle_with(Atlas& atlas, const Options& options) {
    State& state = *atlas.working_;
    state.options = options;
    dirty_all(state);
    atlas.settle();
  }
};

namespace testing {

template <class Vector>
bool same_bytes(const Vector& a, const Vector& b) {
  if (a.size() != b.size()) return false;
  if (a.size() == 0) return true;  // there may be no address to compare
  return std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(a.data()[0])) == 0;
}

/// Bit for bit: estimates, factors and messages of both.
inline bool same_bytes(const State& a, const State& b) {
  if (a.values.size() != b.values.size() || a.nodes.size() != b.nodes.size() || a.root != b.root) return false;
  for (std::size_t v = 0; v < a.values.size(); ++v) {
    if (!same_bytes(a.values[v], b.values[v])) return false;
  }
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    const TreeNode& left = a.nodes[i];
    const TreeNode& right = b.nodes[i];
    if ((left.front == nullptr) != (right.front == nullptr) || left.shape->variables != right.shape->variables)
      return false;
    if (left.front == nullptr) continue;
    if (!same_bytes(left.front->L, right.front->L) || !same_bytes(left.front->message, right.front->message))
      return false;
  }
  return true;
}

}  // namespace testing
}  // namespace helixnav::atlas
