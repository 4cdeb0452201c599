// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "drive.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/recording.hpp"

namespace helixnav::apps {

/// A map as one who knows names sees it.
struct NamedMap {
  std::map<core::Label, core::LandmarkId> landmark_of;
  std::map<core::LandmarkId, Eigen::Vector2d> point_m;
};

/// Where on the map a log begins, by the names that its first scans tell: the rigid fit to the landmarks of the first scan that
/// gives the heading to 3° and contradicts neither the map nor itself, and back from there by odometry. Known to a 60th of the sensor's
/// reach and 3°, as a start that is given, and what the odometry until there adds. Nothing where no scan names two landmarks of the map by
/// observations that place them. Test: apps/start_by_names_test.cpp.
std::optional<core::PoseGaussian> start_by_names(const core::Recording& recording, const NamedMap& map, double reach_m);

/// Whether two estimates of a start contradict each other, at five standard deviations of x, y or heading.
bool contradict(const core::PoseGaussian& one, const core::PoseGaussian& other);

/// Of a drive by names on an earlier map: begins where its first names tell, when nobody says where it begins, or when what the log
/// says of it contradicts them. Not where odometry until then has made a start that nobody gave more than twice as uncertain as one that
/// is given. Returns a sentence about it, for the screen; none where all stays as it was. To be called before put_truth_on_map.
std::string begin_by_names(Drive& job);

}  // namespace helixnav::apps
