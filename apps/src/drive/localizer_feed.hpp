// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "drive.hpp"
#include "helixnav/localization/localizer.hpp"
#include "helixnav/supervisor/navigator.hpp"

namespace helixnav::apps {

/// The localizer as core::EventLoop expects it, for logs that name landmarks and for maps too large for NavigatorOnMap. If it is
/// told that the vehicle was carried, it has a navigator build its own map from there and query the given map; once that has found
/// its place, localisation continues from there. Fixes are not used. The job must outlive it.
class LocalizerFeed {
 public:
  LocalizerFeed(const Drive& job, std::vector<std::vector<core::Label>> labels_fed, LabelAgreement& agreement);

  std::optional<core::StepReport> take(const core::Event& event);
  core::PoseGaussian pose() const { return localizer_ ? localizer_->pose() : finder_->pose(); }

 private:
  void begin_to_look();
  void lose();
  core::StepReport observe(const core::Scan& scan, std::size_t i);
  core::StepReport localize(const core::Scan& scan, std::size_t i);
  void take_place(core::StepReport&& found, core::StepReport& report);

  const Drive& job_;
  std::vector<std::vector<core::Label>> labels_of_;
  LabelAgreement& agreement_;
  std::optional<localization::Localizer> localizer_;  ///< none while the place is unknown
  std::optional<supervisor::Navigator> finder_;       ///< while it is
  std::size_t scans_ = 0;
  std::vector<core::CarriedDecision> carried_;  ///< since the last scan
  double driven_in_part_m_ = 0.0;
  int part_ = 0, next_part_ = 1;  ///< of the drive, as of core::CarriedDecision
};

}  // namespace helixnav::apps
