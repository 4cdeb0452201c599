// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/reports/finish_run.hpp"

#include "helixnav/reports/report.hpp"
#include "helixnav/reports/summary.hpp"

namespace helixnav::reports {

evaluation::Evaluation finish_run(const runs::Run& run, runs::RunWriter& writer) {
  evaluation::Evaluation evaluation = evaluation::evaluate(run);
  writer.finish(run, render_report(run, evaluation), summary_json(run, evaluation));
  return evaluation;
}

}  // namespace helixnav::reports
