// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "helixnav/core/recording.hpp"

namespace helixnav::apps {

/// Times by the log's own clock, from `begin_s` to before `end_s`, in which the vehicle is blind.
struct Blackout {
  double begin_s = 0.0;
  double end_s = 0.0;
};

/// Reads "T0:T1", seconds, T0 < T1. On failure `objection` gives the reason.
Blackout blackout_from(const std::string& word, std::string& objection);

/// Takes the observations of the scans inside the blackouts out of the recording, with their labels; the scans' times
/// and the odometry stay. Returns, for each scan, whether it is withheld: such a scan is not to be fed to an estimator,
/// to which an empty scan would mean that nothing was there. InputError for a blackout that contains no scan of the log.
/// Test: apps/blackout_test.cpp.
std::vector<bool> withhold(core::Recording& recording, const std::vector<Blackout>& blackouts);

}  // namespace helixnav::apps
