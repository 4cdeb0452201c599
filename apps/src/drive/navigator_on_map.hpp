// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "drive.hpp"
#include "given_map.hpp"
#include "helixnav/localization/lost_monitor.hpp"
#include "helixnav/supervisor/navigator.hpp"

namespace helixnav::apps {

/// A navigator that says where on a given map the vehicle is. It takes the map as it is drawn (supervisor::as_drawn) and maps beside
/// it what it holds no landmark of, for itself: so it has all that mapping has against wrong matches, slips and carrying. Its
/// reports name landmarks of the given map only. A start that was said, and that what is seen contradicts before anything has confirmed
/// it, is forgotten: the vehicle looks for its place as one that was carried. Fixes are not used. The job must outlive it.
class NavigatorOnMap {
 public:
  NavigatorOnMap(const Drive& job, std::vector<std::vector<core::Label>> labels_fed, LabelAgreement& agreement);

  std::optional<core::StepReport> take(const core::Event& event);
  core::PoseGaussian pose() const { return navigator_.pose(); }

 private:
  void doubt_start(const core::Scan& scan, const core::StepReport& report);
  core::StepReport on_map(core::StepReport report);
  bool is_given(core::LandmarkId id) const;
  void leave_own_out(std::vector<core::AssociationReport>& associations) const;

  const Drive& job_;
  std::vector<std::vector<core::Label>> labels_of_;
  LabelAgreement& agreement_;
  supervisor::Navigator navigator_;
  bool is_placed_;                                  ///< it is known where on the map the vehicle is
  std::optional<localization::LostMonitor> start_;  ///< while nothing has confirmed it
  double driven_m_ = 0.0;                           ///< since the last scan
  std::size_t scans_ = 0;
};

}  // namespace helixnav::apps
