// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "dead_reckoning.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::apps {

/// An estimator from which the scans of a blackout are withheld; each is replaced by a step of dead reckoning.
template <typename Estimator>
class Withholding {
 public:
  /// `withheld` is [scan], empty: none. `pose` gives the estimator's pose at its last scan or fix.
  Withholding(Estimator& estimator, const std::vector<bool>& withheld, std::function<core::PoseGaussian()> pose)
      : estimator_(estimator), withheld_(withheld), pose_(std::move(pose)) {}

  std::optional<core::StepReport> take(const core::Event& event) {
    if (withheld_.empty()) return estimator_.take(event);
    if (const auto* scan = std::get_if<core::Scan>(&event)) {
      last_was_withheld_ = withheld_[scans_++];
      if (last_was_withheld_) return last_ = reckoning_.report(scan->t_ns, pose_(), last_);
    }
    const std::optional<core::StepReport> step = estimator_.take(event);
    const auto* odometry = std::get_if<core::Odometry>(&event);
    odometry != nullptr ? reckoning_.move(*odometry) : reckoning_.absorbed();
    if (step) last_ = *step;
    return step;
  }

  bool last_scan_was_withheld() const { return last_was_withheld_; }

 private:
  Estimator& estimator_;
  const std::vector<bool>& withheld_;
  std::function<core::PoseGaussian()> pose_;
  DeadReckoning reckoning_;
  core::StepReport last_;
  std::size_t scans_ = 0;
  bool last_was_withheld_ = false;
};

}  // namespace helixnav::apps
