// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "helixnav/core/recording.hpp"

namespace helixnav::logs {

/// What the last columns of ODOMETRY and LANDMARK lines are: the upper triangle, by rows, of …
enum class NoiseColumns {
  recognise,                ///< `square_root_information` when the first one of the file exceeds 1, else `covariance`
  square_root_information,  ///< R with RᵀR = C⁻¹ (iSAM)
  covariance,               ///< C (GTSAM's copy of the same file)
};

/// Reads the landmark-graph text of iSAM and GTSAM:
///   ODOMETRY from to dx dy dheading + 6 noise columns      T_from_to [m, m, rad]
///   LANDMARK pose landmark x y + 3 noise columns           the landmark in the frame of the pose [m]
/// Poses and landmarks are numbered in one common sequence. Odometry is a chain; observations may come later than their
/// pose. The recording has a Scan for every pose, so that scan k is pose k, at t = k seconds, as the file has no times;
/// labels are the landmarks' numbers in the file. The field of view is unlimited, which means unknown: a landmark that
/// was not seen carries no information. Victoria Park: 15 ms. Throws core::InputError naming file:line for an unknown
/// keyword, wrong columns, odometry that does not continue from the latest pose, an unknown pose, or noise that is not
/// positive definite. Test: logs/pose_landmark_text_test.cpp.
core::Recording read_pose_landmark_text(const std::filesystem::path& path,
                                        NoiseColumns columns = NoiseColumns::recognise);

}  // namespace helixnav::logs
