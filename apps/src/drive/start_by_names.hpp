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

/// A map as seen by an estimator that knows names.
struct NamedMap {
  std::map<core::Label, core::LandmarkId> landmark_of;
  std::map<core::LandmarkId, Eigen::Vector2d> point_m;
};

/// Where on the map a log begins, from the names in its first scans: the rigid fit to the landmarks of the first scan that gives the
/// heading to 3° and contradicts neither the map nor itself, and back from there by odometry. Known to a 60th of the sensor's reach and
/// 3°, as for a given start, plus what the odometry up to there adds. Nothing if no scan names two landmarks of the map by observations
/// that place them. Test: apps/start_by_names_test.cpp.
std::optional<core::PoseGaussian> start_by_names(const core::Recording& recording, const NamedMap& map, double reach_m);

/// Whether two estimates of a start contradict each other, at five standard deviations of x, y or heading.
bool contradict(const core::PoseGaussian& one, const core::PoseGaussian& other);

/// For a drive by names on an earlier map: begins where its first names indicate, if no start is given, or if the start in the log
/// contradicts them. Not if odometry until then has made a start that nobody gave more than twice as uncertain as a given one. Returns a
/// sentence about it, for the screen; none if nothing changes. To be called before put_truth_on_map.
std::string begin_by_names(Drive& job);

}  // namespace helixnav::apps
