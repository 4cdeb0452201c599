// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "common/commands.hpp"
#include "common/missing_warnings.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/evaluation/evaluation.hpp"
#include "helixnav/reports/summary.hpp"
#include "helixnav/runs/run_folder.hpp"
#include "settings/validators.hpp"
#include "team_frame.hpp"
#include "truth_file.hpp"

namespace helixnav::apps {
namespace {

struct EvaluateJob {
  std::string folder;
  std::string truth;
  double truth_offset_s = 0.0;
  bool json = false;
  evaluation::EvaluationOptions options;
};

/// For a team's robot, the time from which its covariances are in the frame that its truth is in.
void choose_nees(const runs::Run& run, EvaluateJob& job) {
  const std::optional<double> since_s = in_frame_since_s(job.folder);
  if (!since_s || run.steps.empty() || *since_s <= core::seconds(run.steps.front().t_ns)) return;
  job.options.nees_from_ns = core::nanoseconds_from_seconds(*since_s);
  std::fprintf(stderr, "helixnav: note: NEES from %.9g s on, when the robot came into the frame of its team\n",
               *since_s);
}

void evaluate(EvaluateJob& job) {
  runs::Run run = runs::read_run(job.folder);
  warn_of_missing(run.missing);
  choose_nees(run, job);
  if (!job.truth.empty()) run.truth = read_truth_file(job.truth, job.truth_offset_s, run.truth);
  if (!job.truth.empty() && run.truth.frame_when_placed) runs::bring_truth_into_map(run);
  const evaluation::Evaluation evaluation = evaluation::evaluate(run, job.options);
  if (!job.truth.empty() && evaluation.position && evaluation.position->error_m.count == 0) {
    throw core::InputError(job.truth + ": none of its " + std::to_string(evaluation.position->fixes_outside) +
                           " positions lies within the time of the run; --truth-offset-s shifts its clock");
  }
  const std::string text = job.json ? reports::evaluation_json(evaluation) : reports::evaluation_text(evaluation);
  std::fputs(text.c_str(), stdout);
}

}  // namespace

void add_evaluate_command(CLI::App& app, ExitCode&) {
  CLI::App* command = app.add_subcommand("evaluate", "Compare a run folder with truth");
  const auto job = std::make_shared<EvaluateJob>();
  command->add_option("DIR", job->folder, "Run folder, also one whose run was killed")->required();
  command->add_option(
      "--truth", job->truth,
      "Truth instead of the run folder's: its truth_*.csv, a folder of them, a log of one's own, or Victoria Park's "
      "aa3_gpsx.mat");
  command->add_option("--truth-offset-s", job->truth_offset_s, "Added to the times of --truth")
      ->capture_default_str()
      ->check(number_between(-1e9, 1e9));
  command
      ->add_option("--fix-limit-m", job->options.fix_limit_m,
                   "Fixes farther than this after the rigid alignment are left out and counted")
      ->capture_default_str()
      ->check(number_between(1e-3, 1e9));
  command->add_flag("--json", job->json, "Print JSON");
  command->footer(
      "Examples:\n"
      "  helixnav evaluate runs/vp\n"
      "  helixnav evaluate runs/vp --truth aa3_gpsx.mat      # all 4466 GPS fixes\n");
  command->callback([job] { evaluate(*job); });
}

}  // namespace helixnav::apps
