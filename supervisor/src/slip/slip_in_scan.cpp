// SPDX-License-Identifier: BSD-3-Clause
// Whether the vehicle slipped before this scan, and what the scan looks like then.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "association/association_report.hpp"
#include "association/candidates.hpp"
#include "association/view_area.hpp"
#include "helixnav/association/associate.hpp"
#include "helixnav/core/odometry.hpp"
#include "loop/navigation_loop.hpp"
#include "slip/density_of_new.hpp"
#include "slip/keep_weighed.hpp"
#include "slip/slip_decision.hpp"
#include "slip/slip_places.hpp"
#include "slip/update_after_slip.hpp"

namespace helixnav::supervisor {
namespace {

using core::AssociationReport;
using core::LandmarkId;
using core::Outcome;

constexpr std::size_t least_observations = 3;
constexpr int least_hits = 2;  // a landmark begun by one false alarm is not evidence

bool is_among(const std::vector<LandmarkId>& ids, LandmarkId id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

std::vector<Eigen::Vector2d> means_m(const cekf::CompressedEkf& filter, const std::vector<LandmarkId>& ids) {
  std::vector<Eigen::Vector2d> points_m;
  for (const LandmarkId id : ids) points_m.push_back(filter.landmark_mean(id));
  return points_m;
}

/// Unmatched observations that have an unmatched landmark within the distance that a slip may displace it.
int contradictions(const cekf::CompressedEkf& filter, const std::vector<LandmarkId>& near,
                   const std::vector<SeenPoint>& seen, const std::vector<AssociationReport>& fate,
                   const SlipComponent& widest, SlipReach reach) {
  const double spacing_m = spacing_in(reach, means_m(filter, near));
  const std::vector<LandmarkId> matched = landmarks_with(Outcome::matched, fate);
  const core::Pose2 pose = filter.pose().mean;
  return static_cast<int>(std::count_if(seen.begin(), seen.end(), [&](const SeenPoint& one) {
    if (fate[static_cast<std::size_t>(one.observation)].outcome == Outcome::matched) return false;
    const Eigen::Vector2d at_m = core::transform(pose, one.point_m);
    const double here_m = slip_reach_m(widest, one, spacing_m);
    return std::any_of(near.begin(), near.end(), [&](LandmarkId id) {
      return (filter.landmark_mean(id) - at_m).norm() < here_m && !is_among(matched, id);
    });
  }));
}

std::vector<PointPair> associated_pairs(const RelativeGeometry& geometry, const std::vector<SeenPoint>& seen,
                                        const std::vector<AssociationReport>& fate) {
  std::vector<PointPair> pairs;
  for (std::size_t s = 0; s < seen.size(); ++s) {
    const AssociationReport& one = fate[static_cast<std::size_t>(seen[s].observation)];
    if (one.outcome != Outcome::matched) continue;
    const auto at = std::find(geometry.ids.begin(), geometry.ids.end(), one.landmark);
    if (at != geometry.ids.end()) pairs.push_back({s, static_cast<std::size_t>(at - geometry.ids.begin())});
  }
  return pairs;
}

/// The pairs of the slip are matched, whatever else claimed their landmarks.
void match_pairs(const std::vector<SlipPair>& pairs, std::vector<AssociationReport>& fate) {
  for (AssociationReport& one : fate) {
    const auto pair =
        std::find_if(pairs.begin(), pairs.end(), [&](const SlipPair& p) { return p.observation == one.observation; });
    if (pair != pairs.end()) {
      one.outcome = Outcome::matched;
      one.landmark = pair->landmark;
      one.nis = pair->nis;
      one.dof = 2;
      continue;
    }
    const bool taken =
        std::any_of(pairs.begin(), pairs.end(), [&](const SlipPair& p) { return p.landmark == one.landmark; });
    if (one.outcome == Outcome::matched && taken) one.outcome = Outcome::ambiguous;
  }
}

}  // namespace

/// Landmarks that may be seen, unless an open question excludes them.
std::vector<LandmarkId> NavigationLoop::landmarks_near(const core::Scan& scan) const {
  const Eigen::Vector2d sensor_m = core::transform(belief_.filter.pose().mean, scan.T_robot_sensor.position_m());
  const double reach_m = scan.field_of_view.reach().value_or(scan.field_of_view.max_range_m);
  std::vector<LandmarkId> near = belief_.filter.landmarks_within(sensor_m, reach_m + options_.view_margin_m);
  const std::vector<LandmarkId>& not_asked = excluded();
  near.erase(std::remove_if(near.begin(), near.end(),
                            [&](LandmarkId id) {
                              return std::binary_search(not_asked.begin(), not_asked.end(), id) ||
                                     !belief_.existence.contains(id);
                            }),
             near.end());
  return near;
}

/// Where stems are in clumps, landmarks are closer to each other than a slip displaces; the landmark that an
/// observation is of would not be considered there. Only if nothing seen is where it should be: it takes ten times as
/// long.
std::optional<Slip> NavigationLoop::find_slip(const core::Scan& scan,
                                              const std::vector<AssociationReport>& fate) const {
  const double view_m2 = view_area_m2(scan.field_of_view);
  if (!options_.slip.enabled || !std::isfinite(view_m2) || !(view_m2 > 0.0)) return std::nullopt;
  const auto unmatched = static_cast<std::size_t>(
      std::count_if(fate.begin(), fate.end(), [](const auto& one) { return one.outcome != Outcome::matched; }));
  if (unmatched < 2 || fate.size() < least_observations) return std::nullopt;
  std::optional<Slip> slip = find_slip_within(SlipReach::next_neighbour, scan, fate);
  const bool is_nearly_all = 4 * unmatched >= 3 * fate.size() && unmatched >= 2 * least_observations;
  if (!slip && is_nearly_all) slip = find_slip_within(SlipReach::any_neighbour, scan, fate);
  return slip;
}

std::optional<Slip> NavigationLoop::find_slip_within(SlipReach reach, const core::Scan& scan,
                                                     const std::vector<AssociationReport>& fate) const {
  const std::vector<SeenPoint> seen = seen_points(scan, most_weighed);
  std::vector<LandmarkId> near = landmarks_near(scan);
  const SlipComponent widest = slip_components(options_.slip).back();
  keep_weighed(belief_.filter, scan, seen, widest, reach, near);
  if (contradictions(belief_.filter, near, seen, fate, widest, reach) < 2) return std::nullopt;

  const double per_m2 = options_.extraneous_per_scan / view_area_m2(scan.field_of_view);
  std::vector<LandmarkId> known = near;
  known.erase(std::remove_if(known.begin(), known.end(),
                             [&](LandmarkId id) { return belief_.existence.record(id).hits < least_hits; }),
              known.end());
  const std::vector<double> new_per_m2 =
      density_of_new(seen, belief_.filter.pose().mean, ground_looked_at(scan.field_of_view),
                     local_density_per_m2(means_m(belief_.filter, known)), per_m2);
  const auto ask = [&](const std::vector<LandmarkId>& witnesses, bool tentative) -> std::optional<Slip> {
    if (witnesses.size() < least_observations) return std::nullopt;
    const RelativeGeometry geometry(belief_.filter.joint(witnesses));
    return decide_slip({geometry, seen, new_per_m2, associated_pairs(geometry, seen, fate),
                        pair_nats(options_.association.detection_probability, per_m2), per_m2, tentative, reach},
                       options_.slip);
  };
  std::optional<Slip> slip = ask(known, false);
  if (!slip && known.size() < near.size()) slip = ask(near, true);
  return slip;
}

/// What the vehicle has looked at twice from places near where it is now, to the rim of the view.
pf_relocalize::Coverage NavigationLoop::ground_looked_at(const core::FieldOfView& view) const {
  pf_relocalize::Coverage looked_at;
  looked_at.field_of_view = view;
  looked_at.range_share = 1.0;
  looked_at.bearing_margin_rad = 0.0;
  looked_at.least_views = 2;
  looked_at.T_frame_sensor = belief_.coverage.between(0.0, belief_.existence.path_m());
  const Eigen::Vector2d here_m = belief_.filter.pose().mean.position_m();
  const auto is_far = [&](const core::Pose2& pose) {
    return (pose.position_m() - here_m).norm() > 2.0 * view.max_range_m;
  };
  auto& poses = looked_at.T_frame_sensor;
  poses.erase(std::remove_if(poses.begin(), poses.end(), is_far), poses.end());
  return looked_at;
}

/// The unmeasured motion: zero mean, with this covariance. On the tape beside the measured motion.
void NavigationLoop::move_unmeasured(const Eigen::Matrix3d& covariance, core::Nanoseconds t_ns) {
  core::Odometry unmeasured = core::no_motion(t_ns);
  unmeasured.covariance = covariance;
  belief_.filter.predict(unmeasured);
  if (Searching* open = searching()) open->search.move(unmeasured);
  tape_.append(Tape::Slip{unmeasured});
}

/// True if the vehicle slipped: the motion is wider then, and the scan is associated as it looks from where the slip's
/// pairs put the vehicle; `before`: the confirmation as it was before the scan, so that one scan is not a second hit.
/// Otherwise nothing changes.
bool NavigationLoop::allow_for_slip(const core::Scan& scan, const Confirmation& before, core::StepReport& report) {
  const std::optional<Slip> slip = find_slip(scan, report.associations);
  if (!slip) return false;
  report.decisions.emplace_back(slip->figures);
  belief_.slips.add(slip->displacement);
  core::Odometry slipped = core::no_motion(scan.t_ns);
  slipped.T_before_after = core::Pose2(slip->displacement);
  belief_.moving.move(slipped);  // else standing things would seem to have moved by it
  move_unmeasured(slip->covariance, scan.t_ns);

  std::vector<cekf::Match> pairs;
  for (const SlipPair& pair : slip->pairs) {
    pairs.push_back(
        {pair.landmark, scan.observations[static_cast<std::size_t>(pair.observation)], scan.T_robot_sensor});
  }
  cekf::CompressedEkf moved = belief_.filter;
  update_after_slip(moved, pairs, report.numerics);
  const std::vector<LandmarkId> ids = candidates(moved, scan, options_.candidate_sigmas, excluded());
  const GatedScan gated = gate_scan(moved, ids, scan, options_, belief_.existence.appearance());
  report_unfinished(gated, report);
  belief_.confirmation = before;
  report.associations = associate_gated(gated, scan);
  match_pairs(slip->pairs, report.associations);
  return true;
}

}  // namespace helixnav::supervisor
