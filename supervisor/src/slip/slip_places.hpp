// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "slip/slip_evidence.hpp"

namespace helixnav::supervisor {

/// A place where the vehicle may be instead of where it is predicted, with the pairs that support it.
struct SlipPlace {
  std::vector<PointPair> pairs;
  SlipExplanation explanation;
};

/// Whether two displacements cannot be told apart.
bool is_same_place(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double distinct_m);

/// How far off the landmark of an observation may be after a slip: next to the one that is seen there, or anywhere that
/// the widest slip may displace it to.
enum class SlipReach { next_neighbour, any_neighbour };

/// The spacing of landmarks that bounds slip_reach_m: their median, or none.
double spacing_in(SlipReach reach, const std::vector<Eigen::Vector2d>& points_m);

/// How far from an observation its landmark may be after a slip of the widest component; no landmark farther than its
/// neighbour is worth considering: displaced so far, nobody knows which is which.
double slip_reach_m(const SlipComponent& widest, const SeenPoint& seen, double spacing_m);

/// The places that explain most, best first: proposed by two observations on two landmarks equally far apart, the
/// distinct ones then paired and weighed again, when several may settle on one. O(k²·c² + 8 m³) with k observations and
/// c landmarks in reach of each.
/// Test: supervisor/slip/slip_places_test.cpp.
std::vector<SlipPlace> slip_places(const RelativeGeometry& geometry, const std::vector<SeenPoint>& seen,
                                   double nats_a_pair, const std::vector<SlipComponent>& components, double distinct_m,
                                   SlipReach reach = SlipReach::next_neighbour);

}  // namespace helixnav::supervisor
