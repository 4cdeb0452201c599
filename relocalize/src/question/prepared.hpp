// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "helixnav/relocalize/question.hpp"
#include "index/parts.hpp"

namespace helixnav::relocalize {

/// A point of the question, from the centre of its landmarks.
struct Point {
  float x_m = 0.0F;
  float y_m = 0.0F;
};

/// A question made ready for one map: points and discs from the mean of the question's landmarks ("centre"), and what
/// follows from the densities of both. Poses of the search are T_origin_centre: the centre in the index's coordinates.
struct Prepared {
  Prepared(const MapIndex::Parts& parts, const Question& asked);

  core::Pose2 T_map_branch(const core::Pose2& T_origin_centre) const;

  const MapIndex::Parts& map;
  const Question& question;
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();  ///< in the branch's frame
  std::vector<Point> points;
  std::vector<Disc> looked;
  double extent_m = 0.0;        ///< of the points from the centre
  double density_per_m2 = 0.0;  ///< of the question's landmarks on the ground it looked at
  double near_m = 0.0;          ///< a point this near to a landmark of the map hits
  double chance_hit = 0.0;      ///< share of the map's ground that is this near
  double ln_poses = 0.0;        ///< ln(2πA) over the ground A of the map
};

/// Area of the union of discs, by strips: 1e-3 of it for overlapping discs, rounding for one.
double union_area_m2(const std::vector<Disc>& discs);

}  // namespace helixnav::relocalize
