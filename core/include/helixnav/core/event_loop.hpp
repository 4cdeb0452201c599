// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::core {

/// The loop over the events of a drive. The estimator is anything with
///   std::optional<StepReport> take(const Event&)
/// that returns its step for a scan. The caller decides when to stop, and sees the estimator as it was after each:
///   EventLoop loop(recording.events, estimator);
///   while (const auto step = loop.next()) …
/// Events and estimator must outlive the loop. A live drive comes in parts: a loop for each, numbering on with `first_step`.
/// Test: core/event_loop_test.cpp.
template <typename Estimator>
class EventLoop {
 public:
  EventLoop(const std::vector<Event>& events, Estimator& estimator, std::int64_t first_step = 0)
      : events_(events), estimator_(estimator), steps_(first_step) {}

  /// Feeds the events up to and including the next one that makes a step; nothing when none is left. Steps are numbered
  /// as they come. NumericalError and PreconditionError of the estimator pass with step and time before their text.
  std::optional<StepReport> next() {
    while (fed_ < events_.size()) {
      std::optional<StepReport> step = take(events_[fed_++]);
      if (!step) continue;
      step->step = steps_++;
      return step;
    }
    return std::nullopt;
  }

  /// How many events were fed; after a step, the event before this number made it.
  std::size_t fed() const { return fed_; }

  /// Number of the next step: how many were made since step 0.
  std::int64_t steps() const { return steps_; }

 private:
  std::optional<StepReport> take(const Event& event) {
    try {
      return estimator_.take(event);
    } catch (const NumericalError& error) {
      throw NumericalError(here(event) + error.what());
    } catch (const PreconditionError& error) {
      throw PreconditionError(here(event) + error.what());
    }
  }

  std::string here(const Event& event) const {
    return "step " + std::to_string(steps_) + ", t = " + std::to_string(1e-9 * static_cast<double>(time_of(event))) +
           " s: ";
  }

  const std::vector<Event>& events_;
  Estimator& estimator_;
  std::size_t fed_ = 0;
  std::int64_t steps_;
};

}  // namespace helixnav::core
