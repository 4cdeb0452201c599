// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/landmark_id.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::relocalize {

struct Pair {
  core::LandmarkId branch = core::no_landmark;
  core::LandmarkId map = core::no_landmark;
};

/// A pose of the branch in the map, with the evidence for it.
struct Place {
  core::Pose2 T_map_branch;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of the pairs on (x, y, heading) of T_map_branch
  std::vector<Pair> pairs;                                ///< one to one
  double chi2 = 0.0;  ///< of the pairs at this pose, which they were free to choose: 2·pairs − 3 degrees of freedom
  double evidence =
      0.0;            ///< ln of: likelihood against chance, times what the pairs fix of all poses on the map's ground
  int unmatched = 0;  ///< landmarks of the branch without a pair, on ground of the map
  int missed = 0;     ///< landmarks of the map without a pair, on ground of the branch
};

enum class Verdict {
  closed,     ///< the best place is the true one, except with probability α
  ambiguous,  ///< a place fits, and so may others; or the search was cut short
  not_here,   ///< no place fits better than chance would
};

/// "closed", "ambiguous", "not here".
const char* name_of(Verdict verdict);

inline constexpr std::size_t most_places = 20;

struct Answer {
  Verdict verdict = Verdict::not_here;
  std::vector<Place> places;  ///< distinct ones by descending evidence, at most most_places; the first is the answer
  double rival_scale =
      1.0;  ///< β: how much evidence rivals have by chance here, in nats; 1 where places do not look alike
  /// Lead of the first place over its best rival (over 0 when there is none), in units of β and less where β is known from
  /// the rivals only: −ln of the probability that chance leads so far.
  double gap = 0.0;
  std::size_t triangles = 0;  ///< of the question that were looked up
  double candidates = 0.0;    ///< triangles of the map that had the sides of one of these
  bool capped = false;        ///< the limit of candidates ended the search
  bool crowded = false;       ///< more poses tied for the best than were kept
};

}  // namespace helixnav::relocalize
