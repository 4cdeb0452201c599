// SPDX-License-Identifier: BSD-3-Clause
#include "drive.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "common/interrupt.hpp"
#include "common/progress_bar.hpp"
#include "dead_reckoning.hpp"
#include "estimator.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/evaluation/evaluation.hpp"
#include "helixnav/reports/report.hpp"
#include "helixnav/reports/summary.hpp"
#include "helixnav/runs/run_recorder.hpp"
#include "helixnav/runs/run_writer.hpp"
#include "smooth/smooth_drive.hpp"

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

void check_labels(const Drive& job) {
  if (job.known_association && job.recording.labels.empty()) {
    throw core::InputError(job.recording.name +
                           ": --association known needs a labelled log, and this one has no labels");
  }
  if (job.known_association && job.given_map && job.given_map->landmark_of.empty()) {
    throw core::InputError(
        "--association known needs to know the labels of the map's landmarks: give --map the folder "
        "of a run over a labelled log");
  }
}

struct Driven {
  std::size_t steps = 0;
  std::vector<double> step_us;          ///< of each scan that was fed
  std::map<std::string, int> closings;  ///< how many of each verdict
};

void count_closings(const core::StepReport& report, Driven& driven) {
  for (const core::Decision& decision : report.decisions) {
    if (decision.kind == "closure") ++driven.closings[decision.verdict];
  }
}

/// Feeds all events, but for the scans withheld.
Driven navigate(const Drive& job, const Estimator& estimator, runs::RunWriter& writer, runs::RunRecorder& recorder) {
  Driven driven;
  DeadReckoning reckoning;
  core::StepReport report;
  ProgressBar progress(job.given_map ? "localising" : "navigating", job.recording.events.size(), job.quiet);
  const auto feed = [&](const core::Scan& scan) {
    const Clock::time_point begin = Clock::now();
    report = estimator.observe(scan, driven.steps);
    driven.step_us.push_back(1e6 * seconds_since(begin));
    reckoning.absorbed();
    return driven.step_us.back();
  };
  for (std::size_t i = 0; i < job.recording.events.size() && !interrupted(); ++i) {
    const core::Event& event = job.recording.events[i];
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
      estimator.move(*odometry);
      reckoning.move(*odometry);
    } else if (const auto* fix = std::get_if<core::AbsoluteFix>(&event)) {
      estimator.fix(*fix);
      reckoning.absorbed();
    } else if (const auto* scan = std::get_if<core::Scan>(&event)) {
      const bool blind = !job.withheld.empty() && job.withheld[driven.steps];
      if (blind) report = reckoning.report(scan->t_ns, estimator.pose(), report);
      const double microseconds = blind ? 0.0 : feed(*scan);
      report.step = static_cast<std::int64_t>(driven.steps++);  // estimators do not count what they never saw
      count_closings(report, driven);
      writer.write(report, microseconds);
      recorder.add(report, microseconds);
    }
    progress.advance_to(i);
  }
  return driven;
}

}  // namespace

ExitCode drive(const Drive& job) {
  check_labels(job);
  catch_interrupts();
  const Clock::time_point begin = Clock::now();
  using IfNotEmpty = runs::RunWriter::IfNotEmpty;
  runs::RunWriter writer(job.out, job.manifest, job.recording,
                         job.overwrite ? IfNotEmpty::overwrite : IfNotEmpty::refuse);
  runs::RunRecorder recorder(job.out, job.manifest, job.recording);
  LabelAgreement agreement;
  const Estimator estimator = job.given_map ? localizer_of(job, agreement) : navigator_of(job);
  auto [steps, step_us, closings] = navigate(job, estimator, writer, recorder);

  runs::Run run = recorder.finish(estimator.map());
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
  const ExitCode smoothed = job.smooth && !interrupted() ? smooth_drive(job, run) : ExitCode::ok;
  const evaluation::Evaluation judged = evaluation::evaluate(run);
  writer.finish(run, reports::render_report(run, judged), reports::summary_json(run, judged));
  std::fputs(reports::evaluation_text(judged).c_str(), stdout);
  std::fputs(text_of(agreement).c_str(), stdout);
  if (!job.given_map) {
    std::printf("closings             %d accepted, %d refused, %d left undecided\n", closings["accepted"],
                closings["refused"], closings["undecided"]);
  }
  std::printf("run folder: %s   report: %s/report.html\n", job.out.c_str(), job.out.c_str());
  if (!interrupted()) return smoothed;
  std::fprintf(stderr, "helixnav: interrupted after %zu steps; the run folder is complete up to there\n", steps);
  return ExitCode::interrupted;
}

}  // namespace helixnav::apps
