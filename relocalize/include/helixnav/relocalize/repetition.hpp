// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/relocalize/answer.hpp"
#include "helixnav/relocalize/map_index.hpp"
#include "helixnav/relocalize/question.hpp"

namespace helixnav::relocalize {

/// Which share of the points says something that the others do not: a row of equal spacing follows from its first two points, and any
/// other row of that spacing fits it. Moved by the way from one point to another, at least tolerance_m, the others lie on points again, to
/// tolerance_m; with the most that do, m of n, the share is (n − m + 1)/n: 1 where no two ways are alike, 2/n for a row.
/// O(n⁴) distances at worst: 1 ms for 40 points. Test: relocalize/repetition_test.cpp.
double independent_share(const std::vector<Eigen::Vector2d>& points_m, double tolerance_m);

/// Points are the same to this distance: three pair noises.
inline double same_to_m(const IndexOptions& lengths) { return 3.0 * lengths.pair_noise_m; }

/// That of the question's landmarks that have a pair at this place.
double independent_share(const MapIndex& map, const Question& question, const Place& place);

}  // namespace helixnav::relocalize
