// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "helixnav/core/recording.hpp"

namespace helixnav::apps {

/// How many entries were written, and what a rawlog cannot hold.
struct RawlogCounts {
  std::size_t scans = 0;
  std::size_t movements = 0;
  std::size_t observations = 0;
  std::size_t repeated_labels = 0;  ///< written without a label: MRPT allows a landmarkID only once per observation
};

enum class LandmarkIds { labels, none };

/// Writes the events as pairs of CActionCollection and CSensoryFrame, the format that kf-slam reads: the increments since
/// the last scan, chained, as one CActionRobotMovement2D with its full 3×3 covariance, then the scan as one
/// CObservationBearingRange with a covariance for each measurement. The movement is marked as coming from scan matching:
/// for odometry MRPT stores not a covariance but a model of independent errors. Points (x, y) become range and yaw, their
/// covariance to first order. Lost: truth, all labels of an observation but the first, digits beyond float (range and
/// yaw; 1e-7 of them). InputError if range-only or bearing-only observations or fixes are to be written.
/// Test: mrpt_apps/convert_test.cpp.
RawlogCounts write_recording(const core::Recording& recording, const std::string& path, LandmarkIds ids);

}  // namespace helixnav::apps
