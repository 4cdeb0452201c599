// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/joint_map.hpp"
#include "helixnav/core/map_appearance.hpp"
#include "helixnav/relocalize/map_index.hpp"
#include "helixnav/supervisor/search_options.hpp"
#include "smoothing/drive_map.hpp"

namespace helixnav::supervisor {

/// PreconditionError if the parts of the map do not fit together.
void check_earlier_map(const core::JointMap& map);

/// Whether a session continues behind the drive that made the map, and not in its joint covariance. It does if the map
/// holds factors, unless nothing is searched for, so that the filter is never handed over, or closings by restart forget
/// what ties the drive together. PreconditionError if the map has no joint covariance then.
bool goes_on_behind(const core::JointMap& map, const SearchOptions& options);

/// Of the sensor that mapped it, or the reference if nobody knows.
double mapped_reach_m(const core::JointMap& map);

/// The mature landmarks of an earlier session, in its frame, ready to be asked. Tentative ones are left out.
class EarlierMap {
 public:
  /// PreconditionError if the parts of the map do not fit together. A map that holds factors is solved.
  explicit EarlierMap(const core::JointMap& map);

  /// Landmarks with covariances relative to their neighbours within reach, on top of the noise of a pair.
  relocalize::MapIndex index(const relocalize::IndexOptions& lengths) const;

  /// Pose meaningless, ids ascending. Without covariance if the map has none.
  const core::JointGaussian& landmarks() const { return landmarks_; }

  /// Of a map that holds factors: the landmarks within a distance of a place, the nearest if they are more than `most`, ids
  /// ascending.
  core::JointGaussian landmarks_about(const Eigen::Vector2d& center_m, double radius_m, std::size_t most) const;

  /// The drive that made it, if the map holds factors; else null.
  const std::shared_ptr<const DriveMap>& drive() const { return drive_; }

  int observations(std::size_t landmark) const { return observations_[landmark]; }
  const core::MapAppearance& appearance() const { return appearance_; }
  core::LandmarkId next_name() const { return next_name_; }

  /// Where a landmark is, with its covariance once the nearest dozen are moved and turned together to fit best. O(N).
  core::PointGaussian relative_to_neighbours(std::size_t landmark, double reach_m) const;

  /// The same for all landmarks, in their order. O(N) if the map holds factors, else O(N²).
  std::vector<core::PointGaussian> relative_to_neighbours(double reach_m) const;

 private:
  std::vector<core::PointGaussian> relative_by_squares(double reach_m) const;

  core::JointGaussian landmarks_;
  std::vector<int> observations_;
  core::MapAppearance appearance_;
  core::LandmarkId next_name_;
  std::shared_ptr<const DriveMap> drive_;
};

}  // namespace helixnav::supervisor
