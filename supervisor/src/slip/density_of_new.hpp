// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/core/se2.hpp"
#include "helixnav/pf_relocalize/constellation.hpp"
#include "slip/relative_geometry.hpp"

namespace helixnav::supervisor {

/// Landmark density of an area [1/m²] from the distance of the third neighbour, n = 3/(π d²), which a second stem
/// beside each does not affect. The median; 0 below four landmarks. O(n²).
double local_density_per_m2(const std::vector<Eigen::Vector2d>& points_m);

/// [seen] Density of landmarks not mapped yet [1/m²] where an observation is as measured. On ground already looked at,
/// it is `extraneous_per_m2`, NavigatorOptions::extraneous_per_scan over the area of the view; elsewhere it is that of
/// the mapped landmarks, if higher: a vehicle turning into the next row sees several new ones at once. O(seen · views).
/// Test: supervisor/slip/slip_decision_test.cpp.
std::vector<double> density_of_new(const std::vector<SeenPoint>& seen, const core::Pose2& T_world_robot,
                                   const pf_relocalize::Coverage& looked_at, double mapped_per_m2,
                                   double extraneous_per_m2);

}  // namespace helixnav::supervisor
