// SPDX-License-Identifier: BSD-3-Clause
#include "loop/recover.hpp"

#include <new>
#include <utility>
#include <variant>

namespace helixnav::supervisor {

const Checkpoint& NavigationLoop::checkpoint() const {
  const Searching* open = searching();
  return open != nullptr ? open->trigger : *std::get<Mapping>(mode_).trusted;
}

/// What only an undone call would have needed is let go.
void NavigationLoop::commit() {
  undo_ = Undo{};
  try {
    belief_.filter.keep_since(checkpoint().filter.phase);
  } catch (const std::bad_alloc&) {
    // The closed phases stay as they are, which is as exact, and are absorbed at the next occasion.
  }
  tape_.settle(checkpoint().position);
}

/// Back to the checkpoint, and what came since once more: everything is as before the call, whose motion is pending again.
void NavigationLoop::recover() {
  Undo undo = std::exchange(undo_, Undo{});
  if (undo.filter) belief_.filter = std::move(*undo.filter);
  if (undo.mode) mode_ = std::move(*undo.mode);
  searches_ = undo.searches;
  const Checkpoint from = checkpoint();
  std::vector<Tape::Entry> since = tape_.cut(from.position);
  if (undo.rolled_back) since = std::move(*undo.rolled_back);
  since.resize(undo.tape_end - from.position);
  roll_back(from, belief_);
  if (Searching* open = searching()) {
    open->search = search_from(from);
  } else {
    Mapping& mapping = std::get<Mapping>(mode_);
    mapping.monitor = mapping.monitor_when_trusted;
  }
  pending_ = {};
  for (const Tape::Entry& entry : since) {
    if (const auto* motion = std::get_if<Tape::Motion>(&entry)) {
      pending_.motion = motion->odometry;
      pending_.driven_m = motion->driven_m;
    } else if (const auto* fix = std::get_if<Tape::Fix>(&entry)) {
      use_fix(fix->fix);
    } else if (const auto* scan = std::get_if<Tape::Scan>(&entry)) {
      step(scan->scan);
    }
  }
  pending_ = std::move(undo.pending);
}

}  // namespace helixnav::supervisor
