// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "team_trial.hpp"

namespace helixnav::apps {

/// A world that was driven, or is to be.
struct TeamWorld {
  std::uint64_t seed = 0;
  TeamTrial trial;
  TeamVerdict verdict;
};

inline constexpr const char* team_rows_name = "runs.csv";
extern const char* const team_columns;  ///< first line of runs.csv

/// Lines of runs.csv.
std::string team_rows(const std::vector<TeamWorld>& worlds, std::size_t from, std::size_t count);

/// The worlds of the runs.csv of a folder; an incomplete last line is left out. InputError naming file and line.
std::vector<TeamWorld> read_team_rows(const std::string& folder);

/// Shares with 95 % Clopper-Pearson intervals, by kind of world.
nlohmann::ordered_json team_campaign_summary(const std::vector<TeamWorld>& worlds);

void print_team_campaign(const nlohmann::ordered_json& summary);

}  // namespace helixnav::apps
