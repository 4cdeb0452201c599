// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "helixnav/atlas/atlas.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/joint_map.hpp"
#include "helixnav/core/map_factors.hpp"
#include "helixnav/supervisor/factored_map.hpp"

namespace helixnav::supervisor {

/// What a session hands on to the next: its landmarks, as listed by its navigator's map(), and its pose, with all
/// correlations. O(N²).
core::JointMap joint_map(const cekf::CompressedEkf& filter, const std::vector<core::MapLandmark>& landmarks);
/// The same for any navigator that has joint() and filter().
core::JointMap joint_map(core::JointGaussian joint, core::LandmarkId next_name,
                         const std::vector<core::MapLandmark>& landmarks);
/// The same as factors of a drive, for a map of any size; `landmarks` are known to it. O(N).
core::JointMap factored_map(const atlas::Atlas& drive, core::LandmarkId next_name,
                            const std::vector<core::MapLandmark>& landmarks, FactoredMap how = FactoredMap::whole);
/// The same with the places and covariances of the landmarks as listed.
core::JointMap factored_map(core::MapFactors factors, const core::PoseGaussian& pose, core::LandmarkId next_name,
                            const std::vector<core::MapLandmark>& landmarks);
/// The map as a session continues in it from a pose on it that was given, with its covariance (x, y, heading) relative to
/// the nearest dozen landmarks: it shares their errors, and says nothing about where in the frame they are. Tentative
/// landmarks are left out. O(N), with a joint covariance O(N²).
/// Test: supervisor/placing/begun_at_test.cpp.
core::JointMap begun_at(core::JointMap map, const core::PoseGaussian& pose);
/// PreconditionError for a joined map, since no session can continue from the pose in it.
void check_has_end(const core::JointMap& map);

/// In the order of `landmarks`.
std::vector<core::LandmarkId> ids_of(const std::vector<core::MapLandmark>& landmarks);

/// The mature landmarks of a map as drawn, for finding where on it the vehicle is: each independent of the others, with
/// its covariance relative to its neighbours within `reach_m` plus half the variance between two drives' views of one
/// landmark (`pair_noise_m`). Distortion of the map as a whole is not included. The pose is at the origin and certain.
/// As factors if the map has no joint covariance, and then O(N), else O(N²). PreconditionError when the parts of the map do not fit together. Test: supervisor/placing/as_drawn_test.cpp.
core::JointMap as_drawn(const core::JointMap& map, double reach_m, double pair_noise_m);

/// The same for a navigator with all landmarks of its map, as listed: a filter that holds only some of them may use its
/// own names.
template <class Navigator>
core::JointMap joint_map(const Navigator& navigator, const std::vector<core::MapLandmark>& landmarks) {
  const core::LandmarkId after_last = landmarks.empty() ? 0 : landmarks.back().id + 1;
  const core::LandmarkId next_name = std::max(navigator.filter().next_name(), after_last);
  return joint_map(navigator.joint(ids_of(landmarks)), next_name, landmarks);
}

/// What a session leaves to the next: a joint covariance for up to `most_dense` landmarks, and factors if the map is large
/// (Navigator::factored_map). Nothing if it has neither, or if its drive cannot be solved.
template <class Navigator>
std::optional<core::JointMap> map_to_go_on_in(const Navigator& navigator,
                                              const std::vector<core::MapLandmark>& landmarks, std::size_t most_dense) {
  const bool is_dense = landmarks.size() <= most_dense;
  std::optional<core::JointMap> map =
      navigator.factored_map(is_dense ? FactoredMap::factors_alone : FactoredMap::whole);
  if (!is_dense) return map;
  try {
    core::JointMap dense = joint_map(navigator, landmarks);
    if (map) dense.factors = map->factors;
    return dense;
  } catch (const core::NumericalError&) {
    return std::nullopt;
  }
}

}  // namespace helixnav::supervisor
