// SPDX-License-Identifier: BSD-3-Clause
// The vehicle was carried away: what was mapped is kept as an earlier map, and a new part of the drive begins.
#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "helixnav/supervisor/joint_map.hpp"
#include "loop/navigation_loop.hpp"

namespace helixnav::supervisor {
namespace {

using core::LandmarkId;

constexpr std::size_t least_to_keep = 5;    ///< pairs that a place has at least
constexpr std::size_t most_to_keep = 3000;  ///< joint covariance of 290 MB

/// The landmarks nearest to a point, ascending by name.
std::vector<core::MapLandmark> nearest(std::vector<core::MapLandmark> landmarks, const Eigen::Vector2d& point_m) {
  if (landmarks.size() <= most_to_keep) return landmarks;
  const auto nearer = [&](const core::MapLandmark& a, const core::MapLandmark& b) {
    return std::make_pair((a.point.mean_m - point_m).norm(), a.id) <
           std::make_pair((b.point.mean_m - point_m).norm(), b.id);
  };
  std::sort(landmarks.begin(), landmarks.end(), nearer);
  landmarks.resize(most_to_keep);
  std::sort(landmarks.begin(), landmarks.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return landmarks;
}

}  // namespace

/// The mature landmarks; none where they are too few to be found again.
core::JointMap NavigationLoop::map_to_keep(core::CarriedDecision& decision) const {
  std::vector<core::MapLandmark> kept;
  for (const association::LandmarkRecord& record : belief_.existence.records()) {
    if (record.state != core::LandmarkState::mature) continue;
    core::MapLandmark& landmark = kept.emplace_back();
    landmark.id = record.id;
    landmark.point = sketched({record.id}).front();
    landmark.observations = record.observations;
    landmark.state = record.state;
  }
  kept = nearest(std::move(kept), belief_.filter.pose().mean.position_m());
  if (kept.size() < least_to_keep) kept.clear();
  decision.landmarks = static_cast<int>(kept.size());
  decision.dropped = static_cast<int>(belief_.existence.records().size() - kept.size());
  LandmarkId next_name = belief_.filter.next_name();
  for (const association::LandmarkRecord& record : belief_.existence.records()) {
    next_name = std::max(next_name, record.id + 1);
  }
  core::JointMap map = joint_map(joint(ids_of(kept)), next_name, kept);
  map.reach_m = view_.reach().value_or(0.0);
  return map;
}

/// Nothing is known of where: the frame begins at the vehicle.
Belief NavigationLoop::belief_elsewhere() const {
  return {cekf::CompressedEkf(core::PoseGaussian{}, options_.filter),
          association::LandmarkLife(options_.life),
          CoverageTrace(options_.search.coverage_spacing_m),
          {},
          belief_.step};
}

void NavigationLoop::lose(const core::Lost&) {
  core::CarriedDecision decision;
  core::JointMap map = map_to_keep(decision);
  Belief belief = belief_elsewhere();
  belief.filter.name_from(map.next_name);
  MapsApart apart = apart_;
  decision.from_part = apart.part;
  decision.part = apart.part = apart.next_part++;
  if (!map.joint.ids.empty()) {
    apart.maps.push_back({decision.from_part, std::make_shared<const core::JointMap>(std::move(map))});
  }
  apart.asked.with.clear();
  decision.apart = static_cast<int>(apart.maps.size());
  decision.driven_m = belief_.existence.path_m();
  Pending pending;
  pending.decisions = pending_.decisions;
  if (const Searching* open = searching()) {
    pending.decisions.emplace_back(core::UndecidedDecision{decision.driven_m - open->search.begun_path_m()});
  }
  pending.decisions.emplace_back(decision);
  Tape tape(options_.search.enabled ? options_.search.smooth_up_to_scans : 0);
  Mode mode = Mapping{{}, take_checkpoint(belief, tape), {}};
  WholeMapQuestions questions;
  questions.asked.questions = questions_.asked.questions;

  // Nothing below throws.
  start_ = {};
  belief_ = std::move(belief);
  tape_ = std::move(tape);
  mode_ = std::move(mode);
  pending_ = std::move(pending);
  questions_ = std::move(questions);
  apart_ = std::move(apart);
  noise_.moved.setZero();
  noise_.scale.applied_observations = noise_.scale.observations();
  noise_.scale.applied_odometry = noise_.scale.odometry();
}

}  // namespace helixnav::supervisor
