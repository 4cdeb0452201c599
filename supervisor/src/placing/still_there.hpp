// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "helixnav/association/landmark_life.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/supervisor/navigator_options.hpp"

namespace helixnav::supervisor {

/// What was in view before a pause, and what is in view after it.
struct StillThere {
  int seen = 0;     ///< earlier landmarks with an observation in their gate
  int missing = 0;  ///< mature ones without one that should be in view
  int unknown = 0;  ///< observations in no gate
  /// ln P(scan | anywhere) / P(scan | where it stopped). Anywhere, a scan is a Poisson process with the mean number of
  /// observations in the scans of this drive; where it stopped, one with as many extraneous ones as association
  /// assumes, and the landmarks, each detected or not.
  double elsewhere_nats = 0.0;

  /// An empty scan may come from a sensor that is still starting.
  bool is_elsewhere(const IntegrityLimits& limits) const {
    return elsewhere_nats >= limits.nats && unknown >= limits.spawned;
  }
  bool is_here(const IntegrityLimits& limits) const { return elsewhere_nats <= -limits.nats; }
  /// By as much as is required of a place on the whole map: a tree or two may stand where others did.
  bool is_surely_here() const {
    static const double needed = -std::log(1e-5);
    return elsewhere_nats <= -needed;
  }
};

/// By the length of the drive until then.
struct PathInterval {
  double from_m, until_m;
};

/// The landmarks that were in view when the vehicle stopped (begun up to the end of the stretch, and seen since its
/// start) against a scan after the pause, as seen from the pose before it and the motion measured since.
/// O(landmarks in view · observations). Test: supervisor/placing/found_carried_test.cpp.
StillThere still_there(const cekf::CompressedEkf& filter, const association::LandmarkLife& existence,
                       const core::Pose2& T_before_now, const core::Scan& scan, const PathInterval& stopped,
                       const NavigatorOptions& options);

}  // namespace helixnav::supervisor
