// SPDX-License-Identifier: BSD-3-Clause
// The vehicle was carried away: what was mapped is kept as an earlier map, and a new part of the drive begins.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/supervisor/joint_map.hpp"
#include "loop/navigation_loop.hpp"
#include "placing/still_there.hpp"

namespace helixnav::supervisor {
namespace {

using core::LandmarkId;
using core::StepReport;

constexpr std::size_t least_to_keep = 5;    ///< fewest pairs that a place has
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

/// What cancellation has taken from a covariance is added to the variance of every landmark, as if it were noise of its
/// own. Cost O(n³).
void make_definite(Eigen::MatrixXd& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance, Eigen::EigenvaluesOnly);
  const double least = solver.eigenvalues().minCoeff();
  if (!(least < 0.0)) return;
  constexpr double margin = 2.0;
  covariance.diagonal().array() -= margin * least;
}

core::CarriedDecision found_out(const StillThere& there) {
  core::CarriedDecision decision;
  decision.cause = core::CarriedDecision::Cause::found_out;
  decision.missing = there.missing;
  decision.seen = there.seen;
  decision.unknown = there.unknown;
  decision.elsewhere_nats = there.elsewhere_nats;
  return decision;
}

core::CarriedDecision with_sigmas(core::CarriedDecision::Cause cause, const Eigen::Matrix3d& covariance) {
  core::CarriedDecision decision;
  decision.cause = cause;
  decision.pose_sigma_m = std::sqrt(std::max(0.0, covariance.topLeftCorner<2, 2>().trace()));
  decision.heading_sigma_deg = std::sqrt(std::max(0.0, covariance(2, 2))) * 180.0 / core::pi;
  return decision;
}

}  // namespace

/// The mature landmarks begun and last seen up to then; none if they are too few to be found again.
core::JointMap NavigationLoop::map_to_keep(core::CarriedDecision& decision, double until_m) const {
  std::vector<core::MapLandmark> kept;
  std::size_t begun = 0;
  for (const association::LandmarkRecord& record : belief_.existence.records()) {
    begun += record.born_path_m <= until_m;
    if (record.state != core::LandmarkState::mature || record.born_path_m > until_m) continue;
    if (record.last_seen_path_m > until_m || !is_placed(record.id)) continue;
    core::MapLandmark& landmark = kept.emplace_back();
    landmark.id = record.id;
    landmark.observations = record.observations;
    landmark.state = record.state;
    landmark.appearance = belief_.existence.appearance().of(record.id);
  }
  if (std::optional<core::JointMap> factored = factors_to_keep(decision, begun, until_m, kept))
    return std::move(*factored);
  const std::vector<core::PointGaussian> points = sketched(ids_of(kept));
  for (std::size_t i = 0; i < kept.size(); ++i) kept[i].point = points[i];
  kept = nearest(std::move(kept), belief_.filter.pose().mean.position_m());
  if (kept.size() < least_to_keep) kept.clear();
  decision.landmarks = static_cast<int>(kept.size());
  decision.dropped = static_cast<int>(begun - kept.size());
  core::JointMap map = joint_map(joint(ids_of(kept)), next_name(), kept);
  map.reach_m = view_.reach().value_or(0.0);
  if (decision.cause == core::CarriedDecision::Cause::broken_off) make_definite(map.joint.covariance);
  return map;
}

/// All of it, as factors, or nothing.
std::optional<core::JointMap> NavigationLoop::factors_to_keep(core::CarriedDecision& decision, std::size_t begun,
                                                              double until_m,
                                                              const std::vector<core::MapLandmark>& kept) const {
  if (kept.size() < least_to_keep) return std::nullopt;
  std::optional<core::JointMap> map = factored(kept, FactoredMap::whole, until_m);
  if (!map) return std::nullopt;
  map->reach_m = view_.reach().value_or(0.0);
  decision.landmarks = static_cast<int>(map->joint.ids.size());
  decision.dropped = static_cast<int>(begun - map->joint.ids.size());
  return map;
}

LandmarkId NavigationLoop::next_name() const {
  LandmarkId next_name = belief_.filter.next_name();
  for (const association::LandmarkRecord& record : belief_.existence.records()) {
    next_name = std::max(next_name, record.id + 1);
  }
  return next_name;
}

/// Nothing is known about where it is: the frame of the part begins with the vehicle.
Belief NavigationLoop::belief_elsewhere(const core::Pose2& T_part_robot) const {
  return {cekf::CompressedEkf(core::PoseGaussian{T_part_robot, Eigen::Matrix3d::Zero()}, options_.filter),
          association::LandmarkLife(options_.life),
          CoverageTrace(options_.search.coverage_spacing_m),
          {},
          belief_.step};
}

/// Changes nothing in the loop.
NavigationLoop::Part NavigationLoop::part_elsewhere(const core::CarriedDecision& decision) const {
  core::CarriedDecision kept = decision;
  core::JointMap map = map_to_keep(kept, std::numeric_limits<double>::infinity());
  Belief belief = belief_elsewhere(core::Pose2());
  belief.filter.name_from(map.next_name);
  return part_apart(kept, std::move(map), std::move(belief));
}

