// SPDX-License-Identifier: BSD-3-Clause
#include "drive.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "check_drive.hpp"
#include "common/interrupt.hpp"
#include "common/progress_bar.hpp"
#include "common/timed.hpp"
#include "drive_again.hpp"
#include "estimator.hpp"
#include "helixnav/core/decision_row.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/event_loop.hpp"
#include "helixnav/reports/finish_run.hpp"
#include "helixnav/reports/summary.hpp"
#include "helixnav/runs/run_recorder.hpp"
#include "helixnav/runs/run_writer.hpp"
#include "keeping.hpp"
#include "landmark_names.hpp"
#include "run_warnings.hpp"
#include "smooth/smooth_drive.hpp"
#include "systematic_motion.hpp"
#include "withholding.hpp"

namespace helixnav::apps {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// Value below which the given fraction of the times lies; 0 without times.
double quantile(std::vector<double> times, double fraction) {
  if (times.empty()) return 0.0;
  const auto nth = times.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(times.size() - 1));
  std::nth_element(times.begin(), nth, times.end());
  return *nth;
}

struct Driven {
  std::size_t steps = 0;
  std::vector<double> step_us;          ///< of each scan that was fed
  std::map<std::string, int> closings;  ///< how many of each verdict
  std::string broken;    ///< what broke down, in the mathematics or the program, and where; the run ended there
  double full_mb = 0.0;  ///< of memory in use when the limit ended the run
  bool is_start_ambiguous = false;  ///< see StartCheck
};

/// Peak resident memory of the process.
double peak_memory_mb() {
  rusage usage{};
  return getrusage(RUSAGE_SELF, &usage) == 0 ? static_cast<double>(usage.ru_maxrss) / 1024.0 : 0.0;
}

void count_closings(const core::StepReport& report, Driven& driven) {
  for (const core::Decision& decision : report.decisions) {
    if (core::is_closure(decision)) ++driven.closings[core::row_of(decision).verdict];
  }
}

/// The next step, or nothing at the end and if the mathematics broke down.
template <class Loop>
std::optional<core::StepReport> next_step(Loop& loop, Driven& driven) {
  try {
    return loop.next();
  } catch (const core::NumericalError& error) {
    driven.broken = error.what();  // with step and time
    return std::nullopt;
  } catch (const core::PreconditionError& error) {
    driven.broken = std::string("internal error: ") + error.what();
    return std::nullopt;
  }
}

/// Feeds all events except the withheld scans.
Driven navigate(const Drive& job, Estimator& estimator, runs::RunWriter& writer, runs::RunRecorder& recorder) {
  Driven driven;
  const std::unique_ptr<runs::DriveFile> file = kept_drive(job);
  Timed timed(estimator);
  Keeping kept(timed, file.get());
  Withholding seen(kept, job.withheld, estimator.pose);
  core::EventLoop loop(job.recording.events, seen);
  ProgressBar progress(job.given_map ? "localising" : "navigating", job.recording.events.size(), job.quiet);
  while (!interrupted()) {
    const std::optional<core::StepReport> step = next_step(loop, driven);
    progress.advance_to(loop.fed() - 1);
    if (!step) break;
    const double microseconds = seen.last_scan_was_withheld() ? 0.0 : 1e6 * timed.last_s();
    if (!seen.last_scan_was_withheld()) driven.step_us.push_back(microseconds);
    count_closings(*step, driven);
    writer.write(*step, microseconds);
    recorder.add(*step, microseconds);
    if (recorder.wants_map()) recorder.add_map(estimator.sketch ? estimator.sketch() : estimator.map());
    if (job.memory_mb > 0.0 && peak_memory_mb() > job.memory_mb) {
      driven.full_mb = peak_memory_mb();
      break;
    }
  }
  if (file) file->finish();
  driven.steps = static_cast<std::size_t>(loop.steps());
  return driven;
}

