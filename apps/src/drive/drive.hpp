// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/exit_code.hpp"
#include "earlier_session.hpp"
#include "given_map.hpp"
#include "helixnav/core/recording.hpp"
#include "helixnav/runs/run_manifest.hpp"
#include "helixnav/supervisor/navigator.hpp"
#include "settings/fastslam_settings.hpp"

namespace helixnav::apps {

/// What replay and simulate have in common: a recording is driven through the navigator, through FastSLAM or through
/// the localizer, into a run folder.
struct Drive {
  core::Recording recording;
  supervisor::NavigatorOptions navigator;
  FastSlamSettings fastslam;              ///< in place of the navigator, where it is chosen
  std::optional<GivenMap> given_map;      ///< localise in it instead of mapping
  std::optional<EarlierSession> earlier;  ///< go on in its map
  bool known_association = false;         ///< use the recording's labels as identities
  bool is_own_log = false;                ///< in the user's own format
  std::vector<bool> withheld;             ///< [scan] not to be fed (blackout.hpp); empty: none is
  double memory_mb = 0.0;                 ///< of the process, at which the drive ends; 0: no limit
  bool smooth = false;                    ///< afterwards, with the filter's own associations
  std::string out;
  bool overwrite = false;
  bool quiet = false;
  runs::RunManifest manifest;
  double reading_s = 0.0;  ///< wall clock spent before the drive

  /// Whether to ask for constants that err all along (systematic_motion.hpp): of logs of which calibrate finds them. Not of a run on a
  /// given map, whose own odometry and ranges had errors of theirs, nor of particles, each of which has landmarks of its own.
  bool may_err_systematically() const { return is_own_log && !given_map && !earlier && !fastslam.chosen; }
};

/// Runs it, prints the evaluation on stdout and where the report is. On SIGINT the run ends after the present step, its
/// folder is closed properly and the code is `interrupted`. Where the process has taken `memory_mb` it ends likewise, with the code `data`:
/// what the map, its joint covariance and the report are written from comes on top.
ExitCode drive(const Drive& job);

}  // namespace helixnav::apps
