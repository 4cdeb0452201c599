// SPDX-License-Identifier: BSD-3-Clause
#include "association/association_report.hpp"

#include <cstddef>

namespace helixnav::supervisor {
namespace {

core::Outcome outcome_of(const association::ObservationOutcome& observation) {
  switch (observation.outcome) {
    case association::Outcome::matched:
      return core::Outcome::matched;
    case association::Outcome::new_landmark:
      return core::Outcome::augmented;
    default:
      return observation.dropped_by_joint_test ? core::Outcome::rejected : core::Outcome::ambiguous;
  }
}

}  // namespace

std::vector<core::AssociationReport> association_reports(const association::Assignment& assignment) {
  std::vector<core::AssociationReport> reports;
  reports.reserve(assignment.observations.size());
  for (const association::ObservationOutcome& observation : assignment.observations) {
    core::AssociationReport report;
    report.observation = static_cast<int>(reports.size());
    report.outcome = outcome_of(observation);
    report.landmark = observation.landmark;
    report.nis = observation.nis;
    report.dof = observation.dof;
    report.margin_nats = observation.margin_nats;
    reports.push_back(report);
  }
  return reports;
}

std::vector<cekf::Match> matches(const core::Scan& scan, const std::vector<core::AssociationReport>& associations) {
  std::vector<cekf::Match> matched;
  matched.reserve(associations.size());
  for (const core::AssociationReport& association : associations) {
    if (association.outcome != core::Outcome::matched) continue;
    matched.push_back({association.landmark, scan.observations[static_cast<std::size_t>(association.observation)],
                       scan.T_robot_sensor});
  }
  return matched;
}

std::vector<core::LandmarkId> landmarks_with(core::Outcome outcome,
                                             const std::vector<core::AssociationReport>& associations) {
  std::vector<core::LandmarkId> ids;
  for (const core::AssociationReport& association : associations) {
    if (association.outcome == outcome && association.landmark != core::no_landmark)
      ids.push_back(association.landmark);
  }
  return ids;
}

}  // namespace helixnav::supervisor