/// The run, with all that the estimator knows at its end. The estimator is gone before reports are made of it: it takes as much memory
/// as they do.
runs::Run navigated(const Drive& job, runs::RunWriter& writer, runs::RunRecorder& recorder, LabelAgreement& agreement,
                    Driven& driven) {
  Estimator estimator = estimator_of(job, agreement);
  driven = navigate(job, estimator, writer, recorder);
  runs::Run run = recorder.finish(estimator.map());
  run.names = landmark_names(job, run);
  run.joint_map = estimator.joint_map();
  if (run.joint_map) run.joint_map->drives = drives_in_map(job, run);
  driven.is_start_ambiguous = estimator.is_start_ambiguous && estimator.is_start_ambiguous();
  if (estimator.parts_apart) run.parts_apart = estimator.parts_apart();
  if (estimator.particle_end) run.particle_end = estimator.particle_end();
  return run;
}

/// Reports problems on stderr.
ExitCode verdict(const Drive& job, const Driven& driven, const runs::Run& run, const evaluation::Evaluation& evaluation,
                 ExitCode smoothed) {
  if (!driven.broken.empty()) {
    std::fprintf(stderr, "helixnav: %s\nhelixnav: map and report of what was navigated until then are written\n",
                 driven.broken.c_str());
    return ExitCode::numerical;
  }
  if (driven.full_mb > 0.0) {
    std::fprintf(
        stderr,
        "helixnav: after %zu steps %.0f MB of memory are taken, more than the %.0f of --map.memory_mb; map and "
        "report of what was navigated until then are written\n",
        driven.steps, driven.full_mb, job.memory_mb);
    return ExitCode::data;
  }
  if (interrupted()) {
    std::fprintf(stderr, "helixnav: interrupted after %zu steps; the run folder is complete up to there\n",
                 driven.steps);
    return ExitCode::interrupted;
  }
  for (const std::string& warning : warnings_of(run, evaluation)) {
    std::fprintf(stderr, "helixnav: warning: %s\n", warning.c_str());
  }
  return smoothed;
}

}  // namespace

ExitCode drive(const Drive& job) {
  check_drive(job);
  catch_interrupts();
  const Clock::time_point begin = Clock::now();
  using IfNotEmpty = runs::RunWriter::IfNotEmpty;
  runs::RunWriter writer(job.out, job.manifest, job.recording,
                         job.overwrite ? IfNotEmpty::overwrite : IfNotEmpty::refuse);
  runs::RunRecorder recorder(job.out, job.manifest, job.recording);
  LabelAgreement agreement;
  Driven driven;
  runs::Run run = navigated(job, writer, recorder, agreement, driven);
  const std::vector<double>& step_us = driven.step_us;
  run.timing = {{"median_us", quantile(step_us, 0.5)},
                {"p99_us", quantile(step_us, 0.99)},
                {"max_us", quantile(step_us, 1.0)},
                {"reading_s", job.reading_s},
                {"navigating_s", seconds_since(begin)}};
  run.numbers = numbers_of(agreement);
  if (!job.withheld.empty()) {
    const auto withheld = std::count(job.withheld.begin(), job.withheld.end(), true);
    run.numbers.emplace_back("blackout.scans", static_cast<double>(withheld));
  }
  if (driven.is_start_ambiguous) run.numbers.emplace_back(start_is_ambiguous, 1.0);
  const bool whole = !interrupted() && driven.broken.empty() && driven.full_mb == 0.0;
  if (whole && job.may_err_systematically()) note_systematic_errors(job.recording, run);
  const ExitCode smoothed = job.smooth && whole ? smooth_drive(job, run) : ExitCode::ok;
  run.remarks = job.recording.remarks;
  if (whole) run.warnings = warnings_of_job(job, run);
  const evaluation::Evaluation evaluation = reports::finish_run(run, writer);
  std::fputs(reports::evaluation_text(evaluation).c_str(), stdout);
  std::fputs(text_of(agreement).c_str(), stdout);
  if (!job.given_map && !job.fastslam.chosen) {
    std::printf("closings             %d accepted, %d refused, %d on new ground, %d left undecided\n",
                driven.closings["accepted"], driven.closings["refused"], driven.closings["new-ground"],
                driven.closings["undecided"]);
  }
  std::printf("run folder: %s   report: %s/report.html\n", job.out.c_str(), job.out.c_str());
  return verdict(job, driven, run, evaluation, smoothed);
}

}  // namespace helixnav::apps
