// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace helixnav::apps {

/// Files of an example log: two laps of a simulated cart with a laser that detects poles.
struct ExampleLog {
  std::string vehicle;  ///< TOML with a comment on every key
  std::string odometry, detections, truth_poses, truth_landmarks;
};

/// The same bytes every time. Test: apps/own_log_test.cpp.
ExampleLog make_example_log();

}  // namespace helixnav::apps
