// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/decision.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/supervisor/slip_options.hpp"

namespace helixnav::supervisor {

/// An observation of a landmark, as a slip explains it.
struct SlipPair {
  int observation = 0;  ///< index in the scan
  core::LandmarkId landmark = core::no_landmark;
  double nis = 0.0;  ///< of the pair at the displacement found, landmark and observation alone
};

/// A slip that is believed.
struct Slip {
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  ///< (m, m, rad) in the frame of the predicted vehicle
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();    ///< of the unmeasured motion: the component's
  std::vector<SlipPair> pairs;
  core::SlipDecision figures;
};

/// A landmark that may be in view.
struct SlipLandmark {
  core::LandmarkId id = core::no_landmark;
  Eigen::Vector2d at_m = Eigen::Vector2d::Zero();  ///< world frame
  int hits = 0;                                    ///< one begun by a single false alarm is not evidence
};

/// A scan, what became of it without a slip, and the map around. What costs anything is asked only when it matters.
struct SlipContext {
  const core::Scan& scan;  ///< with a view of finite area, or nothing is found
  core::Pose2 T_world_robot;
  const std::vector<core::AssociationReport>& fate;
  std::function<std::vector<SlipLandmark>()> near;
  std::function<core::JointGaussian(const std::vector<core::LandmarkId>&)> joint;
  std::function<std::vector<core::Pose2>()> looked_from;  ///< T_world_sensor of earlier views of the ground around
  double extraneous_per_scan = 1.0;                       ///< observations not of a mapped landmark
  double detection_probability = 0.9;
};

/// The slip before this scan that explains it better than no slip and than any other slip: docs/slips.md. Used by the
/// navigator of one vehicle and by a team. O(k²·c² + m³) for k observations with c landmarks in reach of each and m pairs.
/// Test: supervisor/slip/slip_drive_test.cpp.
std::optional<Slip> find_slip(const SlipContext& context, const SlipOptions& options);

/// The pairs of a slip are matched, whatever else claimed their landmarks: what did is ambiguous.
void match_pairs(const std::vector<SlipPair>& pairs, std::vector<core::AssociationReport>& fate);

}  // namespace helixnav::supervisor
