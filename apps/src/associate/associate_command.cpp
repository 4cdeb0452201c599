// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "association_trial.hpp"
#include "common/chosen_navigator.hpp"
#include "common/commands.hpp"
#include "common/fit_to_recording.hpp"
#include "common/interrupt.hpp"
#include "common/progress_bar.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/event_loop.hpp"
#include "helixnav/core/nearest_name.hpp"
#include "helixnav/logs/read_recording.hpp"
#include "helixnav/sim/ihgr_circle.hpp"
#include "helixnav/sim/simulate.hpp"
#include "settings/config_file.hpp"
#include "settings/memory_limit.hpp"
#include "settings/settings.hpp"
#include "settings/validators.hpp"

namespace helixnav::apps {
namespace {

struct AssociateJob {
  std::string input;
  std::vector<std::string> methods;
  std::uint64_t seed = 1;
  int runs = 1;
  std::int64_t scan = -1;
  bool quiet = false;
  std::string config;
  Settings settings;
};

std::vector<std::string> known_scenarios() {
  std::vector<std::string> names = sim::scenario_names();
  names.emplace_back("ihgr-circle");
  names.emplace_back("ihgr-circle-close");
  return names;
}

bool is_scenario(const std::string& input) {
  const std::vector<std::string> names = known_scenarios();
  return std::find(names.begin(), names.end(), input) != names.end();
}

core::Recording recording_of(const AssociateJob& job, std::uint64_t seed) {
  if (job.input.rfind("ihgr-circle", 0) == 0 && is_scenario(job.input)) {
    sim::IhgrCircle world;
    world.close_features = job.input == "ihgr-circle-close";
    return sim::simulate_ihgr_circle(world, seed);
  }
  if (is_scenario(job.input)) return sim::simulate(sim::named_scenario(job.input), seed);
  if (!std::filesystem::exists(job.input)) {
    const std::string near = core::near_name(job.input, known_scenarios());
    throw core::InputError(job.input + ": neither a log nor a scenario" +
                           (near.empty() ? std::string() : "; the nearest scenario is '" + near + '\''));
  }
  core::Recording recording = logs::read_recording(job.input, job.settings.logs);
  apply_log_settings(recording, job.settings);
  return recording;
}

association::Method method_named(const std::string& name) {
  for (const association::Method method : association_methods()) {
    if (association::name(method) == name) return method;
  }
  throw core::InputError("unknown association method " + name);
}

/// Every method on every run; a log is one run.
ExitCode compare(const AssociateJob& job) {
  const int runs = is_scenario(job.input) ? job.runs : 1;
  std::vector<AssociationTrial> trials(job.methods.size());
  ProgressBar progress("associating", static_cast<std::size_t>(runs) * job.methods.size(), job.quiet);
  for (int run = 0; run < runs && !interrupted(); ++run) {
    const core::Recording recording = recording_of(job, job.seed + static_cast<std::uint64_t>(run));
    if (recording.labels.empty()) {
      throw core::InputError(recording.name + ": this log has no labels to compare with; --scan N needs none");
    }
    for (std::size_t m = 0; m < job.methods.size() && !interrupted(); ++m) {
      supervisor::NavigatorOptions options = fit_to_recording(job.settings, recording);
      options.method = method_named(job.methods[m]);
      try_association(recording, options, trials[m]);
      progress.advance_to(static_cast<std::size_t>(run) * job.methods.size() + m);
    }
  }
  std::fputs(association_table(job.methods, trials).c_str(), stdout);
  if (!interrupted()) return ExitCode::ok;
  std::fprintf(stderr, "helixnav: interrupted; the table holds what was done until then\n");
  return ExitCode::interrupted;
}

/// Navigates up to the scan and prints its matching matrix.
ExitCode show_scan(const AssociateJob& job) {
  const core::Recording recording = recording_of(job, job.seed);
  if (job.settings.known_association && recording.labels.empty()) {
    throw core::InputError(recording.name + ": --association known needs a labelled log, and this one has no labels");
  }
  ChosenNavigator navigator(recording, fit_to_recording(job.settings, recording), job.settings.known_association);
  core::EventLoop loop(recording.events, navigator);
  while (!interrupted()) {
    const std::vector<core::LandmarkId> before = navigator.filter().landmarks();
    const std::optional<core::StepReport> report = loop.next();
    if (!report) {
      throw core::InputError(recording.name + ": --scan " + std::to_string(job.scan) + " is beyond the last of " +
                             std::to_string(loop.steps()) + " scans (the first is 0)");
    }
    if (report->step != job.scan) continue;
    std::printf("scan %lld: %zu observations (rows), %zu landmarks (columns: id + 1), 0 is the dummy\n",
                static_cast<long long>(job.scan), report->associations.size(), before.size());
    std::fputs(matching_matrix(*report, before).c_str(), stdout);
    return ExitCode::ok;
  }
  return ExitCode::interrupted;
}

ExitCode associate(CLI::App& command, AssociateJob& job) {
  const GivenOptions given = options_given(command);
  if (!job.config.empty()) apply_config_file(command, job.config);
  require_compressed_ekf(command, given, job.settings.fastslam, "associate compares methods of the compressed EKF");
  refuse_memory_limit(job.settings, "associate compares whole drives");
  if (job.settings.gps.fuse) throw CLI::ValidationError("--gps fuse", "has no part in comparing associations");
  catch_interrupts();
  return job.scan >= 0 ? show_scan(job) : compare(job);
}

const char* const help_footer =
    "Columns: wrong, missed and spurious associations; runs without a wrong one and runs whose last pose is "
    "consistent\n"
    "with the truth (NEES within 99.9 %), with 95 % intervals; precision and recall of pairs of observations in per "
    "cent,\n"
    "recall also of pairs within one visit; mature landmarks for each true one mapped; time of a step, median and "
    "p99.\n\n"
    "Scenarios: those of 'helixnav simulate', and ihgr-circle, ihgr-circle-close after ihgr_zhang2005 "
    "(docs/ihgr.md).\n\n"
    "Examples:\n"
    "  helixnav associate ihgr-circle --runs 20\n"
    "  helixnav associate map.circles --methods likelihood-ratio,nearest-neighbour\n"
    "  helixnav associate data_set.mat --scan 87 --association ihgr-published\n";

}  // namespace

void add_associate_command(CLI::App& app, ExitCode& code) {
  CLI::App* command = app.add_subcommand("associate", "Compare association methods, or show how a scan was matched");
  const auto job = std::make_shared<AssociateJob>();
  std::vector<std::string> names;
  for (const association::Method method : association_methods()) names.emplace_back(association::name(method));
  job->methods = names;
  command->add_option("INPUT", job->input, "Labelled log (with --scan any log), or the name of a scenario")->required();
  command->add_option("--methods", job->methods, "Methods to compare, separated by commas; default: all")
      ->delimiter(',')
      ->check(one_of(names));
  command->add_option("--runs", job->runs, "Runs of a scenario, with seeds one after the other")
      ->capture_default_str()
      ->check(number_between(1, 100000));
  command->add_option("--seed", job->seed, "Seed of the first run of a scenario")
      ->capture_default_str()
      ->check(number_between(std::uint64_t{0}, std::numeric_limits<std::uint64_t>::max()));
  command
      ->add_option("--scan", job->scan,
                   "Print the matching matrix of this scan (from 0) with --association, instead of the table")
      ->check(number_between(std::int64_t{0}, std::numeric_limits<std::int64_t>::max()));
  command->add_flag("--quiet", job->quiet, "No progress bar");
  command->add_option("--config", job->config, "INI or TOML file of the settings below (helixnav config --dump)")
      ->type_name("FILE");
  add_settings(*command, job->settings);
  command->footer(help_footer);
  command->callback([command, job, &code] { code = associate(*command, *job); });
}

}  // namespace helixnav::apps
