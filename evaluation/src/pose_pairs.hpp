// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "helixnav/core/recording.hpp"
#include "helixnav/runs/report_frame.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::evaluation {

/// A true pose and the estimate at its time.
struct PosePair {
  core::TruePose known;
  core::PoseGaussian estimate;
  runs::ReportFrame frame;
  /// The vehicle's true pose in the frame in which the estimate was reported, from the truth since the start of that
  /// frame: what the covariance refers to. Nothing if the truth does not cover it.
  std::optional<core::Pose2> known_in_frame;
};

/// The true poses at the scans, interpolated, where there are more of them than scans: between scans the estimate is an interpolation,
/// which turns at another time than the vehicle did. Otherwise the poses as they are. In order of time.
std::vector<core::TruePose> poses_to_judge(const std::vector<core::StepReport>& steps,
                                           const std::vector<core::TruePose>& poses);

/// The poses within the time of the steps and in no gap between them (is_in_gap). frames: [step] from
/// runs::report_frames. The first true pose of a separate frame counts as its start if it is within its first step.
std::vector<PosePair> pose_pairs(const std::vector<core::StepReport>& steps, const std::vector<core::TruePose>& poses,
                                 const std::vector<runs::ReportFrame>& frames);

}  // namespace helixnav::evaluation
