// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/odometry.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::apps {

/// Where the vehicle is at a scan withheld from the estimator: the last estimate and the odometry since.
class DeadReckoning {
 public:
  void move(const core::Odometry& odometry) { since_ = core::chain(since_, odometry); }

  /// The estimator has taken in all motion so far.
  void absorbed() { since_ = core::no_motion(0); }

  /// The step of such a scan: `estimate` moved on, mode and counts as in the step before, nothing seen and nothing done.
  core::StepReport report(core::Nanoseconds t_ns, const core::PoseGaussian& estimate,
                          const core::StepReport& before) const {
    core::StepReport report;
    report.t_ns = t_ns;
    report.mode = before.mode;
    report.active_landmarks = before.active_landmarks;
    report.mapped_landmarks = before.mapped_landmarks;
    const core::Odometry pose = core::chain({t_ns, estimate.mean, estimate.covariance}, since_);
    report.pose = {pose.T_before_after, pose.covariance};
    return report;
  }

 private:
  core::Odometry since_ = core::no_motion(0);
};

}  // namespace helixnav::apps
