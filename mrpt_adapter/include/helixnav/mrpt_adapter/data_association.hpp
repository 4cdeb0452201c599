// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace helixnav::mrpt_adapter {

/// What became of the measurements of one step of MapBuilder, with the numbers that decided it.
struct DataAssociation {
  enum class Outcome {
    matched,    ///< updated the landmark named
    inserted,   ///< began the landmark named
    ambiguous,  ///< not used: explained by more than one landmark, or neither near nor far enough
    rejected,   ///< not used: its landmark was refused, or it has no name where association is known
  };
  struct Pairing {
    std::size_t measurement = 0;  ///< index in sensedData, or among what the detector found
    Outcome outcome = Outcome::ambiguous;
    std::int64_t landmark = -1;  ///< number as in MapBuilder::getCurrentState; −1: none
    double mahalanobis2 = 0.0;   ///< νᵀS⁻¹ν of the pair; NaN without one
    double margin_nats = 0.0;    ///< cost of the best alternative minus that of the choice; +inf without one
  };

  std::int64_t step = -1;  ///< from 0; −1 before the first
  bool searching = false;  ///< a search for old ground is open
  double joint_mahalanobis2 = 0.0;
  int joint_dof = 0;  ///< rows of the joint update; 0: nothing matched
  std::vector<Pairing> pairings;
};

}  // namespace helixnav::mrpt_adapter
