// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "helixnav/core/recording.hpp"
#include "helixnav/mrpt_adapter/map_builder.hpp"

namespace helixnav::apps {

/// kf-slam's ground_truth_file: one landmark per line, x y z … and its landmarkID in the seventh column. InputError
/// names file and line.
std::vector<core::TrueLandmark> read_true_landmarks(const std::string& path);

/// kf-slam's ground_truth_file_robot: the position (x, y) of the vehicle, one line per step.
std::vector<Eigen::Vector2d> read_true_path(const std::string& path);

/// Distances in the plane from landmarks to the truth of the same landmarkID, in the map frame (nothing is aligned), as
/// kf-slam computes them.
struct LandmarkErrors {
  std::size_t compared = 0;
  std::size_t without_truth = 0;
  double mean_m = 0.0;
  double largest_m = 0.0;
};
LandmarkErrors landmark_errors(const mrpt_adapter::MapBuilder& builder, const std::vector<core::TrueLandmark>& truth);

}  // namespace helixnav::apps
