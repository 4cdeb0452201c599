// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "helixnav/core/se2.hpp"
#include "question/prepared.hpp"

namespace helixnav::relocalize {

/// A pose that the sequential test did not abandon.
struct Candidate {
  float score = 0.0F;  ///< ln odds of its hits and misses
  core::Pose2 T_origin_centre;
};

struct Candidates {
  std::vector<Candidate> best;  ///< one per cell of poses, by falling score
  std::size_t triangles = 0;
  double looked_at = 0.0;
  bool capped = false;   ///< the limit ended the search before all triangles were looked up
  bool crowded = false;  ///< more poses than are kept are as good as the best
};

/// Every triangle of the map with the sides of one of the question's gives a pose; the other points of the question, the
/// nearest first, are looked up in the map until their odds fall below e⁻³ (Wald's test). Source: docs/relocalize.md §2.
Candidates find_candidates(const Prepared& asked, double most_candidates);

}  // namespace helixnav::relocalize
