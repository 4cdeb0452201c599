// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "helixnav/core/events.hpp"
#include "helixnav/logs/mrclam.hpp"
#include "mrclam/mrclam_tables.hpp"

namespace helixnav::logs {

/// Integrates velocity commands, each held until the next one; before the first it stands still.
class CommandMotion {
 public:
  CommandMotion(const std::vector<MrclamTables::Command>& commands, const MrclamSettings& settings)
      : commands_(commands), settings_(settings), now_ns_(commands.front().t_ns) {}

  /// The increment from the end of the previous one until t_ns; t_ns never goes back.
  core::Odometry until(core::Nanoseconds t_ns);

 private:
  core::Odometry held(const MrclamTables::Command& command, core::Nanoseconds until_ns) const;

  const std::vector<MrclamTables::Command>& commands_;
  const MrclamSettings& settings_;
  core::Nanoseconds now_ns_;
  std::size_t next_ = 0;  ///< command that is not yet in force
};

}  // namespace helixnav::logs
