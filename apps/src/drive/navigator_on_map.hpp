// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "drive.hpp"
#include "given_map.hpp"
#include "helixnav/localization/localizer.hpp"
#include "helixnav/localization/lost_monitor.hpp"
#include "helixnav/supervisor/navigator.hpp"
#include "start_check.hpp"

namespace helixnav::apps {

/// Reports where on a given map the vehicle is. As long as observations confirm it, that is an EKF of the pose alone on the map's landmarks,
/// which uses each of them in every scan (localization::Localizer). Beside it, and in its place once nothing has confirmed the pose over a
/// reach, a navigator takes the map as it is drawn (supervisor::as_drawn) and maps for itself what the map does not contain: so it has all of
/// mapping's protection against wrong matches, slips and carrying. Reports name landmarks of the given map only. A given start that the
/// observations contradict before anything has confirmed it is dropped, and the place is searched for; so is one where the
/// place is found elsewhere (StartCheck). Fixes are not used. The job must outlive it. Test: apps/navigator_on_map_test.cpp.
class NavigatorOnMap {
 public:
  NavigatorOnMap(const Drive& job, std::vector<std::vector<core::Label>> labels_fed, LabelAgreement& agreement);

  std::optional<core::StepReport> take(const core::Event& event);
  /// See StartCheck.
  bool is_start_ambiguous() const { return is_start_ambiguous_; }
  core::PoseGaussian pose() const { return tracker_ ? tracker_->pose() : navigator_.pose(); }

 private:
  /// The estimate itself: pose() says more if nothing ties that to the map.
  core::PoseGaussian believed() const { return tracker_ ? tracker_->pose() : navigator_.filter().pose(); }
  core::StepReport observe(const core::Scan& scan);
  bool knows_better(const core::StepReport& navigated, const core::StepReport& tracked);
  core::StepReport begin_anew(const core::Scan& scan, const core::StepReport& report);
  std::optional<core::StepReport> checked_start(const core::Event& event, const core::StepReport& report);
  void track_from(const core::PoseGaussian& pose);
  core::StepReport on_map(core::StepReport report);
  bool is_given(core::LandmarkId id) const;
  void leave_own_out(std::vector<core::AssociationReport>& associations) const;

  const Drive& job_;
  std::vector<std::vector<core::Label>> labels_of_;
  LabelAgreement& agreement_;
  core::JointMap map_;  ///< as drawn
  double reach_m_;
  supervisor::Navigator navigator_;
  bool is_placed_;  ///< the navigator is on the map
  std::optional<localization::Localizer> tracker_;
  localization::LostMonitor monitor_;  ///< of the reported pose
  bool is_start_in_doubt_;
  std::optional<StartCheck> check_;
  bool is_start_ambiguous_ = false;
  int better_scans_ = 0;   ///< consecutive, explained from the navigator's pose and not from the tracked one
  double driven_m_ = 0.0;  ///< since the last scan
  std::size_t scans_ = 0;
};

}  // namespace helixnav::apps
