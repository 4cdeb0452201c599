// SPDX-License-Identifier: BSD-3-Clause
// Scans with more observations than are used: a bound on the work per scan.
#include <utility>

#include "helixnav/core/thin_scan.hpp"
#include "loop/navigation_loop.hpp"

namespace helixnav::supervisor {

/// As if the sensor had made only these; the report numbers the observations as in the whole scan.
core::StepReport NavigationLoop::observe_thinned(const core::Scan& scan) {
  const std::size_t count = scan.observations.size();
  const auto place = used_.insert_or_assign(belief_.step, core::observations_to_use(scan)).first;
  try {
    const core::Scan thin = core::thinned(scan, place->second);
    std::vector<core::AssociationReport> all = core::reports_of_none(count);
    const core::Decision decision = core::thinning_decision(count, place->second.size());
    core::StepReport report = take_step(thin, &decision);
    core::name_in_whole_scan(place->second, all, report.associations);
    return report;
  } catch (...) {
    used_.erase(place);
    throw;
  }
}

void NavigationLoop::name_revised(core::StepReport& report) const {
  for (core::RevisedScan& revised : report.revised) {
    const auto thinned = used_.find(revised.step);
    if (thinned == used_.end()) continue;
    for (core::AssociationReport& one : revised.associations) {
      one.observation = static_cast<int>(thinned->second[static_cast<std::size_t>(one.observation)]);
    }
  }
}

}  // namespace helixnav::supervisor
