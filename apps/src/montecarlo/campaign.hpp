// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "common/exit_code.hpp"
#include "helixnav/sim/scenario.hpp"
#include "helixnav/supervisor/navigator.hpp"

namespace helixnav::apps {

/// One scenario driven with many seeds, each run judged against the truth.
struct Campaign {
  sim::Scenario scenario;
  supervisor::NavigatorOptions navigator;
  bool known_association = false;
  std::uint64_t first_seed = 1;
  std::uint64_t runs = 100;
  unsigned jobs = 1;  ///< runs at a time; results do not depend on it
  std::string out;
  std::string config;  ///< in force, as written by dump_config
  bool overwrite = false;
  bool quiet = false;
};

/// Drives the seeds that the folder does not hold yet, writes a line of runs.jsonl as each run ends, then sorts the
/// lines by seed, summarises all in the folder, prints the table on stdout and writes summary.json. On SIGINT the
/// current runs are abandoned, to be driven again by the next call, and the code is `interrupted`. InputError if the
/// folder holds something else or another campaign. Test: apps/montecarlo/montecarlo_test.cpp.
ExitCode run_campaign(const Campaign& campaign);

}  // namespace helixnav::apps
