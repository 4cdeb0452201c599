// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/landmark_id.hpp"
#include "helixnav/core/time.hpp"

namespace helixnav::team {

/// Two landmarks of one component that turned out to be one, without a name to show it: `removed` became `kept`.
/// Decisions of one time were taken together: cost, dof and limit are those of all of them.
struct SameLandmarks {
  core::Nanoseconds t_ns = 0;
  core::LandmarkId kept = core::no_landmark;
  core::LandmarkId removed = core::no_landmark;
  double nats = 0.0;  ///< ln of the likelihood ratio against another landmark that is there by chance
  double cost = 0.0;  ///< by how much least squares with the two as one exceeds that with two, or, of copies that
                      ///< were seen in turn, what all looks at them cost then: χ² with dof
  int dof = 0;
  double limit = 0.0;
};

}  // namespace helixnav::team
