// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/commands.hpp"
#include "common/fit_to_recording.hpp"
#include "common/input_files.hpp"
#include "common/missing_warnings.hpp"
#include "common/run_options.hpp"
#include "drive/drive.hpp"
#include "drive/drive_again.hpp"
#include "drive/kept_inputs.hpp"
#include "drive/start_by_names.hpp"
#include "drive/start_option.hpp"
#include "drive/truth_on_map.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/logs/field_of_view.hpp"
#include "helixnav/sim/part_of.hpp"
#include "helixnav/sim/simulate.hpp"
#include "settings/config_file.hpp"
#include "settings/scenario_settings.hpp"
#include "settings/settings.hpp"
#include "settings/validators.hpp"
#include "settings/vehicle_option.hpp"
#include "team/replay_team.hpp"

namespace helixnav::apps {
namespace {

struct SimulateJob {
  std::string scenario = "large-loop";
  std::uint64_t seed = 1;
  std::optional<std::uint64_t> day;
  double from_s = 0.0;
  double until_s = 1e9;
  std::string map;
  std::optional<SessionStart> start;
  RunOptions run;
  int robots = 2;
  bool unknown_starts = false;
  ScenarioSettings scenario_settings;
  Settings settings;
};

constexpr const char* team_scenario = "team";

std::vector<std::string> names_of_scenarios() {
  std::vector<std::string> names = sim::scenario_names();
  names.emplace_back(team_scenario);
  return names;
}

std::string scenario_list() {
  std::string list = "Scenarios:\n";
  for (const std::string& name : sim::scenario_names()) {
    list += "  " + name + std::string(name.size() < 22 ? 22 - name.size() : 1, ' ') +
            sim::named_scenario(name).description + '\n';
  }
  return list +
         "  team                  robots side by side that see each other and ten landmarks of each neighbour's\n";
}

std::optional<runs::FedDrive> driven_before(const SimulateJob& job) {
  if (job.settings.known_association || !is_driven_again(job.map, job.start)) return std::nullopt;
  return runs::read_drive(drive_file_in(job.map));
}

/// Another day is another drive through the same world: other noise, other detections. If a drive is continued, what comes
/// after it.
core::Recording recording_of(const SimulateJob& job, const std::optional<runs::FedDrive>& before) {
  const sim::Scenario scenario = scenario_of(job.scenario, job.scenario_settings);
  core::Recording whole =
      sim::simulate_in(sim::build_world(scenario.world, job.seed), scenario, job.day.value_or(job.seed));
  const core::Nanoseconds from_ns = core::nanoseconds_from_seconds(job.from_s);
  const core::Nanoseconds until_ns = core::nanoseconds_from_seconds(job.until_s);
  if (before && !before->events.empty()) {
    return sim::rest_of(whole, std::max(from_ns, core::time_of(before->events.back()) + 1), until_ns);
  }
  if (job.from_s == 0.0 && job.until_s == 1e9) return whole;
  core::Recording part = sim::part_of(whole, from_ns, until_ns);
  if (part.true_poses.empty()) throw core::InputError("--from, --until: no scan of the drive lies between them");
  part.start.mean = part.true_poses.front().T_world_robot;
  return part;
}

void add_sessions(CLI::App& command, SimulateJob& job) {
  const auto any = number_between(std::uint64_t{0}, std::numeric_limits<std::uint64_t>::max());
  command.add_option("--day", job.day, "Seed of the drive's noise, in the world of --seed (default: --seed)")
      ->check(any);
  command.add_option("--from", job.from_s, "Begin with this second of the drive")->check(number_between(0.0, 1e9));
  command.add_option("--until", job.until_s, "End with this second of the drive")->check(number_between(0.0, 1e9));
  CLI::Option* map = command.add_option("--map", job.map, "Go on in the map of an earlier run: its folder");
  map->type_name("RUN");
  add_start_option(command, job.start)->needs(map);
}

ExitCode simulate_robots(const CLI::App& command, const SimulateJob& job, const GivenOptions& given) {
  for (const char* name : {"--day", "--from", "--until", "--map", "--start"}) {
    if (command.get_option(name)->count() > 0) throw CLI::ValidationError(name, "is not for several robots");
  }
  refuse_settings_of_one_robot(given, job.settings);
  return simulate_team(job.robots, job.seed, job.unknown_starts, job.run, job.settings, dump_config(command));
}

ExitCode simulate(CLI::App& command, SimulateJob& job) {
  const GivenOptions given = options_given(command);
  prepare_run(command, job.run);
  refuse_to_replace({job.map, job.run.config}, job.run.out);
  if (job.scenario == team_scenario) return simulate_robots(command, job, given);
  refuse_options_of_a_team(command, {"--robots", "--unknown-starts"}, job.settings);
  check_filter(command, given, job.settings.fastslam);
  if (job.settings.fastslam.chosen && !job.map.empty())
    throw CLI::ValidationError("--map", "--filter fastslam begins a map of its own");
  Drive task;
  std::optional<runs::FedDrive> before = driven_before(job);
  task.recording = recording_of(job, before);
  if (before) put_truth_behind(job.map, put_before(*std::move(before), task.recording, task.withheld), task.recording);
  print_remarks(task.recording);
  task.navigator = fit_to_recording(job.settings, task.recording);
  fill_drive(task, job.run, dump_config(command) + in_force_text(job.settings, task.navigator, task.recording));
  choose_filter(task, job.settings);
  task.manifest.seed = job.seed;
  if (before) {
    task.manifest.inputs = input_files(drive_file_in(job.map));
  } else if (!job.map.empty()) {
    task.earlier = read_earlier_session(job.map, job.start.value_or(SessionStart{}));
    warn_of_missing(task.earlier->missing);
    task.manifest.inputs = input_files(joint_map_file_in(job.map));
    const std::string begun = begin_by_names(task);
    if (!begun.empty()) std::fprintf(stderr, "helixnav: note: %s\n", begun.c_str());
    put_truth_on_map(task);
  }
  return drive(task);
}

}  // namespace

void add_simulate_command(CLI::App& app, ExitCode& code) {
  CLI::App* command = app.add_subcommand("simulate", "Drive through a world with known truth");
  const auto job = std::make_shared<SimulateJob>();
  command->add_option("SCENARIO", job->scenario, "One of the scenarios below")
      ->capture_default_str()
      ->check(one_of(names_of_scenarios()));
  command->add_option("--seed", job->seed, "Seed of every random stream")
      ->capture_default_str()
      ->check(number_between(std::uint64_t{0}, std::numeric_limits<std::uint64_t>::max()));
  add_sessions(*command, *job);
  command->add_option("--robots", job->robots, "Of team: how many")->check(number_between(2, 9))->type_name("N");
  command->add_flag("--unknown-starts", job->unknown_starts, "Of team: the robots are not given their starts");
  add_run_options(*command, job->run);
  add_scenario_settings(*command, job->scenario_settings);
  add_settings(*command, job->settings);
  command->footer(scenario_list() +
                  "\nExamples:\n  helixnav simulate large-loop --seed 1 --out runs/loop\n"
                  "  helixnav simulate town --seed 1 --until 700 --out runs/monday\n"
                  "  helixnav simulate town --seed 1 --day 2 --from 300 --map runs/monday --out runs/tuesday\n"
                  "  helixnav simulate team --robots 4 --unknown-starts --out runs/four\n"
                  "  helixnav simulate circuit --filter fastslam --out runs/particles\n");
  command->callback([command, job, &code] { code = simulate(*command, *job); });
}

}  // namespace helixnav::apps
