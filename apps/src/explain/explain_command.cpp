// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "common/commands.hpp"
#include "common/missing_warnings.hpp"
#include "helixnav/reports/explanation.hpp"
#include "helixnav/runs/run_folder.hpp"
#include "settings/validators.hpp"

namespace helixnav::apps {
namespace {

struct ExplainJob {
  std::string folder;
  std::int64_t step = -1;     ///< -1: not asked for
  std::uint64_t closure = 0;  ///< 0: not asked for
};

void explain(const ExplainJob& job) {
  const runs::Run run = runs::read_run(job.folder);
  warn_of_missing(run.missing);
  const std::string text = job.step >= 0     ? reports::explain_step(run, job.step)
                           : job.closure > 0 ? reports::explain_closure(run, job.closure)
                                             : reports::explain_run(run);
  std::fputs(text.c_str(), stdout);
}

}  // namespace

void add_explain_command(CLI::App& app, ExitCode&) {
  CLI::App* command =
      app.add_subcommand("explain", "Explain why loops were closed or not, and why observations were dropped");
  const auto job = std::make_shared<ExplainJob>();
  command->add_option("DIR", job->folder, "Run folder, also one whose run was killed")->required();
  CLI::Option* step = command->add_option("--step", job->step, "What became of every observation of this step");
  step->check(number_between(std::int64_t{0}, std::numeric_limits<std::int64_t>::max()));
  CLI::Option* closure =
      command->add_option("--closure", job->closure, "How this closure came about, counted from 1 (refused ones, too)");
  closure->check(number_between(std::uint64_t{1}, std::uint64_t{1'000'000}))->excludes(step);
  command->footer(
      "Examples:\n"
      "  helixnav explain runs/loop\n"
      "  helixnav explain runs/loop --closure 1\n"
      "  helixnav explain runs/loop --step 313\n");
  command->callback([job] { explain(*job); });
}

}  // namespace helixnav::apps
