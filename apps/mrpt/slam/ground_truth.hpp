// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "helixnav/core/recording.hpp"
#include "helixnav/mrpt_adapter/map_builder.hpp"

namespace helixnav::apps {

/// kf-slam's ground_truth_file: a landmark a line, x y z … and in the seventh column its landmarkID. InputError names
/// file and line.
std::vector<core::TrueLandmark> read_true_landmarks(const std::string& path);

/// kf-slam's ground_truth_file_robot: the place (x, y) of the vehicle, a line a step.
std::vector<Eigen::Vector2d> read_true_path(const std::string& path);

/// Distances in the plane of landmarks to the truth of the same landmarkID, in the frame of the map (nothing is aligned),
/// as kf-slam counts them.
struct LandmarkErrors {
  std::size_t compared = 0;
  std::size_t without_truth = 0;
  double mean_m = 0.0;
  double largest_m = 0.0;
};
LandmarkErrors landmark_errors(const mrpt_adapter::MapBuilder& builder, const std::vector<core::TrueLandmark>& truth);

}  // namespace helixnav::apps
