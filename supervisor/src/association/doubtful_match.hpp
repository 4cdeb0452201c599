// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/landmark_id.hpp"

namespace helixnav::supervisor {

/// An observation that is of a tentative landmark, or of nothing that is mapped: doubtful_matches.hpp.
struct DoubtfulMatch {
  core::LandmarkId landmark = core::no_landmark;
  double nats = 0.0;  ///< by which an observation of it explains better than something in no map what was seen
};

}  // namespace helixnav::supervisor
