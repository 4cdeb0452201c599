// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "helixnav/core/decision.hpp"
#include "slip/slip_places.hpp"

namespace helixnav::supervisor {

/// An observation of a landmark, as a slip explains it.
struct SlipPair {
  int observation = 0;  ///< index in the scan
  core::LandmarkId landmark = core::no_landmark;
  double nis = 0.0;  ///< of the pair at the displacement found, landmark and observation alone
};

/// A slip that is believed.
struct Slip {
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the motion nobody measured: the component's
  std::vector<SlipPair> pairs;
  core::SlipDecision figures;
};

/// What a slip is weighed against: the landmarks that may be evidence for it, whether they were seen more than once, and the
/// pairs among them that were associated without a slip.
struct SlipQuestion {
  const RelativeGeometry& geometry;
  const std::vector<SeenPoint>& seen;
  std::vector<PointPair> associated;
  double nats_a_pair = 0.0;
  bool tentative = false;
};

/// The slip that explains a scan, when it does so better than no slip and than a slip to anywhere else, and by less than
/// what makes neighbours look alike. In a lattice a slip by one pitch looks like none, its rival at the true place may have
/// too few pairs, and only the last of these rules keeps it out. Test: supervisor/slip/slip_decision_test.cpp.
std::optional<Slip> decide_slip(const SlipQuestion& question, const SlipOptions& options);

}  // namespace helixnav::supervisor
