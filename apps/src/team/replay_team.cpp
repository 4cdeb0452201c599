// SPDX-License-Identifier: BSD-3-Clause
#include "team/replay_team.hpp"

#include <chrono>
#include <cstdio>
#include <utility>

#include <CLI/CLI.hpp>

#include "common/input_files.hpp"
#include "common/interrupt.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/version.hpp"
#include "helixnav/logs/mrclam.hpp"
#include "helixnav/sim/team_world.hpp"
#include "settings/config_file.hpp"
#include "team/team_drive.hpp"
#include "team/team_evaluation.hpp"
#include "team/team_folder.hpp"
#include "team/team_warnings.hpp"

namespace helixnav::apps {
namespace {

ExitCode navigate(const TeamTask& task, runs::RunManifest manifest, const RunOptions& run, const std::string& config) {
  manifest.version = core::version();
  manifest.commit = core::commit();
  manifest.command = command_line_text();
  manifest.config = config;
  catch_interrupts(
      std::chrono::minutes(5));  // nothing is written before the end, and a replay after a wrong join takes long
  const TeamDrive drive = drive_team(task);
  const bool whole = !interrupted();
  const TeamEvaluation evaluation = evaluate_team(task, drive);
  write_team(run.out, run.overwrite, manifest, task, drive, evaluation);
  std::fputs(team_text(task, drive, evaluation).c_str(), stdout);
  std::printf("navigated in %.1f s; run folder: %s   report: %s/report.html\n", drive.seconds, run.out.c_str(),
              run.out.c_str());
  for (const std::string& warning : team_warnings(task, drive)) {
    std::fprintf(stderr, "helixnav: warning: %s\n", warning.c_str());
  }
  if (whole) return ExitCode::ok;
  std::fprintf(stderr, "helixnav: interrupted; the run folder is complete up to there\n");
  return ExitCode::interrupted;
}

}  // namespace

void refuse_settings_of_one_robot(const GivenOptions& given, const Settings& settings) {
  for (const CLI::Option* option : given) {
    const std::string key = key_of(*option);
    const bool association =
        key == "association.method" && (settings.known_association || settings.unknown_association);
    if (association || key.rfind("mrclam.", 0) == 0) continue;
    throw CLI::ValidationError("--" + key, "is not for several robots (--association known or unknown is)");
  }
}

void refuse_options_of_a_team(const CLI::App& command, const std::vector<std::string>& options,
                              const Settings& settings) {
  for (const std::string& name : options) {
    if (command.get_option(name)->count() > 0) throw CLI::ValidationError(name, "is for several robots");
  }
  if (settings.unknown_association) throw CLI::ValidationError("--association unknown", "is for several robots");
}

ExitCode replay_team(const std::string& path, const TeamChoice& choice, const RunOptions& run, const Settings& settings,
                     const std::string& config) {
  TeamTask task = task_of(logs::read_mrclam(path, choice.robots, settings.logs.mrclam), choice.unknown_starts,
                          !settings.unknown_association);
  task.quiet = run.quiet;
  for (const std::string& remark : task.recording.remarks) std::fprintf(stderr, "helixnav: %s\n", remark.c_str());
  if (task.recording.misread > 0) std::printf("%d misread barcodes left out\n", task.recording.misread);
  runs::RunManifest manifest;
  manifest.inputs = input_files(path);
  return navigate(task, std::move(manifest), run, config);
}

ExitCode simulate_team(int robots, std::uint64_t seed, bool unknown_starts, const RunOptions& run,
                       const Settings& settings, const std::string& config) {
  sim::TeamWorldOptions world;
  world.robots = robots;
  world.see_each_other = true;
  TeamTask task = task_of(sim::simulate_team(world, seed), unknown_starts, !settings.unknown_association);
  task.quiet = run.quiet;
  runs::RunManifest manifest;
  manifest.seed = seed;
  return navigate(task, std::move(manifest), run, config);
}

}  // namespace helixnav::apps
