// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "calibration.hpp"
#include "settled_log.hpp"

namespace helixnav::apps {

/// How far constants are usually off; 0 for one left at its file value because it does not settle.
Eigen::VectorXd usual_of(const Calibration& calibration);

/// The change from settings back to the file values.
Eigen::VectorXd back_to_told(const Calibration& calibration, const Settings& settings);

/// The drive that constants are judged by.
struct JudgedDrive {
  ReadLog as_told, with_noise_found;  ///< read with the noise of the file, and with that found
  Ids ids;
  std::vector<std::size_t> slipped;
  core::LandmarkGraph graph;  ///< solved with them
};

/// Decides which constants are kept (kept_constants.hpp), estimates these with the others at their file values, and
/// stores the result in the calibration. Returns the settings fitted to all but the last part of the log.
Settings judge_constants(JudgedDrive drive, Calibration& calibration);

}  // namespace helixnav::apps
