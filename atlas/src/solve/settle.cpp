// SPDX-License-Identifier: BSD-3-Clause
#include "solve/settle.hpp"

#include <memory>
#include <string>

#include "helixnav/core/errors.hpp"
#include "solve/eliminate.hpp"

namespace helixnav::atlas {
namespace {

bool redo(State& state, int id, Workspace& workspace, int& redone, const std::function<bool()>& should_stop) {
  if (!state.node(id).dirty) return true;
  if (!state.is_leaf(id)) {
    for (const int child : state.node(id).child) {
      if (!redo(state, child, workspace, redone, should_stop)) return false;
    }
  }
  eliminate(state, id, workspace);
  ++redone;
  return !should_stop || !should_stop();
}

/// One way up and one way down. False when it was stopped.
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

}  // namespace

bool redo_dirty(State& state, int& redone, const std::function<bool()>& should_stop) {
  Workspace workspace;
  return redo(state, state.root, workspace, redone, should_stop);
}

bool Atlas::settle(const std::function<bool()>& should_stop) {
  if (working_->root < 0) return true;
  const State before = *working_;
  try {
    while (!working_->is_clean()) {
      if (++working_->rounds > working_->options.max_rounds) {
        throw core::NumericalError("atlas: not settled after " + std::to_string(working_->options.max_rounds) +
                                   " rounds");
      }
      if (!sweep(*working_, nodes_redone_, should_stop)) {
        --working_->rounds;
        return false;
      }
    }
  } catch (...) {
    *working_ = before;
    throw;
  }
  working_->rounds = 0;
  *settled_ = *working_;
  return true;
}

bool Atlas::is_settled() const { return working_->is_clean(); }

}  // namespace helixnav::atlas
