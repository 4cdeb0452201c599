// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "helixnav/core/se2.hpp"
#include "helixnav/supervisor/systematic_errors.hpp"
#include "loop/tape.hpp"

namespace helixnav::supervisor {

/// What a stretch of the drive says of its systematic errors e, with its poses and landmarks integrated out: near their
/// solution, its least χ² is chi2 − 2 gradientᵀe + eᵀ information e.
struct StretchEvidence {
  SystematicErrors::Matrix information = SystematicErrors::Matrix::Zero();
  SystematicErrors::Vector gradient = SystematicErrors::Vector::Zero();
  SystematicErrors::Vector in_rows = SystematicErrors::Vector::Zero();  ///< Σ (∂row/∂e)² of whitened rows
  int motions = 0, sightings = 0;
  double chi2 = 0.0;
  double left = 0.0;  ///< by which another iteration would lower it
  int dof = 0;        ///< of chi2: rows less coordinates of poses and landmarks
};

/// Least squares over all poses and landmarks of the stretch, then the Schur complement of the errors. Stretches are
/// independent of each other and of the map: the first pose is the gauge, and nothing else is known of the landmarks. Those seen
/// once are left out. Nothing if no landmark was seen twice. `near`: for each stop a pose to begin at, in any frame; none: dead reckoning.
/// At most that many iterations of Gauss and Newton: three suffice for one reach of the sensor. Errors: core::NumericalError.
/// Cost: O(stops³) an iteration, and for each landmark the square of the stops that saw it. Test:
/// supervisor/systematic/stretch_evidence_test.cpp (against smoothing::evidence_of_constants).
std::optional<StretchEvidence> evidence_of_stretch(const std::vector<Stop>& stops,
                                                   const std::vector<core::Pose2>& near = {}, int most_iterations = 3);

}  // namespace helixnav::supervisor
