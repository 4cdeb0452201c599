// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "helixnav/core/recording.hpp"
#include "helixnav/runs/report_frame.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::evaluation {

/// A true pose and the estimate of its time.
struct PosePair {
  core::TruePose known;
  core::PoseGaussian estimate;
  runs::ReportFrame frame;
  /// Where the vehicle truly was in the frame in which the estimate was reported, by the truth since that frame's begin: what the
  /// covariance is of. Nothing where the truth does not say it.
  std::optional<core::Pose2> known_in_frame;
};

/// Those of the poses that lie within the steps' time and in no gap between them (is_in_gap). frames: [step] of runs::report_frames. The first true pose of a frame of its own counts as its begin where it lies within its first step.
std::vector<PosePair> pose_pairs(const std::vector<core::StepReport>& steps, const std::vector<core::TruePose>& poses,
                                 const std::vector<runs::ReportFrame>& frames);

}  // namespace helixnav::evaluation
