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

/// Navigates along a rawlog as a kf-slam configuration specifies; run folder and kf-slam's files go into one folder.
/// What precedes a damaged place in the rawlog, or an observation that cannot be used, is navigated and written; then
/// the error is thrown. InputError if nothing could be processed: no folder is made then.
ExitCode run_slam(const SlamJob& job);

}  // namespace helixnav::apps
