// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/exit_code.hpp"

namespace helixnav::apps {

/// Worlds of robots with unknown starts and no names in common: how often their maps are joined, and how often falsely.
/// Each seed drives one world of each kind.
struct TeamCampaign {
  std::uint64_t runs = 100;
  std::uint64_t first_seed = 1;
  unsigned jobs = 1;
  std::string out;
  bool overwrite = false;
  bool quiet = false;
};

inline constexpr const char* team_scenario = "team";

/// Writes manifest.json, runs.csv, one row per world as it ends, and summary.json with 95 % Clopper-Pearson intervals; prints the summary.
ExitCode run_team_campaign(const TeamCampaign& campaign);

/// One campaign from its parts: manifest, rows in order of seed, and the summary as if it had been driven at once. InputError
/// for parts of other builds, a seed in two parts, and seeds with worlds not driven.
void merge_team_campaigns(const std::vector<std::string>& parts, const std::string& out);

}  // namespace helixnav::apps
