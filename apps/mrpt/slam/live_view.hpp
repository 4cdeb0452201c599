// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>

#include "helixnav/mrpt_adapter/map_builder.hpp"
#include "slam/live_window.hpp"
#include "slam/slam_config.hpp"

namespace helixnav::apps {

/// The window that shows the map while it is built, if SHOW_3D_LIVE asks for one and there is a display.
class LiveView {
 public:
  explicit LiveView(const SlamConfig& config);

  /// At most 20 times a second and for a tenth of the time, or when it must.
  void show(const mrpt_adapter::MapBuilder& builder, std::size_t step, bool must);

 private:
  bool follows_robot_;
  std::unique_ptr<LiveWindow> window_;
  std::optional<std::chrono::steady_clock::time_point> shown_;
  double pause_s_ = 0.0;
};

}  // namespace helixnav::apps
