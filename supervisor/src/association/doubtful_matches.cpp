// SPDX-License-Identifier: BSD-3-Clause
#include "association/doubtful_matches.hpp"

#include <cmath>
#include <cstddef>

#include "association/sure_match.hpp"
#include "helixnav/association/likelihood_ratio.hpp"

namespace helixnav::supervisor {

std::vector<association::UnusedSighting> leave_doubtful_unused(const GatedScan& gated,
                                                               const association::LandmarkLife& existence,
                                                               const core::Scan& scan, const NavigatorOptions& options,
                                                               std::vector<core::AssociationReport>& reports) {
  const association::InnovationProblem& problem = gated.gating->problem;
  const association::ExtraneousDensity extraneous = association::density_in_view(
      scan, existence.born_per_scan(options.extraneous_per_scan), options.association.extraneous);
  std::vector<association::UnusedSighting> doubtful;
  for (core::AssociationReport& report : reports) {
    if (report.outcome != core::Outcome::matched) continue;
    if (existence.state(report.landmark) != core::LandmarkState::tentative) continue;
    const auto observation = static_cast<std::size_t>(report.observation);
    const int index = gated.assignment.observations[observation].pair;
    if (index < 0) continue;
    const association::GatedPair& pair = problem.pairs[static_cast<std::size_t>(index)];
    const double nats = std::log(options.association.detection_probability) + pair.log_likelihood -
                        std::log(extraneous.of(problem.observations[observation].kind));
    if (std::log(existence.odds(report.landmark)) + nats >= sure_match_nats()) continue;
    report.outcome = core::Outcome::ambiguous;
    if (nats > 0.0) doubtful.push_back({report.landmark, nats});
  }
  return doubtful;
}

}  // namespace helixnav::supervisor
