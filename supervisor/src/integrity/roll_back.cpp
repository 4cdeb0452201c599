// SPDX-License-Identifier: BSD-3-Clause
// Back to the trusted checkpoint, and through what came since in a search that should have begun there.
#include <utility>
#include <variant>
#include <vector>

#include "loop/navigation_loop.hpp"

namespace helixnav::supervisor {

using core::StepReport;

bool NavigationLoop::has_lost_its_place() const {
  const Mapping* mapping = std::get_if<Mapping>(&mode_);
  return mapping != nullptr && is_monitored() && mapping->monitor.is_lost(belief_.existence, options_.search.integrity);
}

StepReport NavigationLoop::roll_back_and_relocalise(StepReport report) {
  const Mapping& mapping = std::get<Mapping>(mode_);
  const IntegrityMonitor::Evidence evidence = mapping.monitor.evidence(belief_.existence, options_.search.integrity);
  const Checkpoint trusted = *mapping.trusted;
  const auto scans = static_cast<int>(belief_.step - trusted.step);
  const core::LandmarkId next = belief_.filter.next_name();
  const std::vector<Tape::Entry>& since = undo_.rolled_back.emplace(tape_.cut(trusted.position));
  roll_back(trusted, belief_);
  belief_.filter.name_from(next);
  pending_.decisions = std::move(report.decisions);
  pending_.decisions.emplace_back(
      core::RollbackDecision{evidence.missing, evidence.seen, evidence.spawned, evidence.nats, scans});
  begin_search();
  StepReport through;
  for (const Tape::Entry& entry : since) {
    if (const auto* motion = std::get_if<Tape::Motion>(&entry)) {
      pending_.motion = motion->odometry;
      pending_.driven_m = motion->driven_m;
    } else if (const auto* fix = std::get_if<Tape::Fix>(&entry)) {
      const bool judged_alike = use_fix(fix->fix) == fix->accepted;
      if (judged_alike) pending_.decisions.pop_back();  // it was reported when it came in
    } else if (const auto* scan = std::get_if<Tape::Scan>(&entry)) {
      report = step(scan->scan);
      for (const core::Decision& decision : report.decisions) through.decisions.emplace_back(decision);
      through.merged.insert(through.merged.end(), report.merged.begin(), report.merged.end());
      through.revised.push_back({report.step, report.associations});
    }
  }
  through.revised.pop_back();  // the last one is this scan
  report.decisions = std::move(through.decisions);
  report.merged = std::move(through.merged);
  report.revised = std::move(through.revised);
  return report;
}

}  // namespace helixnav::supervisor
