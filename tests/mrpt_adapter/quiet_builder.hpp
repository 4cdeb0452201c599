// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "frames.hpp"
#include "helixnav/core/odometry.hpp"
#include "helixnav/core/recording.hpp"
#include "helixnav/mrpt_adapter/map_builder.hpp"
#include "helixnav/mrpt_adapter/run_access.hpp"

namespace helixnav::mrpt_adapter::testing {

/// A builder that records its log without printing it.
class QuietBuilder : public MapBuilder {
 public:
  explicit QuietBuilder(const MapBuilderOptions& its_options = {}) : MapBuilder(its_options) {
    logging_enable_console_output = false;
    logging_enable_keep_record = true;
  }
  std::string said() const { return getLogAsString(); }
};

/// Feeds a recording as pairs of action and frame; calls look(scan, index) after each scan, until it returns false.
template <class Look>
void drive(MapBuilder& builder, const core::Recording& recording, bool by_name, const Look& look) {
  std::optional<core::Odometry> motion;
  std::size_t scans = 0;
  for (const core::Event& event : recording.events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
      motion = motion ? core::chain(*motion, *odometry) : *odometry;
    } else if (const auto* scan = std::get_if<core::Scan>(&event)) {
      CActionCollection actions = motion ? action_of(*motion) : CActionCollection();
      CSensoryFrame frame = frame_of(*scan, by_name ? recording.labels[scans] : std::vector<std::int64_t>());
      builder.processActionObservation(actions, frame);
      motion.reset();
      if (!look(*scan, scans)) return;
      ++scans;
    }
  }
}

}  // namespace helixnav::mrpt_adapter::testing
