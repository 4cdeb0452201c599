// SPDX-License-Identifier: BSD-3-Clause
#include "solve/settle.hpp"

#include <array>
#include <memory>
#include <string>

#include "helixnav/core/errors.hpp"
#include "solve/damped.hpp"
#include "solve/eliminate.hpp"

namespace helixnav::atlas {
namespace {

bool redo(State& state, int id, Workspace& workspace, int& redone, const std::function<bool()>& should_stop) {
  if (!state.node(id).dirty) return true;
  if (!state.is_leaf(id)) {
    const std::array<int, 2> children = state.node(id).child;  // the node moves when it is written
    for (const int child : children) {
      if (!redo(state, child, workspace, redone, should_stop)) return false;
    }
  }
  eliminate(state, id, workspace);
  ++redone;
  return !should_stop || !should_stop();
}

/// One upward and one downward pass. False when it was stopped.
bool sweep(State& state, int& redone, const std::function<bool()>& should_stop) {
  if (!state.descending) {
    const bool stopped = !redo_dirty(state, redone, should_stop);
    state.descending = !state.node(state.root).dirty;
    if (state.descending) state.to_open.assign(1, state.root);
    if (stopped) return false;
  }
  while (!state.to_open.empty()) {
    const int node = state.to_open.back();
    state.to_open.pop_back();
    open(state, node);
    if (should_stop && should_stop()) return false;
  }
  state.descending = false;
  return true;
}

/// Upward and downward passes until nothing is bent. False when it was stopped.
bool go_on(State& state, int& redone, const std::function<bool()>& should_stop) {
  while (!state.is_clean()) {
    if (++state.rounds > state.options.max_rounds) {
      throw core::NumericalError("atlas: not settled after " + std::to_string(state.options.max_rounds) + " rounds");
    }
    if (!sweep(state, redone, should_stop)) {
      --state.rounds;
      return false;
    }
  }
  state.rounds = 0;
  return true;
}

void settle_near(State& state, int& redone) {
  State damped = state;
  try {
    go_on(state, redone, {});
  } catch (const core::NumericalError&) {
    settle_damped(damped, redone);
    state = damped;
  }
}

}  // namespace

bool redo_dirty(State& state, int& redone, const std::function<bool()>& should_stop) {
  Workspace workspace;
  return redo(state, state.root, workspace, redone, should_stop);
}

void linearise_in_place(State& state) {
  int redone = 0;
  redo_dirty(state, redone, {});
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    TreeNode& node = state.nodes.write(i);
    const FrontShape& shape = *node.shape;
    node.fresh = false;
    node.opened_at = std::make_shared<const Values>(
        values_of(state, shape, shape.eliminated, static_cast<int>(shape.variables.size())));
  }
}

/// If the ordinary passes find no solution, it is sought again by shortened steps, from where settling began and not from where
/// the passes went astray.
bool Atlas::settle(const std::function<bool()>& should_stop) {
  if (working_->root < 0) return true;
  if (working_->begun == nullptr) working_->begun = std::make_shared<const State>(*working_);
  const std::shared_ptr<const State> begun = working_->begun;
  try {
    if (!go_on(*working_, nodes_redone_, should_stop)) return false;
  } catch (const core::NumericalError&) {
    *working_ = *begun;
    State damped = *begun;
    damp(damped, nodes_redone_);
    settle_near(damped, nodes_redone_);
    *working_ = damped;
  } catch (...) {
    *working_ = *begun;
    throw;
  }
  working_->begun = nullptr;
  *settled_ = *working_;
  return true;
}

bool Atlas::is_settled() const { return working_->is_clean(); }

}  // namespace helixnav::atlas
