// SPDX-License-Identifier: BSD-3-Clause
// Whether the vehicle slipped before this scan, and what the scan looks like then.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "association/candidates.hpp"
#include "helixnav/association/associate.hpp"
#include "helixnav/core/odometry.hpp"
#include "loop/navigation_loop.hpp"
#include "slip/should_be_seen.hpp"
#include "slip/update_after_slip.hpp"

namespace helixnav::supervisor {

using core::AssociationReport;
using core::LandmarkId;

namespace {

std::vector<cekf::Match> matches_of(const Slip& slip, const core::Scan& scan) {
  std::vector<cekf::Match> pairs;
  for (const SlipPair& pair : slip.pairs) {
    pairs.push_back(
        {pair.landmark, scan.observations[static_cast<std::size_t>(pair.observation)], scan.T_robot_sensor});
  }
  return pairs;
}

}  // namespace

/// Landmarks that may be seen, unless an open question excludes them.
std::vector<SlipLandmark> NavigationLoop::landmarks_near(const core::Scan& scan) const {
  const Eigen::Vector2d sensor_m = core::transform(belief_.filter.pose().mean, scan.T_robot_sensor.position_m());
  const double reach_m = scan.field_of_view.reach().value_or(scan.field_of_view.max_range_m);
  const std::vector<LandmarkId>& not_asked = excluded();
  std::vector<SlipLandmark> near;
  for (const LandmarkId id : belief_.filter.landmarks_within(sensor_m, reach_m + options_.view_margin_m)) {
    const bool is_excluded = std::binary_search(not_asked.begin(), not_asked.end(), id);
    if (is_excluded || !belief_.existence.contains(id)) continue;
    near.push_back({id, belief_.filter.landmark_mean(id), belief_.existence.record(id).hits});
  }
  return near;
}

std::optional<Slip> NavigationLoop::find_slip(const core::Scan& scan,
                                              const std::vector<AssociationReport>& fate) const {
  const SlipContext context{scan,
                            belief_.filter.pose().mean,
                            fate,
                            [&] { return landmarks_near(scan); },
                            [&](const std::vector<LandmarkId>& ids) { return belief_.filter.joint(ids); },
                            [&] { return belief_.coverage.between(0.0, belief_.existence.path_m()); },
                            options_.extraneous_per_scan,
                            options_.association.detection_probability};
  return supervisor::find_slip(context, options_.slip);
}

/// The unmeasured motion: zero mean, with this covariance. On the tape beside the measured motion.
void NavigationLoop::move_unmeasured(const Eigen::Matrix3d& covariance, core::Nanoseconds t_ns) {
  core::Odometry unmeasured = core::no_motion(t_ns);
  unmeasured.covariance = covariance;
  belief_.filter.predict(unmeasured);
  if (Searching* open = searching()) open->search.move(unmeasured);
  tape_.append(Tape::Slip{unmeasured});
}

/// The fate of a scan seen from where a slip's pairs put the vehicle, and what should be seen from there.
NavigationLoop::SeenAfterSlip NavigationLoop::seen_after(const Slip& slip, const core::Scan& scan,
                                                         const Confirmation& before) {
  core::Odometry unmeasured = core::no_motion(scan.t_ns);
  unmeasured.covariance = slip.covariance;
  cekf::CompressedEkf moved = belief_.filter;
  moved.predict(unmeasured);
  core::NumericalHealth numerics;
  update_after_slip(moved, matches_of(slip, scan), numerics);
  std::vector<LandmarkId> known;
  for (const SlipLandmark& landmark : landmarks_near(scan)) {
    if (landmark.hits > 1) known.push_back(landmark.id);
  }
  const std::vector<LandmarkId> ids = candidates(moved, scan, options_.candidate_sigmas, excluded());
  const GatedScan gated = gate_scan(moved, ids, scan, options_, belief_.existence.appearance());
  const Confirmation confirmation = std::exchange(belief_.confirmation, before);
  std::vector<AssociationReport> fate = associate_gated(gated, scan);
  belief_.confirmation = confirmation;
  match_pairs(slip.pairs, fate);
  const std::vector<LandmarkId> surely = should_be_seen(moved, scan, options_.view_margin_m, known, fate).surely;
  const auto is_seen = [&](LandmarkId id) {
    return std::any_of(fate.begin(), fate.end(), [&](const AssociationReport& a) {
      return a.outcome == core::Outcome::matched && a.landmark == id;
    });
  };
  const auto seen = std::count_if(surely.begin(), surely.end(), is_seen);
  return {static_cast<double>(surely.size()), static_cast<double>(seen),
          chance_of_match(moved, scan, surely, options_.gates.match_probability)};
}

/// Whether what should be seen from the slip's place is better explained by a vehicle that is elsewhere (as slip/vanished): where
/// landmarks repeat or stand densely, some pairs fit wherever it was carried to. After a slip half or more are seen, also in a map of
/// which much has changed; elsewhere as many as chance has it.
bool NavigationLoop::is_rather_elsewhere(const Slip& slip, const core::Scan& scan, const Confirmation& before) {
  const SeenAfterSlip after = seen_after(slip, scan, before);
  constexpr double here = 0.5, least_chance = 0.05, most_chance = 0.4;
  const double elsewhere = std::clamp(after.by_chance, least_chance, most_chance);
  const double nats = after.seen * std::log(here / elsewhere) +
                      (after.expected - after.seen) * std::log((1.0 - here) / (1.0 - elsewhere));
  return nats < 0.0;
}

/// True if the vehicle slipped: the motion is wider then, and the scan is associated as it looks from where the slip's
/// pairs put the vehicle; `before`: the confirmation as it was before the scan, so that one scan is not a second hit.
/// Otherwise nothing changes.
bool NavigationLoop::allow_for_slip(const core::Scan& scan, const Confirmation& before, core::StepReport& report) {
  const std::optional<Slip> slip = find_slip(scan, report.associations);
  if (!slip || is_rather_elsewhere(*slip, scan, before)) return false;
  report.decisions.emplace_back(slip->figures);
  belief_.slips.add(slip->displacement);
  core::Odometry slipped = core::no_motion(scan.t_ns);
  slipped.T_before_after = core::Pose2(slip->displacement);
  belief_.moving.move(slipped);  // else standing things would seem to have moved by it
  move_unmeasured(slip->covariance, scan.t_ns);

  cekf::CompressedEkf moved = belief_.filter;
  update_after_slip(moved, matches_of(*slip, scan), report.numerics);
  const std::vector<LandmarkId> ids = candidates(moved, scan, options_.candidate_sigmas, excluded());
  const GatedScan gated = gate_scan(moved, ids, scan, options_, belief_.existence.appearance());
  report_unfinished(gated, report);
  belief_.confirmation = before;
  report.associations = associate_gated(gated, scan);
  match_pairs(slip->pairs, report.associations);
  return true;
}

}  // namespace helixnav::supervisor
