// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "helixnav/cekf/match.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::supervisor {

/// All that the filter was told since the start, with the landmark that each observation was attributed to, so that the
/// drive can be solved as a whole. Knows which landmarks have turned out to be one since.
/// Memory: about 200 bytes a scan and 200 an observation used, never more than for the stops allowed: beyond them, or
/// when the filter was told what a log cannot say, everything is let go for good. Test: supervisor/smooth_drive_test.cpp.
class DriveLog {
 public:
  /// A place where something may have been observed, and how the vehicle came there from the one before.
  struct Stop {
    std::optional<core::Odometry> motion;
    std::vector<cekf::Match> seen;  ///< matched and augmented alike
    std::optional<core::AbsoluteFix> fix;
    double cost = 0.0;  ///< νᵀS⁻¹ν of the update made with it
  };

  DriveLog(const core::PoseGaussian& start, int most_stops) : start_(start), most_stops_(most_stops) {}

  void predict(const core::Odometry& odometry);
  void fix(const core::AbsoluteFix& fix, double nis);
  /// One scan after the filter was updated and augmented by it.
  void observe(const core::Scan& scan, const core::StepReport& report);
  /// What a closing made one, and what it cost (J).
  void close(const std::vector<core::MergedLandmarks>& merged, double cost);
  /// The filter is again as it was after scan number `step`, counted from 0.
  void back_to(std::int64_t step);
  /// The drive was solved: this is what its measurements cost now.
  void settle(double cost) { cost_ = cost; }
  void let_go();

  bool empty() const { return stops_.empty(); }
  const core::PoseGaussian& start() const { return start_; }
  const std::vector<Stop>& stops() const { return stops_; }
  /// Since the last stop.
  const std::optional<core::Odometry>& motion() const { return motion_; }
  /// The landmark that `id` is now.
  core::LandmarkId present(core::LandmarkId id) const;
  /// Σ νᵀS⁻¹ν of the updates and closings: for a linear filter the least cost that any drive and map can have.
  double cost() const { return cost_; }

 private:
  void stop(Stop&& next);

  core::PoseGaussian start_;
  int most_stops_;
  std::optional<core::Odometry> motion_;
  std::vector<Stop> stops_;
  std::int64_t scans_ = 0;  ///< among the stops
  std::map<core::LandmarkId, core::LandmarkId> kept_of_;
  double cost_ = 0.0;
};

}  // namespace helixnav::supervisor
