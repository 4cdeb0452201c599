// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "common/commands.hpp"
#include "common/input_files.hpp"
#include "common/run_options.hpp"
#include "drive/drive_again.hpp"
#include "drive/kept_inputs.hpp"
#include "helixnav/core/version.hpp"
#include "settings/config_file.hpp"
#include "settings/memory_limit.hpp"
#include "settings/vehicle_option.hpp"
#include "stream.hpp"

namespace helixnav::apps {
namespace {

struct StreamOptions {
  std::string vehicle;
  RunOptions run;
  StreamJob job;
};

ExitCode run_stream(CLI::App& command, StreamOptions& options) {
  const GivenOptions given = options_given(command);
  prepare_run(command, options.run);
  StreamJob& job = options.job;
  require_compressed_ekf(command, given, job.settings.fastslam, "a stream is navigated by the compressed EKF");
  refuse_memory_limit(job.settings, "a stream ends when its input does");
  if (job.settings.gps.fuse) throw CLI::ValidationError("--gps fuse", "needs a whole log: a stream uses no fixes");
  if (!job.resume.empty() && job.settings.known_association)
    throw CLI::ValidationError("--resume",
                               "is for streams without identities: a drive by name keeps none of what it was fed");
  refuse_to_replace({job.resume, options.vehicle, options.run.config}, options.run.out);
  apply_vehicle(command, options.vehicle, "", job.settings);
  job.out = options.run.out;
  job.overwrite = options.run.overwrite;
  job.manifest.version = core::version();
  job.manifest.commit = core::commit();
  job.manifest.command = command_line_text();
  job.manifest.recording = "stream";
  job.manifest.config = dump_config(command);
  job.manifest.inputs = vehicle_inputs(options.vehicle);
  if (!job.resume.empty()) job.manifest.inputs.push_back(input_files(drive_file_in(job.resume)).front());
  return stream(job);
}

}  // namespace

void add_stream_command(CLI::App& app, ExitCode& code) {
  CLI::App* command = app.add_subcommand("stream", "Navigate live: JSON Lines in, one answer line per scan out");
  const auto options = std::make_shared<StreamOptions>();
  add_vehicle_option(
      *command, options->vehicle,
      ", whose sensors say what they see (view_deg, reach_m); those that ship leave it to the log: write it "
      "into a copy (helixnav new-vehicle DIR --like NAME)");
  command->get_option("--vehicle")->required();
  command
      ->add_option("--listen", options->job.listen,
                   "Serve one client after another on unix:PATH or tcp:PORT of 127.0.0.1, not the standard streams")
      ->type_name("ADDRESS");
  command->add_option("--out", options->run.out, "Run folder to write beside; must be empty or new")->type_name("DIR");
  command->add_flag("--overwrite", options->run.overwrite, "Replace the files of an earlier run in --out");
  command
      ->add_option("--resume", options->job.resume,
                   "First drive again what a stream into this run folder was fed, until it ended or was killed")
      ->type_name("RUN");
  command->add_option("--config", options->run.config, "INI or TOML file of the settings (helixnav config --dump)")
      ->type_name("FILE");
  add_settings(*command, options->job.settings);
  command->footer(
      "Lines as in docs/your_own_log.md, answers as in docs/live.md. Ends with the input, on SIGINT and on SIGTERM.\n\n"
      "Examples:\n"
      "  helixnav stream --vehicle vehicle.toml --out runs/live < drive.jsonl\n"
      "  mkfifo lines; helixnav stream --vehicle vehicle.toml < lines\n"
      "  helixnav stream --vehicle vehicle.toml --resume runs/live --out runs/live_2 < rest.jsonl\n"
      "  helixnav stream --vehicle vehicle.toml --listen unix:/run/user/1000/helixnav\n");
  command->callback([command, options, &code] { code = run_stream(*command, *options); });
}

}  // namespace helixnav::apps
