// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/runs/run_manifest.hpp"
#include "team/team_drive.hpp"
#include "team/team_evaluation.hpp"

namespace helixnav::apps {

/// Writes the run folder of a team (docs/team.md): a run folder robot_N for each robot, and for the whole team
/// map.csv, joins.csv, sightings.csv, summary.json and report.html.
void write_team(const std::string& folder, bool overwrite, const runs::RunManifest& manifest, const TeamTask& task,
                const TeamDrive& drive, const TeamEvaluation& evaluation);

/// The text of summary.json.
std::string team_summary(const TeamTask& task, const TeamDrive& drive, const TeamEvaluation& evaluation);

/// The evaluation for the terminal.
std::string team_text(const TeamTask& task, const TeamDrive& drive, const TeamEvaluation& evaluation);

/// The text of report.html: all paths, landmarks and joins, a picture without a script.
std::string team_page(const std::string& command, const TeamTask& task, const TeamDrive& drive,
                      const TeamEvaluation& evaluation);

}  // namespace helixnav::apps
