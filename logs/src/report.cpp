// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/report.hpp"

namespace helixnav::logs {

std::string render_report(const RunFolder& run, const Evaluation& evaluation,
                          const std::vector<std::pair<std::string, double>>& timing) {
  return run.manifest.command + std::to_string(evaluation.steps) + std::to_string(timing.size());
}

}  // namespace helixnav::logs
