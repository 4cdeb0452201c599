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

/// The common part of replay and simulate: a recording is driven through the navigator, through FastSLAM or through the
/// localizer, into a run folder.
struct Drive {
  core::Recording recording;
  supervisor::NavigatorOptions navigator;
  FastSlamSettings fastslam;              ///< instead of the navigator, if chosen
  std::optional<GivenMap> given_map;      ///< localise in it instead of mapping
  std::optional<EarlierSession> earlier;  ///< continue in its map
  bool known_association = false;         ///< use the recording's labels as identities
  bool is_own_log = false;                ///< in the user's own format
  std::vector<bool> withheld;             ///< [scan] to be withheld (blackout.hpp); empty: none
  double memory_mb = 0.0;                 ///< memory of the process at which the drive ends; 0: no limit
  bool smooth = false;                    ///< afterwards, with the filter's own associations
  std::string out;
  bool overwrite = false;
  bool quiet = false;
  runs::RunManifest manifest;
  double reading_s = 0.0;  ///< wall clock spent before the drive

  /// Whether to test for constants with a persistent error (systematic_motion.hpp): for logs whose constants calibrate estimates. Not
  /// for a run on a given map, whose own odometry and ranges had their own errors, nor for particles, each of which has its own
  /// landmarks.
  bool may_err_systematically() const { return is_own_log && !given_map && !earlier && !fastslam.chosen; }
};

/// Runs it, prints the evaluation on stdout and where the report is. On SIGINT the run ends after the current step, its folder is closed
/// properly and the code is `interrupted`. If the process has taken `memory_mb` it ends likewise, with the code `data`: the memory for
/// writing the map, its joint covariance and the report comes on top.
ExitCode drive(const Drive& job);

}  // namespace helixnav::apps
