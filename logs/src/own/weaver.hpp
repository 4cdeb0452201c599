// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "helixnav/core/events.hpp"
#include "motion.hpp"

namespace helixnav::logs {

/// Turns motions and scans in time order into events: before a scan, the motion since the previous one as one
/// increment. Used for whole logs and streams. Test: logs/own/own_recording_test.cpp, logs/own/own_stream_test.cpp.
class Weaver {
 public:
  Weaver(const core::Pose2& T_vehicle_odometry, std::vector<core::Event>& events)
      : T_vehicle_odometry_(T_vehicle_odometry), events_(events) {}

  /// Moves on to t_ns, as far as the motion goes there.
  void move(const Motion& motion, core::Nanoseconds t_ns);

  /// The motion so far, then the scan.
  void add(core::Scan scan);

  /// The motion so far, then the event that the vehicle was carried.
  void lose(core::Nanoseconds t_ns);

  /// The motion so far.
  void flush();

 private:
  void append(const core::Odometry& part);

  core::Pose2 T_vehicle_odometry_;
  std::vector<core::Event>& events_;
  std::optional<core::Nanoseconds> now_ns_;
  std::optional<core::Odometry> pending_;
};

}  // namespace helixnav::logs
