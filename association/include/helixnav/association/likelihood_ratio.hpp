// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/association/innovation_problem.hpp"
#include "helixnav/association/linear_assignment.hpp"
#include "helixnav/core/events.hpp"

namespace helixnav::association {

/// λ = λ_false + λ_new: expected number of observations per scan that come from no landmark of the map, per unit of the
/// observation space. A density has the inverse unit of a likelihood, so their ratio does not depend on units.
struct ExtraneousDensity {
  double range_bearing_per_m_rad = 0.02;
  double cartesian_per_m2 = 0.001;
  double bearing_per_rad = 0.5;
  double range_per_m = 0.05;

  double of(core::ObservationKind kind) const;
};

/// `expected_per_scan` observations spread evenly over the field of view in the coordinates of each kind. Throws
/// PreconditionError unless the field of view is bounded and has an area, and the number is positive.
ExtraneousDensity uniform_density(const core::FieldOfView& field_of_view, double expected_per_scan);

/// The same for one scan with any view: uniform over the view if it is bounded and has an area; over the disc out to
/// the farthest point seen if the view is unknown (its maximum range is zero, as in graph files); `unbounded` if the
/// view has no bound or the scan contains no range. PreconditionError unless the number is positive.
/// Test: association/likelihood_ratio_test.cpp.
ExtraneousDensity density_in_view(const core::Scan& scan, double expected_per_scan, const ExtraneousDensity& unbounded);

/// Costs in nats: −ln[P_D N(ν; 0, S)/(1 − P_D)] for a pair, minus its appearance_nats, −ln λ for an unpaired
/// observation; entry e of the result is pair e of the problem. The ratio of two hypotheses is the posterior odds when
/// landmarks are detected with P_D and extraneous observations are a Poisson process.
/// Test: association/likelihood_ratio_test.cpp (metres against centimetres, radians against degrees).
AssignmentProblem likelihood_ratio_costs(const InnovationProblem& problem, double detection_probability,
                                         const ExtraneousDensity& extraneous);

}  // namespace helixnav::association
