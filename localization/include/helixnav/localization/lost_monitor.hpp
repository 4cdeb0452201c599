// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/core/events.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::localization {

/// Detects that a vehicle is not where on a map it is believed to be, for example not at its given start. A look is a
/// scan taken at least a 30th of the reach from the one before. Either nearly all landmarks of the map that should be
/// seen are missing: a look that sees at most a fifth of three or more adds ln(P(missed | elsewhere) / P(missed | here))
/// for each one missed, a look that sees half of them resets the sum, and 20 nats over a third of the reach mean lost. Or
/// the vehicle has driven twice the reach since the last look that confirmed its place, and things that are not on the
/// map were seen in five looks. Neither tells where the vehicle is.
/// Test: localization/lost_monitor_test.cpp.
class LostMonitor {
 public:
  /// The map's landmarks, and how far the sensor sees them.
  LostMonitor(const std::vector<core::MapLandmark>& map, double reach_m);

  /// One scan and what became of it; driven_m: since the previous scan.
  void observe(const core::Scan& scan, const core::StepReport& report, double driven_m);

  bool is_lost() const;

  /// Whether a look has confirmed the place since the start or since reset(); and how far the vehicle has driven since
  /// the last such look.
  bool is_confirmed() const { return is_confirmed_; }
  double since_confirmed_m() const { return since_confirmed_m_; }

  /// The place is known again.
  void reset();

 private:
  int count_expected(const core::Scan& scan, const core::Pose2& T_world_robot) const;

  std::vector<Eigen::Vector2d> points_m_;
  double reach_m_;
  double since_look_m_;
  double since_confirmed_m_ = 0.0;
  double missing_nats_ = 0.0;
  int looks_at_unknown_ = 0;
  bool is_confirmed_ = false;
};

}  // namespace helixnav::localization
