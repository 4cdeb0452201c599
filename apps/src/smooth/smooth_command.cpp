// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/commands.hpp"
#include "common/input_files.hpp"
#include "common/missing_warnings.hpp"
#include "common/run_options.hpp"
#include "drive/drive.hpp"
#include "drive/kept_inputs.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/logs/graph_files.hpp"
#include "helixnav/logs/read_recording.hpp"
#include "helixnav/reports/finish_run.hpp"
#include "helixnav/runs/run_folder.hpp"
#include "helixnav/runs/run_recorder.hpp"
#include "helixnav/runs/run_writer.hpp"
#include "settings/validators.hpp"
#include "smoothing_run.hpp"

namespace helixnav::apps {
namespace {

using Clock = std::chrono::steady_clock;

struct SmoothJob {
  std::string path;
  std::string start = "odometry";
  double first_damping = 0.0;  ///< 0: by the start
  int max_iterations = 200;
  double max_seconds = 300.0;
  RunOptions run;
};

double elapsed_s(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

SmoothingTask read_task(const std::string& path, core::Recording& recording) {
  if (logs::recognise(path) == logs::LogFormat::g2o) {
    recording.name = std::filesystem::path(path).stem().string();
    return task_from_graph(logs::read_g2o(path));
  }
  recording = logs::read_recording(path);
  if (recording.labels.empty()) {
    throw core::InputError(path + ": smooth needs a labelled log or a graph, and this one has no labels; " +
                           "replay --smooth uses the associations of the filter");
  }
  return task_from_recording(recording, recording.labels);
}

bool starts_from_run(const std::string& start) {
  return start != "odometry" && start != "grown" && start != "softened";
}

void start_from_folder(const std::string& folder, SmoothingTask& task) {
  const runs::Run run = runs::read_run(folder);
  warn_of_missing(run.missing);
  std::vector<core::Pose2> poses;
  for (const core::StepReport& step : run.steps) poses.push_back(step.pose.mean);
  start_from_run(folder, run.steps, poses, run.map, task);
}

smoothing::SmoothOptions options_of(const SmoothJob& job) {
  smoothing::SmoothOptions options;
  if (job.start == "grown") options.start = smoothing::Start::grown;
  if (job.start == "softened") options.start = smoothing::Start::softened;
  options.solver.max_iterations = job.max_iterations;
  if (starts_from_run(job.start)) options.solver.first_damping = 1e-8;
  if (job.first_damping > 0.0) options.solver.first_damping = job.first_damping;
  const bool shown = !job.run.quiet && isatty(STDERR_FILENO) == 1;
  options.solver.go_on = [begin = Clock::now(), most_s = job.max_seconds,
                          shown](const std::vector<smoothing::Iteration>& steps) {
    if (shown && !steps.empty()) {
      std::fprintf(stderr, "\r%4zu iterations, chi2 %.6g  ", steps.size(), steps.back().chi2.cost);
    }
    return elapsed_s(begin) < most_s;
  };
  return options;
}

ExitCode smooth(CLI::App& command, SmoothJob& job) {
  prepare_run(command, job.run);
  refuse_to_replace({job.path, starts_from_run(job.start) ? job.start : ""}, job.run.out);
  const Clock::time_point begin = Clock::now();
  Drive task_info;  // for its manifest
  SmoothingTask task = read_task(job.path, task_info.recording);
  if (starts_from_run(job.start)) start_from_folder(job.start, task);
  const double reading_s = elapsed_s(begin);
  SmoothingResult result = solve(task, options_of(job));
  if (!job.run.quiet && isatty(STDERR_FILENO) == 1) std::fputs("\r\033[K", stderr);
  fill_drive(task_info, job.run, "");
  task_info.manifest.inputs = input_files(job.path);

  using IfNotEmpty = runs::RunWriter::IfNotEmpty;
  runs::RunWriter writer(job.run.out, task_info.manifest, task_info.recording,
                         job.run.overwrite ? IfNotEmpty::overwrite : IfNotEmpty::refuse);
  runs::RunRecorder recorder(job.run.out, task_info.manifest, task_info.recording);
  for (const core::StepReport& step : steps_of(task, result.started)) {
    writer.write(step, 0.0);
    recorder.add(step, 0.0);
  }
  std::fputs(text_of(task, result).c_str(), stdout);
  runs::Run run = recorder.finish(result.run.map_after);
  run.numbers = result.numbers;
  run.timing = {{"reading_s", reading_s}, {"solving_s", result.solving_s}};
  result.run.alone = true;
  runs::add_smoothed(run, std::move(result.run));
  reports::finish_run(run, writer);
  std::printf("reading %.3f s\nrun folder: %s   report: %s/report.html\n", reading_s, job.run.out.c_str(),
              job.run.out.c_str());
  return ExitCode::ok;
}

}  // namespace

void add_smooth_command(CLI::App& app, ExitCode& code) {
  CLI::App* command = app.add_subcommand("smooth", "Batch optimum of a labelled log or graph by sparse least squares");
  const auto job = std::make_shared<SmoothJob>();
  command->add_option("PATH", job->path, "Labelled log or graph; the format is recognised")->required();
  add_folder_options(*command, job->run);
  command
      ->add_option("--start", job->start,
                   "Start values: odometry (a g2o file: its own), grown (stage by stage), softened (odometry weakened\n"
                   "first), or the run folder of a replay of the same log")
      ->capture_default_str()
      ->type_name("odometry|grown|softened|RUN");
  command->add_option("--max-seconds", job->max_seconds, "Stop at the best solution found after so long")
      ->check(number_between(0.001, 1e6))
      ->capture_default_str();
  command->add_option("--max-iterations", job->max_iterations, "Give up after so many")
      ->check(number_between(1, 100000))
      ->capture_default_str();
  command
      ->add_option("--first-damping", job->first_damping,
                   "Of Levenberg-Marquardt; default 1e-4, and 1e-8 from a run folder")
      ->check(number_between(1e-16, 1e6));
  command->footer(
      "trajectory.tum holds the start, trajectory_final.tum and map.csv the optimum.\n\n"
      "Examples:\n"
      "  helixnav smooth map.circles --out runs/dlr\n"
      "  helixnav smooth isam_victoriaPark.txt --start runs/graph --out runs/optimum\n");
  command->callback([command, job, &code] { code = smooth(*command, *job); });
}

}  // namespace helixnav::apps
