// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/landmark_id.hpp"

namespace helixnav::supervisor {

/// Two-hit confirmation: an isolated match with an old landmark is accepted at the second hit, because clutter does not
/// appear twice in the same place. Test: supervisor/association/revisit_ambiguity_test.cpp, campaigns in
/// docs/adr/0009-integrity.md.
class Confirmation {
 public:
  /// A hit on the landmark, `path_m` along the drive. True if it was also the last one hit, at most `reach_m` earlier.
  bool confirms(core::LandmarkId landmark, double path_m, double reach_m) {
    const bool again = landmark == landmark_ && path_m - path_m_ <= reach_m;
    landmark_ = landmark;
    path_m_ = path_m;
    return again;
  }

 private:
  core::LandmarkId landmark_ = core::no_landmark;
  double path_m_ = 0.0;
};

}  // namespace helixnav::supervisor
