// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/joint_map.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/supervisor/navigator.hpp"

namespace helixnav::apps {

/// Whether the start that a session was given on an earlier map is right. Where landmarks repeat, a start that is wrong by one row or
/// one tree fits, too, and nothing in the gates contradicts it. So a second navigator is fed with the same drive without being
/// told the place, and looks for it on the map as a session with an unknown start does; what it finds has no rival. It calls the given
/// start its own, so that both tell their path in the same coordinates until then. Costs as much as the session itself, for
/// thirty reaches of the sensor at most. Test: apps/start_check_test.cpp.
class StartCheck {
 public:
  StartCheck(const core::JointMap& map, const core::Pose2& T_map_start, double reach_m,
             const supervisor::NavigatorOptions& options);

  /// The session's pose, relative to the landmarks of the map around it; asked for when the place is found.
  using Believed = std::function<core::PoseGaussian()>;

  /// An event that the session has taken, with its report if it is a scan, and the pose after it.
  void take(const core::Event& event, const core::StepReport* report, const Believed& believed);

  /// The place was found, or it is time to stop looking.
  bool is_over() const { return is_over_; }

  /// The place was asked for and not found: what was seen fits several places, the start that was given perhaps among them.
  bool is_ambiguous() const { return is_ambiguous_; }

  /// The place was found, and the session is elsewhere: the second navigator and its report of the scan taken last, with all scans so
  /// far revised. Otherwise nothing.
  struct RightStart {
    supervisor::Navigator navigator;
    core::StepReport report;
  };
  std::optional<RightStart> right_start();

 private:
  void observe(core::StepReport report, const Believed& believed);
  bool is_elsewhere(const core::PoseGaussian& believed) const;

  core::LandmarkId next_name_;  ///< of the map
  double reach_m_;
  double apart_m_, apart_rad_;  ///< of two hypotheses of one place
  supervisor::Navigator navigator_;
  std::vector<core::RevisedScan> revised_;  ///< [scan] as the second navigator associated it …
  std::vector<core::StampedPose> path_;     ///< … and where
  std::optional<core::StepReport> report_;  ///< with which it found the place elsewhere
  double driven_m_ = 0.0;
  bool is_over_ = false;
  bool is_ambiguous_ = false;
};

}  // namespace helixnav::apps
