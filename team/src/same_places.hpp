// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/landmark_id.hpp"

namespace helixnav::team {

/// Landmarks of one map, by index.
struct Places {
  std::vector<core::LandmarkId> ids;
  std::vector<Eigen::Vector2d> at_m;
  Eigen::MatrixXd covariance;          ///< joint, (x, y) of each
  std::vector<double> density_per_m2;  ///< of other landmarks about each
  /// Along an axis; empty: none. Copies within one gate take the looks at a landmark in turn, each those on its own side of the noise, and
  /// end up as far apart as the error of a look, whatever their covariance says.
  std::vector<double> split_m2;
  std::function<bool(std::size_t, std::size_t)> are_two;  ///< is known, e.g. both were seen in one scan
};

struct SamePlace {
  std::size_t kept = 0, removed = 0;  ///< indices of Places
  double nats = 0.0;                  ///< given those before it
};

/// Pairs that are one landmark, the surest first, each given that those before it are: a pair is inside the gate of the joint
/// covariance, at least 20 times as likely as another landmark being there by chance, and as much likelier than a rival that
/// cannot be the same as well. Nothing if all of them together are not 1/(1 − probability) times as likely. O(n³) for n
/// landmarks if pairs are found, O(n²) if none is. Test: team/same_places_test.cpp.
std::vector<SamePlace> same_places(Places places, double probability);

}  // namespace helixnav::team
