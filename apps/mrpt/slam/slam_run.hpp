// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "common/exit_code.hpp"

namespace helixnav::apps {

struct SlamJob {
  std::string config;
  std::string rawlog;  ///< empty: rawlog_file of the configuration
  std::string out;     ///< empty: logOutput_dir of the configuration
  bool overwrite = false;
  bool quiet = false;
  std::vector<std::string> command_line;
};

/// Navigates along a rawlog as a kf-slam configuration says; run folder and kf-slam's files into one folder. What a
/// rawlog holds before a damaged place, or before an observation that cannot be used, is navigated and written; then the
/// fault is thrown. InputError when nothing could be processed: no folder is made then.
ExitCode run_slam(const SlamJob& job);

}  // namespace helixnav::apps
