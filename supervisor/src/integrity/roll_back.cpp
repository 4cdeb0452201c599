// SPDX-License-Identifier: BSD-3-Clause
// Back to the trusted checkpoint; what came since is processed again in a search that begins there.
#include <algorithm>
#include <utility>
#include <variant>
#include <vector>

#include "loop/navigation_loop.hpp"
#include "loop/process_again.hpp"

namespace helixnav::supervisor {

using core::StepReport;

namespace {

/// Length of the drive where a landmark known at `known_m` of it was last seen; no less than that.
double last_seen_m(const association::LandmarkLife& existence, double known_m) {
  double last_m = known_m;
  for (const association::LandmarkRecord& record : existence.records()) {
    if (record.born_path_m <= known_m) last_m = std::max(last_m, record.last_seen_path_m);
  }
  return last_m;
}

}  // namespace

bool NavigationLoop::has_lost_its_place() const {
  const Mapping* mapping = std::get_if<Mapping>(&mode_);
  return mapping != nullptr && is_monitored() && mapping->monitor.is_lost(belief_.existence, options_.search.integrity);
}

StepReport NavigationLoop::roll_back_and_relocalise(const core::Scan& scan, StepReport report) {
  const Mapping& mapping = std::get<Mapping>(mode_);
  const IntegrityMonitor::Evidence evidence = mapping.monitor.evidence(belief_.existence, options_.search.integrity);
  const Checkpoint trusted = *mapping.trusted;
  const double last_known_m = last_seen_m(belief_.existence, trusted.existence.path_m());
  const auto scans = static_cast<int>(belief_.step - trusted.step);
  const core::LandmarkId next = belief_.filter.next_name();
  const std::vector<Tape::Entry>& since = undo_.rolled_back.emplace(tape_.cut(trusted.position));
  roll_back(trusted, belief_);
  belief_.filter.name_from(next);
  constexpr int few = 4;
  const bool is_lost =
      few * evidence.seen <= evidence.missing;  // at most one in five of what should be seen, by chance
  if (is_lost && !belief_.untied_since_m) belief_.untied_since_m = last_known_m;
  pending_.decisions = std::move(report.decisions);
  pending_.decisions.emplace_back(
      core::RollbackDecision{evidence.missing, evidence.seen, evidence.spawned, evidence.nats, scans});
  begin_search(scan);
  return process_in_search(since, std::move(report));
}

/// What came since a search began in the past; the last scan is that of `report`.
StepReport NavigationLoop::process_in_search(const std::vector<Tape::Entry>& since, StepReport report) {
  StepReport through;
  through.numerics = report.numerics;
  const auto after_fix = [&](const Tape::Fix& fix, bool accepted) {
    if (accepted == fix.accepted) pending_.decisions.pop_back();  // it was reported when it came in
  };
  process_again(since, after_fix, [&](StepReport again) {
    report = std::move(again);
    for (const core::Decision& decision : report.decisions) through.decisions.emplace_back(decision);
    through.merged.insert(through.merged.end(), report.merged.begin(), report.merged.end());
    through.revised.push_back({report.step, report.associations});
    through.numerics.note(report.numerics);
    if (!report.solved.empty()) through.solved = std::move(report.solved);
  });
  through.revised.pop_back();  // the last one is this scan
  report.numerics = through.numerics;
  report.decisions = std::move(through.decisions);
  report.merged = std::move(through.merged);
  report.revised = std::move(through.revised);
  report.solved = std::move(through.solved);
  return report;
}

}  // namespace helixnav::supervisor