/// The scans since the pause belong to the part, which therefore goes on in their frame; what they mapped and what they matched is
/// dropped.
NavigationLoop::Part NavigationLoop::part_since(const UnsurePause& pause, core::CarriedDecision decision) const {
  decision.scans = static_cast<int>(belief_.step - pause.step);
  core::JointMap map = map_to_keep(decision, pause.path_m);
  Belief belief = belief_elsewhere(belief_.filter.pose().mean);
  belief.filter.name_from(map.next_name);
  return part_apart(decision, std::move(map), std::move(belief));
}

/// A part with this belief, apart from what else is and from the map.
NavigationLoop::Part NavigationLoop::part_apart(core::CarriedDecision decision, core::JointMap map,
                                                Belief belief) const {
  MapsApart apart = apart_;
  decision.from_part = apart.part;
  decision.part = apart.part = apart.next_part++;
  apart.begun_step = belief_.step - decision.scans;
  apart.placing.reset();
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
  NoiseLearner noise = noise_;
  noise.moved.setZero();
  noise.systematic.leave_tape();
  noise.scale.applied_observations = noise.scale.observations();
  noise.scale.applied_odometry = noise.scale.odometry();
  return {{},
          std::move(belief),
          std::move(tape),
          std::move(mode),
          std::move(pending),
          std::move(questions),
          std::move(apart),
          std::move(noise)};
}

void NavigationLoop::exchange(Part& other) noexcept {
  std::swap(start_, other.start);
  std::swap(belief_, other.belief);
  std::swap(tape_, other.tape);
  std::swap(mode_, other.mode);
  pending_.motion.swap(other.pending.motion);
  std::swap(pending_.driven_m, other.pending.driven_m);
  std::swap(pending_.time, other.pending.time);
  pending_.decisions.swap(other.pending.decisions);
  std::swap(pending_.numerics, other.pending.numerics);
  std::swap(questions_, other.questions);
  std::swap(apart_, other.apart);
  std::swap(noise_, other.noise);
}

void NavigationLoop::lose(const core::Lost&) {
  Part elsewhere = part_elsewhere({});
  exchange(elsewhere);
  rhythm_.lose_last();
  odometry_rhythm_.lose_last();
  pause_.reset();
  pauses_.clear();
}

/// Where on the drive the pause was that this scan may tell about: the one that ends with it, or one that the scans
/// since have left undecided.
std::optional<UnsurePause> NavigationLoop::pause_to_weigh(const core::Scan& scan) const {
  if (!is_monitored()) return std::nullopt;
  if (rhythm_.is_pause(scan.t_ns, pending_.driven_m)) return UnsurePause{belief_.existence.path_m(), belief_.step};
  if (!pause_) return std::nullopt;
  const double driven_m = belief_.existence.path_m() + pending_.driven_m - pause_->path_m;
  return driven_m <= options_.search.rest_m ? pause_ : std::nullopt;
}

StillThere NavigationLoop::weigh_pause(const core::Scan& scan, double paused_m) const {
  constexpr double some_scans = 3.0;
  const double lately_m = std::max(options_.life.look_distance_m, some_scans * rhythm_.driven_mean_m());
  const core::Pose2 T_before_now = pending_.motion ? pending_.motion->T_before_after : core::Pose2{};
  return still_there(belief_.filter, belief_.existence, T_before_now, scan, {paused_m - lately_m, paused_m}, options_);
}

StepReport NavigationLoop::observe_elsewhere(const core::Scan& scan, const StillThere& there,
                                             const UnsurePause& pause) {
  const bool is_first = pause.step == belief_.step;
  return is_first ? begin_part_with(scan, found_out(there)) : observe_in(part_since(pause, found_out(there)), scan);
}

/// As observe(), but in a part of the drive that begins with this scan.
StepReport NavigationLoop::begin_part_with(const core::Scan& scan, const core::CarriedDecision& decision) {
  return observe_in(part_elsewhere(decision), scan);
}

StepReport NavigationLoop::observe_in(Part other, const core::Scan& scan) {
  exchange(other);
  try {
    return observe_here(scan);
  } catch (...) {
    exchange(other);
    throw;
  }
}

/// If variances of 10⁵ m² and more have cancelled until nothing is left of a landmark's 0.01 m², the map is kept as it
/// was and the drive goes on beside it: its place is found by landmarks alone, which needs no prior. If a part that
/// begins like that fails at once, or nothing of it can be kept, the cause is another one, and the error remains an
/// error.
StepReport NavigationLoop::observe_somewhere(const core::Scan& scan) {
  try {
    return observe_here(scan);
  } catch (const core::NumericalError&) {
    const core::CarriedDecision broken = broken_off();
    core::CarriedDecision kept = broken;
    map_to_keep(kept, std::numeric_limits<double>::infinity());
    if (kept.landmarks == 0) throw;
    return begin_part_with(scan, broken);
  }
}

core::CarriedDecision NavigationLoop::broken_off() const {
  return with_sigmas(core::CarriedDecision::Cause::broken_off, belief_.filter.pose().covariance);
}

core::CarriedDecision NavigationLoop::without_odometry() const {
  return with_sigmas(core::CarriedDecision::Cause::no_odometry, pending_.motion->covariance);
}

}  // namespace helixnav::supervisor
