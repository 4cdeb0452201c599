// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "common/exit_code.hpp"
#include "helixnav/runs/run_manifest.hpp"
#include "settings/settings.hpp"

namespace helixnav::apps {

struct StreamJob {
  Settings settings;   ///< with the vehicle
  std::string listen;  ///< address of a socket; empty: the standard streams
  std::string out;     ///< run folder; empty: none
  bool overwrite = false;
  std::string resume;  ///< run folder of the drive to be continued; empty: none
  runs::RunManifest manifest;
};

/// Navigates along a stream until its end or a signal, with an answer to each scan. The run folder is as for replay,
/// except for truth, which a stream does not have.
ExitCode stream(const StreamJob& job);

}  // namespace helixnav::apps
