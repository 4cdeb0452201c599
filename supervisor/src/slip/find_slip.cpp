// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/find_slip.hpp"

#include <algorithm>
#include <cmath>

#include "association/association_report.hpp"
#include "association/view_area.hpp"
#include "slip/density_of_new.hpp"
#include "slip/keep_weighed.hpp"
#include "slip/slip_decision.hpp"

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

std::vector<LandmarkId> ids_of(const std::vector<SlipLandmark>& landmarks) {
  std::vector<LandmarkId> ids;
  for (const SlipLandmark& one : landmarks) ids.push_back(one.id);
  return ids;
}

std::vector<SlipLandmark> well_known(std::vector<SlipLandmark> landmarks) {
  const auto is_not = [](const SlipLandmark& one) { return one.hits < least_hits; };
  landmarks.erase(std::remove_if(landmarks.begin(), landmarks.end(), is_not), landmarks.end());
  return landmarks;
}

/// Unmatched observations that have an unmatched landmark within the distance that a slip may displace it.
int contradictions(const SlipContext& context, const std::vector<SlipLandmark>& near,
                   const std::vector<SeenPoint>& seen, const SlipComponent& widest, SlipReach reach) {
  const double spacing_m = spacing_in(reach, means_m(near));
  const std::vector<LandmarkId> matched = landmarks_with(Outcome::matched, context.fate);
  return static_cast<int>(std::count_if(seen.begin(), seen.end(), [&](const SeenPoint& one) {
    if (context.fate[static_cast<std::size_t>(one.observation)].outcome == Outcome::matched) return false;
    const Eigen::Vector2d at_m = core::transform(context.T_world_robot, one.point_m);
    const double here_m = slip_reach_m(widest, one, spacing_m);
    return std::any_of(near.begin(), near.end(), [&](const SlipLandmark& landmark) {
      return (landmark.at_m - at_m).norm() < here_m && !is_among(matched, landmark.id);
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

/// What the vehicle has looked at twice from places near where it is now, to the rim of the view.
pf_relocalize::Coverage ground_looked_at(const SlipContext& context) {
  pf_relocalize::Coverage looked_at;
  looked_at.field_of_view = context.scan.field_of_view;
  looked_at.range_share = 1.0;
  looked_at.bearing_margin_rad = 0.0;
  looked_at.least_views = 2;
  looked_at.T_frame_sensor = context.looked_from();
  const Eigen::Vector2d here_m = context.T_world_robot.position_m();
  const auto is_far = [&](const core::Pose2& pose) {
    return (pose.position_m() - here_m).norm() > 2.0 * context.scan.field_of_view.max_range_m;
  };
  auto& poses = looked_at.T_frame_sensor;
  poses.erase(std::remove_if(poses.begin(), poses.end(), is_far), poses.end());
  return looked_at;
}

std::optional<Slip> find_slip_within(SlipReach reach, const SlipContext& context, const SlipOptions& options) {
  const std::vector<SeenPoint> seen = seen_points(context.scan, most_weighed);
  std::vector<SlipLandmark> near = context.near();
  const SlipComponent widest = slip_components(options).back();
  keep_weighed(context.T_world_robot, context.scan, seen, widest, reach, near);
  if (contradictions(context, near, seen, widest, reach) < 2) return std::nullopt;

  const double per_m2 = context.extraneous_per_scan / view_area_m2(context.scan.field_of_view);
  const std::vector<SlipLandmark> known = well_known(near);
  const std::vector<double> new_per_m2 = density_of_new(seen, context.T_world_robot, ground_looked_at(context),
                                                        local_density_per_m2(means_m(known)), per_m2);
  const auto ask = [&](const std::vector<SlipLandmark>& witnesses, bool tentative) -> std::optional<Slip> {
    if (witnesses.size() < least_observations) return std::nullopt;
    const RelativeGeometry geometry(context.joint(ids_of(witnesses)));
    return decide_slip({geometry, seen, new_per_m2, associated_pairs(geometry, seen, context.fate),
                        pair_nats(context.detection_probability, per_m2), per_m2, tentative, reach},
                       options);
  };
  std::optional<Slip> slip = ask(known, false);
  if (!slip && known.size() < near.size()) slip = ask(near, true);
  return slip;
}

}  // namespace

/// Where stems are in clumps, landmarks are closer to each other than a slip displaces; the landmark that an
/// observation is of would not be considered there. Only if nothing seen is where it should be: it takes ten times as
/// long.
std::optional<Slip> find_slip(const SlipContext& context, const SlipOptions& options) {
  const double view_m2 = view_area_m2(context.scan.field_of_view);
  if (!options.enabled || !std::isfinite(view_m2) || !(view_m2 > 0.0)) return std::nullopt;
  const std::vector<AssociationReport>& fate = context.fate;
  const auto unmatched = static_cast<std::size_t>(
      std::count_if(fate.begin(), fate.end(), [](const auto& one) { return one.outcome != Outcome::matched; }));
  if (unmatched < 2 || fate.size() < least_observations) return std::nullopt;
  std::optional<Slip> slip = find_slip_within(SlipReach::next_neighbour, context, options);
  const bool is_nearly_all = 4 * unmatched >= 3 * fate.size() && unmatched >= 2 * least_observations;
  if (!slip && is_nearly_all) slip = find_slip_within(SlipReach::any_neighbour, context, options);
  return slip;
}

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

}  // namespace helixnav::supervisor
