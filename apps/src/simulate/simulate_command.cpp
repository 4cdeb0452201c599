// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <limits>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "common/commands.hpp"
#include "common/config_file.hpp"
#include "common/fit_to_recording.hpp"
#include "common/run_options.hpp"
#include "common/scenario_settings.hpp"
#include "common/settings.hpp"
#include "common/validators.hpp"
#include "drive/drive.hpp"
#include "helixnav/logs/field_of_view.hpp"
#include "helixnav/sim/simulate.hpp"

namespace helixnav::apps {
namespace {

struct SimulateJob {
  std::string scenario = "large-loop";
  std::uint64_t seed = 1;
  RunOptions run;
  ScenarioSettings scenario_settings;
  Settings settings;
};

std::string scenario_list() {
  std::string list = "Scenarios:\n";
  for (const std::string& name : sim::scenario_names()) {
    list += "  " + name + std::string(name.size() < 22 ? 22 - name.size() : 1, ' ') +
            sim::named_scenario(name).description + '\n';
  }
  return list;
}

ExitCode simulate(CLI::App& command, SimulateJob& job) {
  prepare_run(command, job.run);
  Drive task;
  task.recording = sim::simulate(scenario_of(job.scenario, job.scenario_settings), job.seed);
  task.navigator = fit_to_recording(job.settings, task.recording);
  const std::string sensor_text = lengths_text(task.navigator, logs::field_of_view_of(task.recording));
  fill_drive(task, job.run, dump_config(command) + sensor_text);
  task.known_association = job.settings.known_association;
  task.manifest.seed = job.seed;
  return drive(task);
}

}  // namespace

void add_simulate_command(CLI::App& app, ExitCode& code) {
  CLI::App* command = app.add_subcommand("simulate", "Drive through a world with known truth");
  const auto job = std::make_shared<SimulateJob>();
  command->add_option("SCENARIO", job->scenario, "One of the scenarios below")
      ->capture_default_str()
      ->check(one_of(sim::scenario_names()));
  command->add_option("--seed", job->seed, "Seed of every random stream")
      ->capture_default_str()
      ->check(number_between(std::uint64_t{0}, std::numeric_limits<std::uint64_t>::max()));
  add_run_options(*command, job->run);
  add_scenario_settings(*command, job->scenario_settings);
  add_settings(*command, job->settings);
  command->footer(scenario_list() + "\nExample:\n  helixnav simulate large-loop --seed 1 --out runs/loop\n");
  command->callback([command, job, &code] { code = simulate(*command, *job); });
}

}  // namespace helixnav::apps
