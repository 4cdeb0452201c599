// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <variant>
#include <vector>

#include "helixnav/core/events.hpp"
#include "helixnav/core/recording.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/supervisor/navigator.hpp"

namespace helixnav::apps {

/// The navigator as core::EventLoop wants it. With labels, one list a scan, they are its identities: association is known.
class NavigatorFeed {
 public:
  explicit NavigatorFeed(supervisor::Navigator& navigator) : navigator_(navigator) {}
  NavigatorFeed(supervisor::Navigator& navigator, const std::vector<std::vector<core::Label>>& labels)
      : navigator_(navigator), labels_(&labels) {}

  std::optional<core::StepReport> take(const core::Event& event) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) navigator_.move(*odometry);
    if (const auto* fix = std::get_if<core::AbsoluteFix>(&event)) navigator_.fix(*fix);
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) return std::nullopt;
    const std::size_t k = scans_++;
    return labels_ != nullptr ? navigator_.observe(*scan, labels_->at(k)) : navigator_.observe(*scan);
  }

 private:
  supervisor::Navigator& navigator_;
  const std::vector<std::vector<core::Label>>* labels_ = nullptr;
  std::size_t scans_ = 0;
};

}  // namespace helixnav::apps
