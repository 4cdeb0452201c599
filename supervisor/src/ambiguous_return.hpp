// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "helixnav/association/innovation_problem.hpp"
#include "helixnav/association/landmark_life.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/events.hpp"

namespace helixnav::supervisor {

/// Mature landmarks unseen over a drive of `old_after_m`, ascending.
std::vector<core::LandmarkId> old_landmarks(const association::LandmarkLife& life, double old_after_m);

/// An old landmark that an observation would be matched to, and what else may stand in its gate.
struct AmbiguousReturn {
  core::LandmarkId landmark = core::no_landmark;
  double foreign_objects = 0.0;  ///< η = neighbours + extraneous density × area of the gate
  int neighbours = 0;            ///< other old landmarks in its 95 % gate
  double gate_area = 0.0;        ///< π·5.99·√|S| in the units of the observation
};

/// The largest η over all old landmarks that have an observation in their gate; none when no old landmark has.
/// P(wrong | matched) is about η/(P_D + η), so that η is what one risks by associating scan by scan. `old` ascending.
/// Cost: gated pairs × old landmarks in view, and nothing as long as no old landmark is gated.
/// Source: PROTOTYPE §2. Test: supervisor/ambiguous_return_test.cpp.
std::optional<AmbiguousReturn> most_ambiguous_return(const cekf::CompressedEkf& filter,
                                                     const association::InnovationProblem& problem,
                                                     const core::Scan& scan, const std::vector<core::LandmarkId>& old,
                                                     double foreign_per_scan);

}  // namespace helixnav::supervisor
