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
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the unmeasured motion: the component's
  std::vector<SlipPair> pairs;
  core::SlipDecision figures;
};

/// What a slip is weighed against: the landmarks that may be evidence for it, whether they were seen more than once, and the
/// pairs among them that were associated without a slip.
struct SlipQuestion {
  const RelativeGeometry& geometry;
  const std::vector<SeenPoint>& seen;
  std::vector<double>
      new_per_m2;  ///< [seen] density of landmarks not mapped yet where it stands as measured: density_of_new
  std::vector<PointPair> associated;
  double nats_a_pair = 0.0;
  double extraneous_per_m2 = 0.0;  ///< density of what is in no map, as in pair_nats
  bool tentative = false;
  SlipReach reach = SlipReach::next_neighbour;
};

/// The slip that explains a scan, if it does so better than no slip with new landmarks where the pattern of the map has
/// them or where nobody has looked yet, and better than a slip to anywhere else.
/// Test: supervisor/slip/slip_decision_test.cpp.
std::optional<Slip> decide_slip(const SlipQuestion& question, const SlipOptions& options);

}  // namespace helixnav::supervisor
