// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "common/commands.hpp"
#include "common/fit_to_recording.hpp"
#include "helixnav/logs/field_of_view.hpp"
#include "helixnav/logs/own_log.hpp"
#include "helixnav/logs/read_recording.hpp"
#include "log_page.hpp"
#include "settings/config_file.hpp"
#include "settings/deprecated_keys.hpp"
#include "settings/settings.hpp"
#include "settings/vehicle_option.hpp"

namespace helixnav::apps {
namespace {

struct CheckJob {
  std::string path;
  std::string vehicle;
  std::string config;
  Settings settings;
};

/// What the log lacks for each use of it, one line each.
std::string missing_text(const core::Recording& recording) {
  std::string text;
  if (recording.labels.empty()) {
    text += "missing     identities of detections (column id): 'smooth' and --association known need them\n";
  }
  if (recording.true_poses.empty() && recording.true_positions.empty()) {
    text += "missing     truth_poses.csv or fixes.csv: errors cannot be judged\n";
  }
  return text;
}

/// What to do next.
std::string ready_text(const core::Recording& recording, bool known_association) {
  const bool by_identity = !known_association && fixes_no_point(recording);
  const std::string how = by_identity ? " by its identities: helixnav replay it with --association known" : "";
  if (!recording.remarks.empty()) return "it can be navigated" + how + "; look at the notes first";
  return by_identity ? "it can be navigated" + how : "nothing is doubtful: helixnav replay it";
}

void print_settings(const CheckJob& job, const core::Recording& recording) {
  if (job.settings.fastslam.chosen) {
    std::printf("settings    %s\n", text_of(job.settings.fastslam).c_str());
    return;
  }
  const supervisor::NavigatorOptions options = fit_to_recording(job.settings, recording);
  std::printf(
      "settings    association %s, detection probability %.3g (existence %.3g), %.3g detections of nothing mapped a "
      "scan\n",
      job.settings.known_association ? "known" : std::string(association::name(options.method)).c_str(),
      options.association.detection_probability, options.life.detection_probability, options.extraneous_per_scan);
  std::printf("            old after %.3g m, search up to %.3g m, cells of %.3g m; all: helixnav replay --help-all\n",
              options.search.old_after_m, options.search.undecided_m, options.filter.cell_side_m);
}

ExitCode check(CLI::App& command, CheckJob& job) {
  const GivenOptions given = options_given(command);
  if (!job.config.empty()) apply_config_file(command, job.config);
  check_filter(command, given, job.settings.fastslam);
  warn_of_deprecated_keys(command);
  apply_vehicle(command, job.vehicle, job.path, job.settings);
  const logs::LogFormat format = logs::recognise(job.path);
  std::printf("log         %s, format %s\n", job.path.c_str(), std::string(logs::name_of(format)).c_str());
  if (format == logs::LogFormat::own) {
    const std::string beside = logs::vehicle_beside(job.path).string();
    const std::string vehicle = job.vehicle.empty() ? beside : job.vehicle;
    std::printf("vehicle     %s\n",
                vehicle.empty() ? "none: no vehicle.toml beside the log and no --vehicle" : vehicle.c_str());
    std::fputs(tables_text(logs::read_own_log(job.path)).c_str(), stdout);
  }
  core::Recording recording = logs::read_recording(job.path, job.settings.logs);
  if (job.settings.logs.vehicle) tell_vehicle(recording, format, *job.settings.logs.vehicle);
  apply_log_settings(recording, job.settings);
  std::fputs(events_text(recording, job.settings.logs.vehicle ? &*job.settings.logs.vehicle : nullptr).c_str(), stdout);
  print_settings(job, recording);
  std::fputs(missing_text(recording).c_str(), stdout);
  for (const std::string& remark : recording.remarks) std::printf("note        %s\n", remark.c_str());
  std::printf("ready       %s\n", ready_text(recording, job.settings.known_association).c_str());
  return ExitCode::ok;
}

}  // namespace

void add_check_command(CLI::App& app, ExitCode& code) {
  CLI::App* command = app.add_subcommand("check", "Report what was understood of a log, and what is doubtful");
  const auto job = std::make_shared<CheckJob>();
  command->add_option("PATH", job->path, "Log: file or folder; the format is recognised")->required();
  add_vehicle_option(*command, job->vehicle);
  command->add_option("--config", job->config, "INI or TOML file of the settings (helixnav config --dump)")
      ->type_name("FILE");
  add_settings(*command, job->settings);
  command->footer(
      "Reads the log as replay does and navigates nothing. Exit code 3 where replay could not use it.\n\n"
      "Examples:\n"
      "  helixnav check my_drive\n"
      "  helixnav check my_drive --vehicle other.toml\n");
  command->callback([command, job, &code] { code = check(*command, *job); });
}

}  // namespace helixnav::apps
