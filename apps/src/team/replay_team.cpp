// SPDX-License-Identifier: BSD-3-Clause
#include "team/replay_team.hpp"

#include <cstdio>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/version.hpp"
#include "helixnav/logs/mrclam.hpp"
#include "team/team_drive.hpp"
#include "team/team_evaluation.hpp"
#include "team/team_folder.hpp"

namespace helixnav::apps {

ExitCode replay_team(const std::string& path, const TeamChoice& choice, const RunOptions& run, const Settings& settings,
                     const std::string& config) {
  TeamTask task;
  task.recording = logs::read_mrclam(path, choice.robots, settings.logs.mrclam);
  if (!choice.unknown_starts && !task.recording.starts_known) {
    throw core::InputError(path + ": not all robots have a true pose at their first command: give --unknown-starts");
  }
  task.unknown_starts = choice.unknown_starts;
  task.known_association = !settings.unknown_association;
  task.quiet = run.quiet;
  task.options.join.by_names = task.known_association;
  task.options.join.by_constellation = !task.known_association;
  for (const std::string& remark : task.recording.remarks) std::fprintf(stderr, "helixnav: %s\n", remark.c_str());
  if (task.recording.misread > 0) std::printf("%d misread barcodes left out\n", task.recording.misread);
  runs::RunManifest manifest;
  manifest.version = core::version();
  manifest.commit = core::commit();
  manifest.command = command_line_text();
  manifest.config = config;
  manifest.inputs = input_files(path);
  const TeamDrive drive = drive_team(task);
  const TeamEvaluation evaluation = evaluate_team(task, drive);
  write_team(run.out, run.overwrite, manifest, task, drive, evaluation);
  std::fputs(team_text(task, drive, evaluation).c_str(), stdout);
  std::printf("navigated in %.1f s; run folder: %s   report: %s/report.html\n", drive.seconds, run.out.c_str(),
              run.out.c_str());
  return ExitCode::ok;
}

}  // namespace helixnav::apps
