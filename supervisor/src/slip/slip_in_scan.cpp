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
constexpr int least_hits = 2;  // a landmark that one false alarm began is no evidence

bool is_among(const std::vector<LandmarkId>& ids, LandmarkId id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

/// Unmatched observations that have an unmatched landmark beside them, as far as a slip may displace it.
int contradictions(const cekf::CompressedEkf& filter, const std::vector<LandmarkId>& near,
                   const std::vector<SeenPoint>& seen, const std::vector<AssociationReport>& fate,
                   const SlipComponent& widest) {
  std::vector<Eigen::Vector2d> means_m;
  for (const LandmarkId id : near) means_m.push_back(filter.landmark_mean(id));
  const double spacing_m = median_spacing_m(means_m);
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

/// The pairs of the slip are matched, whatever else wanted their landmarks.
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

/// Landmarks that may be seen, as far as no open question excludes them.
std::vector<LandmarkId> NavigationLoop::landmarks_near(const core::Scan& scan) const {
  const Eigen::Vector2d sensor_m = core::transform(belief_.filter.pose().mean, scan.T_robot_sensor.position_m());
  std::vector<LandmarkId> near =
      belief_.filter.landmarks_within(sensor_m, scan.field_of_view.max_range_m + options_.view_margin_m);
  const Searching* open = searching();
  near.erase(std::remove_if(near.begin(), near.end(),
                            [&](LandmarkId id) {
                              return (open != nullptr && open->search.excludes(id)) || !belief_.existence.contains(id);
                            }),
             near.end());
  return near;
}

std::optional<Slip> NavigationLoop::find_slip(const core::Scan& scan,
                                              const std::vector<AssociationReport>& fate) const {
  const double view_m2 = view_area_m2(scan.field_of_view);
  if (!options_.slip.enabled || !std::isfinite(view_m2) || !(view_m2 > 0.0)) return std::nullopt;
  const auto unmatched =
      std::count_if(fate.begin(), fate.end(), [](const auto& one) { return one.outcome != Outcome::matched; });
  if (unmatched < 2 || fate.size() < least_observations) return std::nullopt;
  const std::vector<SeenPoint> seen = seen_points(scan, most_weighed);
  std::vector<LandmarkId> near = landmarks_near(scan);
  const SlipComponent widest = slip_components(options_.slip).back();
  keep_weighed(belief_.filter, scan, seen, widest, near);
  if (contradictions(belief_.filter, near, seen, fate, widest) < 2) return std::nullopt;

  const double per_m2 = options_.extraneous_per_scan / view_m2;
  const auto ask = [&](const std::vector<LandmarkId>& witnesses, bool tentative) -> std::optional<Slip> {
    if (witnesses.size() < least_observations) return std::nullopt;
    const RelativeGeometry geometry(belief_.filter.joint(witnesses));
    return decide_slip({geometry, seen, associated_pairs(geometry, seen, fate),
                        pair_nats(options_.association.detection_probability, per_m2), per_m2, tentative},
                       options_.slip);
  };
  std::vector<LandmarkId> known = near;
  known.erase(std::remove_if(known.begin(), known.end(),
                             [&](LandmarkId id) { return belief_.existence.record(id).hits < least_hits; }),
              known.end());
  std::optional<Slip> slip = ask(known, false);
  if (!slip && known.size() < near.size()) slip = ask(near, true);
  return slip;
}

/// What was not measured: no motion in the mean, so much covariance. On the tape beside the motion that was.
void NavigationLoop::move_unmeasured(const Eigen::Matrix3d& covariance, core::Nanoseconds t_ns) {
  core::Odometry unmeasured = core::no_motion(t_ns);
  unmeasured.covariance = covariance;
  belief_.filter.predict(unmeasured);
  if (Searching* open = searching()) open->search.move(unmeasured);
  tape_.append(Tape::Slip{unmeasured});
}

/// True when the vehicle slipped: the motion is wider by then, and the scan is associated as it looks from where the
/// slip's pairs put the vehicle; `before`: the confirmation as it was before the scan, so that one scan is no second hit.
/// Else nothing changes.
bool NavigationLoop::allow_for_slip(const core::Scan& scan, const Confirmation& before, core::StepReport& report) {
  const std::optional<Slip> slip = find_slip(scan, report.associations);
  if (!slip) return false;
  report.decisions.emplace_back(slip->figures);
  belief_.slips.add(slip->displacement);
  move_unmeasured(slip->covariance, scan.t_ns);

  std::vector<cekf::Match> pairs;
  for (const SlipPair& pair : slip->pairs) {
    pairs.push_back(
        {pair.landmark, scan.observations[static_cast<std::size_t>(pair.observation)], scan.T_robot_sensor});
  }
  cekf::CompressedEkf moved = belief_.filter;
  update_after_slip(moved, pairs, report.numerics);
  std::vector<LandmarkId> ids = candidates(moved, scan, options_.candidate_sigmas);
  const Searching* open = searching();
  const auto excluded = [&](LandmarkId id) { return open != nullptr && open->search.excludes(id); };
  ids.erase(std::remove_if(ids.begin(), ids.end(), excluded), ids.end());
  const GatedScan gated = gate_scan(moved, ids, scan, options_, belief_.existence.appearance());
  report_unfinished(gated, report);
  belief_.confirmation = before;
  report.associations = associate_scan(gated, options_, belief_.existence.path_m(), belief_.confirmation);
  match_pairs(slip->pairs, report.associations);
  return true;
}

}  // namespace helixnav::supervisor
