// SPDX-License-Identifier: BSD-3-Clause
#include "association/gated_scan.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "association/association_report.hpp"
#include "association/sure_match.hpp"
#include "helixnav/association/likelihood_ratio.hpp"
#include "helixnav/supervisor/lengths.hpp"

namespace helixnav::supervisor {
namespace {

const RevisitAmbiguity* find_return(const std::vector<RevisitAmbiguity>& returns, core::LandmarkId landmark) {
  const auto found = std::find_if(returns.begin(), returns.end(),
                                  [&](const RevisitAmbiguity& one) { return one.landmark == landmark; });
  return found == returns.end() ? nullptr : &*found;
}

/// Of the candidates, those unseen for longer than that, but for some; ascending.
std::vector<core::LandmarkId> away_for(double path_m, const association::InnovationProblem& problem,
                                       const association::LandmarkLife& life,
                                       const std::vector<core::LandmarkId>& but) {
  std::vector<core::LandmarkId> away;
  for (const core::LandmarkId id : problem.ids) {
    if (!life.contains(id) || std::binary_search(but.begin(), but.end(), id)) continue;
    if (life.path_m() - life.record(id).last_seen_path_m > path_m) away.push_back(id);
  }
  std::sort(away.begin(), away.end());
  return away;
}

std::vector<core::LandmarkId> returned_to(const std::vector<core::LandmarkId>& a,
                                          const std::vector<core::LandmarkId>& b) {
  std::vector<core::LandmarkId> both;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

/// What is seen on a return may be something that has changed meanwhile, or ground next to the ground it is taken for:
/// there may be as many objects in no map there as there are in it.
double extraneous_on_return(const association::LandmarkLife& existence, const SearchOptions& search,
                            const core::FieldOfView& view) {
  const double begun = with_extraneous_density(search, existence.born_per_scan(), view).extraneous_per_scan;
  return std::max(begun, existence.seen_per_scan());
}

/// By how much the match is likelier than that an object in no map is seen there. Few of them are in a gate that is small enough to go
/// by one match, and yet at its rim, where a right match hardly ever is, they are likelier.
double nats_ahead_of_no_map(const GatedScan& gated, const core::AssociationReport& report, const RevisitAmbiguity& met,
                            double detection_probability) {
  const int index = gated.assignment.observations[static_cast<std::size_t>(report.observation)].pair;
  if (index < 0) return std::numeric_limits<double>::infinity();
  const association::GatedPair& pair = gated.gating->problem.pairs[static_cast<std::size_t>(index)];
  return std::log(detection_probability) + pair.log_likelihood + pair.appearance_nats -
         std::log(met.extraneous_density);
}

void defer_isolated_match(const GatedScan& gated, const core::Scan& scan, const NavigatorOptions& navigator,
                          double path_m, Confirmation& confirmation, std::vector<core::AssociationReport>& reports) {
  const std::vector<RevisitAmbiguity>& returns = gated.returns;
  const SearchOptions& options = navigator.search;
  core::AssociationReport* isolated = nullptr;
  for (core::AssociationReport& report : reports) {
    if (report.outcome != core::Outcome::matched || find_return(returns, report.landmark) == nullptr) continue;
    if (isolated != nullptr) return;
    isolated = &report;
  }
  if (isolated == nullptr) return;
  const core::Observation& seen = scan.observations[static_cast<std::size_t>(isolated->observation)];
  if (core::dimension(seen.kind) != 2) return;  // left unused anyway
  const RevisitAmbiguity& met = *find_return(returns, isolated->landmark);
  const bool ambiguous = met.expected_confusers > options.defer_confusers;
  const bool informative = met.widening > options.confirmation_widening;
  const IsolatedHit hit = isolated_hit(isolated->landmark, path_m, seen, gated.pose, scan.T_robot_sensor);
  const bool met_again = confirmation.confirms(hit, options.confirmation_m);
  const double ahead_of_no_map =
      nats_ahead_of_no_map(gated, *isolated, met, navigator.association.detection_probability);
  const bool unsure = std::min(isolated->margin_nats, ahead_of_no_map) < sure_match_nats();
  if (ambiguous || (informative && (!met_again || unsure))) isolated->outcome = core::Outcome::ambiguous;
}

/// Of landmarks that have been out of view, though not for so long as to be old, a single one at the rim of its gate moves the pose as
/// well; two that agree do not happen by chance.
void defer_unlikely_match(const GatedScan& gated, double detection_probability,
                          std::vector<core::AssociationReport>& reports) {
  core::AssociationReport* alone = nullptr;
  for (core::AssociationReport& report : reports) {
    const bool has_been_away =
        find_return(gated.returns, report.landmark) != nullptr || find_return(gated.away, report.landmark) != nullptr;
    if (report.outcome != core::Outcome::matched || !has_been_away) continue;
    if (alone != nullptr) return;
    alone = &report;
  }
  const RevisitAmbiguity* met = alone == nullptr ? nullptr : find_return(gated.away, alone->landmark);
  if (met != nullptr && nats_ahead_of_no_map(gated, *alone, *met, detection_probability) < 0.0) {
    alone->outcome = core::Outcome::ambiguous;
  }
}

/// The other matches show where the vehicle is, but not where these are.
void defer_matches(const std::vector<core::LandmarkId>& loose, std::vector<core::AssociationReport>& reports) {
  for (core::AssociationReport& report : reports) {
    if (report.outcome == core::Outcome::matched && std::binary_search(loose.begin(), loose.end(), report.landmark)) {
      report.outcome = core::Outcome::ambiguous;
    }
  }
}

/// Pose and one landmark: all that its own gate needs.
core::JointGaussian pose_and(const core::PoseGaussian& pose, core::LandmarkId id, const core::PointGaussian& point,
                             const Eigen::Matrix<double, 2, 3>& with_pose) {
  core::JointGaussian joint;
  joint.pose = pose.mean;
  joint.ids = {id};
  joint.points_m = {point.mean_m};
  joint.covariance.resize(5, 5);
  joint.covariance.topLeftCorner<3, 3>() = pose.covariance;
  joint.covariance.bottomLeftCorner<2, 3>() = with_pose;
  joint.covariance.topRightCorner<3, 2>() = joint.covariance.bottomLeftCorner<2, 3>().transpose();
  joint.covariance.bottomRightCorner<2, 2>() = point.covariance_m2;
  return joint;
}

/// Of many candidates, those that keep some observation from being a new landmark, each gated by itself, O(q²)
/// altogether in products that fill the caches: if the vehicle does not know where it is, there are hundreds, and their
/// joint covariance costs O(candidates²·q). For a few, that costs no more than gating them one by one.
std::vector<core::LandmarkId> inside_gates(const cekf::CompressedEkf& filter, std::vector<core::LandmarkId> candidates,
                                           const core::Scan& scan, const association::Gates& gates) {
  constexpr std::size_t few = 48;
  if (candidates.size() <= few) return candidates;
  const core::PoseGaussian pose = filter.pose();
  const std::vector<core::PointGaussian> points = filter.marginals(candidates);
  const std::vector<cekf::Outlook> outlooks = filter.outlooks(candidates);  // all in one pass over the basis
  std::vector<core::LandmarkId> inside;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const core::JointGaussian joint = pose_and(pose, candidates[i], points[i], outlooks[i].with_pose);
    const association::InnovationProblem own = association::make_innovation_problem(joint, scan, gates);
    const bool is_inside =
        std::any_of(own.observations.begin(), own.observations.end(),
                    [](const association::GatedObservation& one) { return std::isfinite(one.nearest_nis); });
    if (is_inside) inside.push_back(candidates[i]);
  }
  return inside;
}

}  // namespace

GatedScan gate_scan(const cekf::CompressedEkf& filter, const std::vector<core::LandmarkId>& candidates,
                    const core::Scan& scan, const NavigatorOptions& options, const core::MapAppearance& appearance) {
  GatedScan gated;
  gated.pose = filter.pose();
  gated.gating = std::make_unique<Gating>(filter, inside_gates(filter, candidates, scan, options.gates), scan,
                                          options.gates, appearance.is_empty() ? nullptr : &appearance);
  association::Options how = options.association;
  how.extraneous = association::density_in_view(scan, options.extraneous_per_scan, how.extraneous);
  gated.assignment = association::associate(options.method, gated.gating->problem, how);
  return gated;
}

void look_for_returns(const cekf::CompressedEkf& filter, const association::LandmarkLife& existence,
                      const core::Scan& scan, const NavigatorOptions& options, const core::FieldOfView& view,
                      GatedScan& gated) {
  const association::InnovationProblem& problem = gated.gating->problem;
  const std::vector<core::LandmarkId> old =
      returned_to(old_landmarks(existence, options.search.old_after_m), drifted_from(problem, scan));
  const double extraneous_per_scan = extraneous_on_return(existence, options.search, view);
  gated.returns = returns_in_gate(filter, problem, scan, old, extraneous_per_scan, existence.appearance());
  for (RevisitAmbiguity& met : gated.returns) {
    met.is_mature = existence.state(met.landmark) == core::LandmarkState::mature;
    const bool is_doubtful = !met.is_mature && met.expected_confusers > options.search.defer_confusers;
    if (is_doubtful) gated.doubtful.push_back(met.landmark);
  }
  if (const std::optional<double> reach_m = scan.field_of_view.reach()) {
    const double begun = with_extraneous_density(options.search, existence.born_per_scan(), view).extraneous_per_scan;
    gated.away = returns_in_gate(filter, problem, scan, away_for(*reach_m, problem, existence, old), begun,
                                 existence.appearance());
  }
  const RevisitAmbiguity* worst = most_ambiguous(gated.returns);
  if (worst == nullptr || worst->expected_confusers <= options.search.expected_confusers) return;
  gated.place = place_evidence(filter, problem, gated.assignment, scan, old, extraneous_per_scan, options.view_margin_m,
                               options.search);
}

bool has_unplaced(const core::Scan& scan) {
  return std::any_of(scan.observations.begin(), scan.observations.end(),
                     [](const core::Observation& one) { return core::dimension(one.kind) == 1; });
}

void leave_unplaced_unused(const core::Scan& scan, std::vector<core::AssociationReport>& reports) {
  for (core::AssociationReport& report : reports) {
    const core::Observation& seen = scan.observations[static_cast<std::size_t>(report.observation)];
    if (core::dimension(seen.kind) == 1 && report.outcome == core::Outcome::matched)
      report.outcome = core::Outcome::ambiguous;
  }
}

void leave_returns_unused(GatedScan& gated) {
  gated.place.loose.clear();
  for (const RevisitAmbiguity& met : gated.returns) gated.place.loose.push_back(met.landmark);
}

void leave_ambiguous_unused(const SearchOptions& options, GatedScan& gated) {
  gated.place.loose.clear();
  for (const RevisitAmbiguity& met : gated.returns) {
    if (met.expected_confusers > options.defer_confusers) gated.place.loose.push_back(met.landmark);
  }
}

std::vector<core::AssociationReport> associate_scan(const GatedScan& gated, const core::Scan& scan,
                                                    const NavigatorOptions& options, double path_m,
                                                    Confirmation& confirmation) {
  std::vector<core::AssociationReport> reports = association_reports(gated.assignment);
  defer_matches(gated.place.loose, reports);
  defer_matches(gated.doubtful, reports);
  defer_isolated_match(gated, scan, options, path_m, confirmation, reports);
  defer_unlikely_match(gated, options.association.detection_probability, reports);
  return reports;
}

}  // namespace helixnav::supervisor
