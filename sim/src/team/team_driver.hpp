// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "helixnav/core/events.hpp"
#include "helixnav/core/random.hpp"
#include "scanner.hpp"
#include "team_scene.hpp"

namespace helixnav::sim {

inline constexpr double team_period_s = 1.0;  ///< of odometry and scans

/// The scanner that every robot has.
Scenario team_scanner(const TeamScene& scene, double clutter_per_scan);

/// One robot of a team driving on its circle.
class TeamDriver {
 public:
  TeamDriver(const TeamScene& scene, std::size_t robot, const Scenario& scanner, const World& world,
             std::uint64_t seed);

  const core::Pose2& pose() const { return pose_; }

  /// Drives for one period. Measured speed and turn rate are the true ones with noise; the truth is exactly on the
  /// circle.
  core::Odometry move(core::Nanoseconds t_ns);

  LabelledScan scan(core::Nanoseconds t_ns) { return scanner_.look(pose_, 0.0, t_ns); }

  /// Another robot, if it is in view and detected.
  std::optional<core::Observation> look_at(const Eigen::Vector2d& point_m);

 private:
  double turn_rate_;
  double reach_m_;
  core::Pose2 pose_;
  core::RandomStream odometry_, others_;
  Scanner scanner_;
};

}  // namespace helixnav::sim
