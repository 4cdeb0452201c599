// SPDX-License-Identifier: BSD-3-Clause
#include "association/gated_scan.hpp"

#include <algorithm>
#include <cmath>

#include "association/association_report.hpp"
#include "helixnav/association/likelihood_ratio.hpp"
#include "helixnav/core/angle.hpp"
#include "helixnav/supervisor/lengths.hpp"

namespace helixnav::supervisor {
namespace {

const RevisitAmbiguity* find_return(const std::vector<RevisitAmbiguity>& returns, core::LandmarkId landmark) {
  const auto found = std::find_if(returns.begin(), returns.end(),
                                  [&](const RevisitAmbiguity& one) { return one.landmark == landmark; });
  return found == returns.end() ? nullptr : &*found;
}

void defer_isolated_match(const std::vector<RevisitAmbiguity>& returns, const SearchOptions& options, double path_m,
                          Confirmation& confirmation, std::vector<core::AssociationReport>& reports) {
  core::AssociationReport* isolated = nullptr;
  for (core::AssociationReport& report : reports) {
    if (report.outcome != core::Outcome::matched || find_return(returns, report.landmark) == nullptr) continue;
    if (isolated != nullptr) return;
    isolated = &report;
  }
  if (isolated == nullptr) return;
  const RevisitAmbiguity& met = *find_return(returns, isolated->landmark);
  const bool ambiguous = met.expected_confusers > options.defer_confusers;
  const bool telling = met.widening > options.confirmation_widening;
  const bool met_again = confirmation.confirms(isolated->landmark, path_m, options.confirmation_m);
  if (ambiguous || (telling && !met_again)) isolated->outcome = core::Outcome::ambiguous;
}

}  // namespace

GatedScan gate_scan(const cekf::CompressedEkf& filter, const std::vector<core::LandmarkId>& candidates,
                    const core::Scan& scan, const NavigatorOptions& options) {
  GatedScan gated;
  gated.gating = std::make_unique<Gating>(filter, candidates, scan, options.gates);
  association::Options how = options.association;
  how.extraneous = association::density_in_view(scan, options.extraneous_per_scan, how.extraneous);
  gated.assignment = association::associate(options.method, gated.gating->problem, how);
  return gated;
}

void look_for_returns(const cekf::CompressedEkf& filter, const association::LandmarkLife& existence,
                      const core::Scan& scan, const NavigatorOptions& options, const core::FieldOfView& view,
                      GatedScan& gated) {
  const std::vector<core::LandmarkId> old = old_landmarks(existence, options.search.old_after_m);
  const double foreign_per_scan = with_foreign(options.search, existence.born_per_scan(), view).foreign_per_scan;
  const association::InnovationProblem& problem = gated.gating->problem;
  gated.returns = returns_in_gate(filter, problem, scan, old, foreign_per_scan);
  const RevisitAmbiguity* worst = most_ambiguous(gated.returns);
  if (worst == nullptr || worst->expected_confusers <= options.search.expected_confusers) return;
  gated.place = place_evidence(filter, problem, gated.assignment, scan, old, foreign_per_scan, options.view_margin_m,
                               options.search);
}

std::optional<core::TriggerDecision> find_trigger(const GatedScan& scan, const core::PoseGaussian& pose,
                                                  const SearchOptions& options) {
  const RevisitAmbiguity* worst = most_ambiguous(scan.returns);
  if (worst == nullptr || worst->expected_confusers <= options.expected_confusers) return std::nullopt;
  if (fixes_pose(scan.place, options)) return std::nullopt;
  core::TriggerDecision trigger;
  trigger.landmark = worst->landmark;
  trigger.expected_confusers = worst->expected_confusers;
  trigger.neighbours = worst->neighbours;
  trigger.gate_area = worst->gate_area;
  trigger.pose_sigma_m = std::sqrt(pose.covariance.topLeftCorner<2, 2>().trace());
  trigger.heading_sigma_deg = std::sqrt(pose.covariance(2, 2)) * 180.0 / core::pi;
  trigger.old_in_gate = static_cast<int>(scan.returns.size());
  return trigger;
}

std::vector<core::AssociationReport> associate_scan(const GatedScan& gated, const NavigatorOptions& options,
                                                    double path_m, Confirmation& confirmation) {
  std::vector<core::AssociationReport> reports = association_reports(gated.assignment);
  defer_isolated_match(gated.returns, options.search, path_m, confirmation, reports);
  return reports;
}

}  // namespace helixnav::supervisor
