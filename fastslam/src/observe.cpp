// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/fastslam/observe.hpp"

#include <set>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/thin_scan.hpp"

namespace helixnav::fastslam {
namespace {

std::vector<KnownName> names_of(const std::vector<KnownName>& labels) {
  std::vector<KnownName> names;
  std::set<KnownName> seen;
  for (const KnownName label : labels) {
    const bool counts = label >= 0 && seen.insert(label).second;
    names.push_back(counts ? label : no_name);
  }
  return names;
}

core::StepReport update_by_name(FastSlam& slam, const core::Scan& scan, const std::vector<KnownName>& labels) {
  const std::vector<KnownName> names = names_of(labels);
  core::StepReport report = slam.update_known(scan, names);
  for (std::size_t j = 0; j < names.size(); ++j) {
    if (names[j] == no_name) report.associations[j].outcome = core::Outcome::rejected;
  }
  return report;
}

/// The report of a thinned scan as that of the whole one.
core::StepReport of_whole_scan(core::StepReport report, const std::vector<std::size_t>& used, std::size_t whole) {
  std::vector<core::AssociationReport> all = core::reports_of_none(whole);
  core::name_in_whole_scan(used, all, report.associations);
  report.decisions.push_back(core::thinning_decision(whole, used.size()));
  return report;
}

}  // namespace

core::StepReport observe(FastSlam& slam, const core::Scan& scan) {
  if (scan.observations.size() <= core::most_observations_used) return slam.update(scan);
  const std::vector<std::size_t> used = core::observations_to_use(scan);
  return of_whole_scan(slam.update(core::thinned(scan, used)), used, scan.observations.size());
}

core::StepReport observe_known(FastSlam& slam, const core::Scan& scan, const std::vector<KnownName>& labels) {
  if (labels.size() != scan.observations.size()) {
    throw core::PreconditionError("FastSLAM: not as many labels as observations");
  }
  if (scan.observations.size() <= core::most_observations_used) return update_by_name(slam, scan, labels);
  const std::vector<std::size_t> used = core::observations_to_use(scan);
  std::vector<KnownName> labels_used;
  for (const std::size_t i : used) labels_used.push_back(labels[i]);
  return of_whole_scan(update_by_name(slam, core::thinned(scan, used), labels_used), used, scan.observations.size());
}

}  // namespace helixnav::fastslam
