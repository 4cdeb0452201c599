// SPDX-License-Identifier: BSD-3-Clause
#include "loop/recover.hpp"

#include <algorithm>
#include <new>
#include <optional>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "loop/process_again.hpp"

namespace helixnav::supervisor {

const Checkpoint& NavigationLoop::checkpoint() const {
  const Searching* open = searching();
  return open != nullptr ? open->trigger : *std::get<Mapping>(mode_).trusted;
}

/// On the tape: for rolling back, and to learn from the present stretch of road, unless the vehicle stays on it for long.
Tape::Position NavigationLoop::oldest_needed() const {
  constexpr Tape::Position most_entries = 2000;
  const Tape::Position position = checkpoint().position;
  const std::optional<Tape::Position>& begun = noise_.systematic.begun;
  return begun && *begun + most_entries > tape_.end() ? std::min(position, *begun) : position;
}

/// Frees what only an undone call would have needed.
void NavigationLoop::commit() {
  undo_ = Undo{};
  try {
    belief_.filter.keep_since(checkpoint().filter.phase);
  } catch (const std::bad_alloc&) {
    // The closed phases stay as they are, which is just as exact, and are absorbed at the next opportunity.
  }
  const bool is_long = tape_.stops() > options_.search.smooth_up_to_scans || !tape_.holds_since(0);
  if (belief_.drive && is_long) tape_.hand_on(belief_.drive->end());
  forget_old_placing();
  tape_.settle(oldest_needed());
  thin_coverage();
}

/// Thins the poses on ground that was covered before, where nothing goes back to them any more.
void NavigationLoop::thin_coverage() {
  if (searching() != nullptr || apart_.any()) return;
  const auto left_open = [this](double path_m) {
    return std::any_of(belief_.left_open.begin(), belief_.left_open.end(), [&](const LeftOpen& open) {
      return open.begun_path_m <= path_m && path_m <= open.ended_path_m;
    });
  };
  const double asked_about_m = options_.search.old_after_m + options_.search.undecided_m;
  try {
    belief_.coverage.thin_before(checkpoint().existence.path_m() - asked_about_m, left_open);
  } catch (const std::bad_alloc&) {
    // Stays as it is until the next call.
  }
}

/// Rolls back to the checkpoint and processes what came since again: all is as before the call, its motion pending again.
void NavigationLoop::recover() {
  Undo undo = std::exchange(undo_, Undo{});
  if (undo.filter) belief_.filter = std::move(*undo.filter);
  if (undo.drive) std::tie(belief_.drive, belief_.window) = std::move(*undo.drive);
  if (undo.mode) mode_ = std::move(*undo.mode);
  if (undo.trusted) {
    Mapping& mapping = std::get<Mapping>(mode_);
    mapping.trusted = std::move(undo.trusted->checkpoint);
    mapping.monitor_when_trusted = std::move(undo.trusted->monitor);
  }
  if (undo.tape) tape_ = std::move(*undo.tape);
  searches_ = undo.searches;
  const Checkpoint from = checkpoint();
  std::vector<Tape::Entry> since = tape_.cut(from.position);
  if (undo.rolled_back) since = std::move(*undo.rolled_back);
  since.resize(undo.tape_end - from.position);
  roll_back(from, belief_);
  if (Searching* open = searching()) {
    open->is_over = false;
    open->search = search_from(from.existence, open->search.old_landmarks());
    questions_ = open->questions_before;
  } else {
    Mapping& mapping = std::get<Mapping>(mode_);
    mapping.monitor = mapping.monitor_when_trusted;
  }
  pending_ = {};
  process_again(
      since, [](const Tape::Fix&, bool) {}, [](const core::StepReport&) {});
  belief_.filter.take_health();  // of the failed call, and of what was reported before
  std::swap(noise_, noise_before_);
  std::swap(questions_, questions_before_);
  pending_ = std::move(undo.pending);
}

}  // namespace helixnav::supervisor
