// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "helixnav/association/associate.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/map_appearance.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::localization {

struct LocalizerOptions {
  association::Method method = association::Method::likelihood_ratio;
  association::Options association;
  association::Gates gates;
  double extraneous_per_scan =
      1.0;                        ///< observations not of a landmark of the map; used if the field of view is bounded
  double candidate_sigmas = 4.0;  ///< how far the search for candidates reaches
};

/// EKF over the pose alone, in a given map: every scan is associated with the map and updates the pose; the map stays
/// as it is. The landmarks' positions are taken as exact: what a scan measures is where the robot is relative to them,
/// and the error they have in common is the frame's, not the robot's.
/// Map frame, covariances in (x, y, heading) [m, m, rad]. Cost of a scan of m observations: O(m · landmarks) to find
/// candidates, O(m³) to update. Every call either succeeds or throws PreconditionError (what core::check rejects, an
/// event that goes back in time, arguments) or NumericalError (S not positive definite, a pose that is not finite) and
/// leaves the localizer as it was, even if memory runs out.
/// Source: dlr_kurlbaum2009 §3.4 (EKF localiser using the calculated map). Test: localization/localizer_test.cpp
/// (information-form twin, NEES and NIS in their bands), localization/bad_input_test.cpp, tests/faults.
class Localizer {
 public:
  /// Ids in the map must be distinct. The start is the pose of the robot in the map frame.
  Localizer(const core::PoseGaussian& start, const std::vector<core::MapLandmark>& map,
            const LocalizerOptions& options = {});

  /// Accumulates motion; it is applied to the pose with the next scan (exact, see core::chain).
  void move(const core::Odometry& odometry);

  /// One scan, association unknown. Observations that do not belong to a landmark of the map are rejected.
  core::StepReport observe(const core::Scan& scan);

  /// One scan whose landmarks are known, core::no_landmark for an observation of something not in the map.
  /// PreconditionError, with everything as it was, unless there is one per observation and the map has it.
  core::StepReport observe(const core::Scan& scan, const std::vector<core::LandmarkId>& landmarks);

  core::PoseGaussian pose() const { return pose_; }

 private:
  void check_event(const core::Scan& scan) const;
  core::PoseGaussian predicted() const;
  core::JointGaussian candidates(const core::PoseGaussian& pose, const core::Scan& scan) const;
  /// What became of the observations, and whether the search was ended early.
  struct Associated {
    std::vector<core::AssociationReport> reports;
    std::vector<core::Decision> decisions = {};
  };
  Associated associate(const core::PoseGaussian& pose, const core::Scan& scan) const;
  core::StepReport update(const core::PoseGaussian& pose, const core::Scan& scan, Associated associated);
  core::StepReport update_thinned(const core::PoseGaussian& pose, const core::Scan& thin, Associated associated,
                                  const std::vector<std::size_t>& used, std::size_t observations);

  LocalizerOptions options_;
  core::PoseGaussian pose_;
  std::map<core::LandmarkId, Eigen::Vector2d> map_m_;
  core::MapAppearance appearance_;
  std::optional<core::Odometry> motion_;  ///< since the last scan
  std::int64_t step_ = 0;
  core::Nanoseconds last_ns_;  ///< of the last event
};

}  // namespace helixnav::localization
