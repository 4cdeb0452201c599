// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <optional>

#include "helixnav/core/events.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::apps {

/// An estimator whose responses are timed by the wall clock.
template <typename Estimator>
class Timed {
 public:
  explicit Timed(Estimator& estimator) : estimator_(estimator) {}

  std::optional<core::StepReport> take(const core::Event& event) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begin = Clock::now();
    std::optional<core::StepReport> step = estimator_.take(event);
    last_s_ = std::chrono::duration<double>(Clock::now() - begin).count();
    return step;
  }

  /// The time taken by the last event.
  double last_s() const { return last_s_; }

 private:
  Estimator& estimator_;
  double last_s_ = 0.0;
};

}  // namespace helixnav::apps
