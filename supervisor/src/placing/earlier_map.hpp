// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/joint_map.hpp"
#include "helixnav/core/map_appearance.hpp"
#include "helixnav/relocalize/map_index.hpp"

namespace helixnav::supervisor {

/// The mature landmarks of an earlier session, in its frame, ready to be asked. Tentative ones are left out.
class EarlierMap {
 public:
  /// PreconditionError if the parts of the map do not fit together.
  explicit EarlierMap(const core::JointMap& map);

  /// Landmarks with covariances relative to their neighbours within reach, on top of the noise of a pair.
  relocalize::MapIndex index(const relocalize::IndexOptions& lengths) const;

  /// Pose meaningless, ids ascending.
  const core::JointGaussian& landmarks() const { return landmarks_; }
  int observations(std::size_t landmark) const { return observations_[landmark]; }
  const core::MapAppearance& appearance() const { return appearance_; }
  core::LandmarkId next_name() const { return next_name_; }

  /// Where a landmark is, with its covariance once the nearest dozen are moved and turned together to fit best. O(N).
  core::PointGaussian relative_to_neighbours(std::size_t landmark, double reach_m) const;

 private:
  core::JointGaussian landmarks_;
  std::vector<int> observations_;
  core::MapAppearance appearance_;
  core::LandmarkId next_name_;
};

}  // namespace helixnav::supervisor
