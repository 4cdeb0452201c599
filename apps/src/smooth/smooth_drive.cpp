// SPDX-License-Identifier: BSD-3-Clause
#include "smooth_drive.hpp"

#include <cstdio>
#include <string>
#include <utility>
#include <variant>

#include "drive/taken_out.hpp"
#include "helixnav/core/errors.hpp"
#include "smoothing_run.hpp"

namespace helixnav::apps {
namespace {

SmoothingResult solved(const Drive& job, const runs::Run& run, std::string& text) {
  core::Recording recording;
  recording.start = job.recording.start;
  for (const core::Event& event : job.recording.events) {
    if (!std::holds_alternative<core::AbsoluteFix>(event)) recording.events.push_back(event);
  }
  recording = without_taken_out(run, std::move(recording));
  SmoothingTask task = task_from_recording(recording, ids_of_run(run.steps, recording));
  std::vector<core::Pose2> poses;
  for (const core::StepReport& step : run.steps) poses.push_back(step.pose.mean);
  start_from_run(job.out, run.steps, poses, run.map, task);
  smoothing::SmoothOptions options;
  options.solver.first_damping = 1e-8;  // the filter's result is a good start
  SmoothingResult result = solve(task, options);
  text = text_of(task, result);
  return result;
}

}  // namespace

std::string smooth(const Drive& job, runs::Run& run) {
  std::string text;
  SmoothingResult result = solved(job, run, text);
  run.numbers.insert(run.numbers.end(), result.numbers.begin(), result.numbers.end());
  run.timing.emplace_back("smoothing_s", result.solving_s);
  runs::add_smoothed(run, std::move(result.run));
  return text;
}

ExitCode smooth_drive(const Drive& job, runs::Run& run) {
  try {
    std::printf("smoothed: %s", smooth(job, run).c_str());
    return ExitCode::ok;
  } catch (const core::InputError& error) {
    std::fprintf(stderr, "helixnav: the run cannot be smoothed: %s\n", error.what());
    return ExitCode::data;
  } catch (const core::NumericalError& error) {
    std::fprintf(stderr, "helixnav: the run cannot be smoothed: %s\n", error.what());
    return ExitCode::numerical;
  }
}

}  // namespace helixnav::apps
