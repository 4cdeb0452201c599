// SPDX-License-Identifier: BSD-3-Clause
#include "search/constellation_question.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/LU>

#include "helixnav/core/chi2.hpp"
#include "search/may_be_seen.hpp"
#include "search/old_ground.hpp"

namespace helixnav::supervisor {
namespace {

constexpr double until_now = std::numeric_limits<double>::infinity();

bool contains(const std::vector<core::LandmarkId>& sorted, core::LandmarkId id) {
  return std::binary_search(sorted.begin(), sorted.end(), id);
}

std::vector<core::Pose2> in_frame(const core::Pose2& T_world_frame, std::vector<core::Pose2> poses) {
  for (core::Pose2& pose : poses) pose = core::between(T_world_frame, pose);
  return poses;
}

/// Ground looked at on the old drive (base frame) and lately (vehicle frame). Of the old drive, only views that may
/// show a branch landmark at one of `hypotheses` (base frame): others see nothing that is asked about, and a drive is
/// long.
void add_coverage(const SearchView& view, const core::Pose2& T_world_base, double search_begun_path_m,
                  const SearchOptions& options, const std::vector<core::Pose2>& hypotheses,
                  pf_relocalize::Constellation& constellation) {
  const double now_m = view.life.path_m();
  const double old_until_m = search_begun_path_m - options.old_after_m;
  MayBeSeen may_be(constellation.branch, view.scan.field_of_view.max_range_m);
  for (const core::Pose2& T_base_robot : hypotheses)
    may_be.add(core::transform(T_world_base, T_base_robot.position_m()));
  std::vector<core::Pose2> old = view.coverage.between(0.0, old_until_m);
  old.erase(std::remove_if(old.begin(), old.end(),
                           [&](const core::Pose2& pose) { return !may_be.seen_from(pose.position_m()); }),
            old.end());
  constellation.old_drive.T_frame_sensor = in_frame(T_world_base, std::move(old));
  constellation.old_drive.field_of_view = view.scan.field_of_view;
  constellation.new_drive.T_frame_sensor =
      in_frame(view.filter.pose().mean, view.coverage.between(now_m - options.old_after_m, until_now));
  constellation.new_drive.field_of_view = view.scan.field_of_view;
  constellation.new_drive.least_views = 2;
}

/// Largest standard deviation of a landmark as the vehicle has it, in its own frame.
double sigma_from_vehicle_m(const cekf::CompressedEkf& filter, core::LandmarkId id) {
  const core::JointGaussian joint = filter.joint({id});
  Eigen::Matrix<double, 2, 5> J;  // of m − p − θ·J(m − p), unturned
  const Eigen::Vector2d d = joint.points_m.front() - joint.pose.position_m();
  J << -1.0, 0.0, d.y(), 1.0, 0.0,  //
      0.0, -1.0, -d.x(), 0.0, 1.0;
  const Eigen::Matrix2d covariance = J * joint.covariance * J.transpose();
  const double half_trace = 0.5 * covariance.trace();
  return std::sqrt(half_trace + std::sqrt(std::max(0.0, half_trace * half_trace - covariance.determinant())));
}

/// Inside the 99.9 % ellipsoid of the prior.
bool is_likely(const core::Pose2& pose, const core::PoseGaussian& prior) {
  static const double limit = core::chi2_quantile(0.999, 3);
  Eigen::Matrix3d covariance = prior.covariance;
  covariance.diagonal().array() += 1e-9;
  Eigen::Vector3d d = pose.vector() - prior.mean.vector();
  d.z() = core::wrap_to_pi(d.z());
  return d.dot(covariance.inverse() * d) < limit;
}

/// The test with the best rival in the winner's place, against the winner and all rivals that are not the same place.
pf_relocalize::ConstellationVerdict judge_rival(const pf_relocalize::Constellation& constellation,
                                                const pf_relocalize::ConstellationVerdict& verdict,
                                                const pf_relocalize::RivalPoses& poses, const SearchOptions& options) {
  const core::Pose2& candidate = verdict.rival.T_map_robot;
  std::vector<core::Pose2> others{poses.winner};
  for (const core::Pose2& pose : poses.rivals) {
    const bool apart = (pose.position_m() - candidate.position_m()).norm() > options.rivals.apart_m ||
                       std::abs(core::wrap_to_pi(pose.heading_rad - candidate.heading_rad)) > options.rivals.apart_rad;
    if (apart) others.push_back(pose);
  }
  return judge_constellation(constellation, candidate, others, options.constellation);
}

std::vector<pf_relocalize::BranchLandmark> seen_often_enough(std::vector<pf_relocalize::BranchLandmark> branch,
                                                             int least_hits) {
  const auto rare = [&](const pf_relocalize::BranchLandmark& b) { return b.hits < least_hits; };
  branch.erase(std::remove_if(branch.begin(), branch.end(), rare), branch.end());
  return branch;
}

core::VerificationDecision::Verdict verdict_of(pf_relocalize::ConstellationReason reason) {
  using Verdict = core::VerificationDecision::Verdict;
  switch (reason) {
    case pf_relocalize::ConstellationReason::accepted:
      return Verdict::accepted;
    case pf_relocalize::ConstellationReason::too_few_matches:
      return Verdict::too_few_matches;
    case pf_relocalize::ConstellationReason::ratio_too_low:
      return Verdict::ratio_too_low;
    default:
      return Verdict::rival_too_good;
  }
}

}  // namespace

std::vector<core::LandmarkId> reference_landmarks(const SearchView& view, const std::vector<core::LandmarkId>& old,
                                                  double reach_m) {
  const core::PoseGaussian pose = view.filter.pose();
  const double sigma_m = std::sqrt(std::max(0.0, pose.covariance.topLeftCorner<2, 2>().trace()));
  std::vector<core::LandmarkId> near = view.filter.landmarks_within(
      pose.mean.position_m(), view.scan.field_of_view.max_range_m + reach_m + 2.0 * sigma_m);
  near.erase(std::remove_if(near.begin(), near.end(), [&](core::LandmarkId id) { return !contains(old, id); }),
             near.end());
  return near;
}

core::JointGaussian reference_ground(const SearchView& view, const std::vector<core::LandmarkId>& old, double reach_m) {
  return old_ground(view.filter.joint(reference_landmarks(view, old, reach_m)), view.scan.field_of_view.max_range_m);
}

std::vector<pf_relocalize::BranchLandmark> branch_landmarks(const SearchView& view,
                                                            const std::vector<core::LandmarkId>& old,
                                                            const SearchOptions& options) {
  const core::Pose2 T_robot_world = core::inverse(view.filter.pose().mean);
  std::vector<pf_relocalize::BranchLandmark> branch;
  for (const association::LandmarkRecord& record : view.life.records()) {
    if (view.life.path_m() - record.last_seen_path_m > options.branch_seen_within_m) continue;
    if (contains(old, record.id) || !view.filter.contains(record.id)) continue;
    if (3.0 * sigma_from_vehicle_m(view.filter, record.id) > options.constellation.most_tolerance_m) continue;
    branch.push_back({record.id, core::transform(T_robot_world, view.filter.landmark_mean(record.id)), record.hits,
                      view.life.appearance().of(record.id)});
  }
  return branch;
}

namespace {

pf_relocalize::Constellation constellation_on(const pf_relocalize::ReferenceMap& map, const SearchView& view,
                                              const std::vector<core::LandmarkId>& old, const SearchOptions& options) {
  pf_relocalize::Constellation constellation;
  constellation.branch = branch_landmarks(view, old, options);
  for (std::size_t i = 0; i < map.ids.size(); ++i) {
    constellation.old_landmarks.push_back({map.ids[i], map.landmarks[i], view.life.appearance().of(map.ids[i])});
  }
  constellation.population = view.life.appearance().population();
  return constellation;
}

}  // namespace

ConstellationAnswer ask_constellation(const SearchView& view, const std::vector<core::LandmarkId>& old,
                                      double search_begun_path_m, const core::Pose2& T_world_robot,
                                      const SearchOptions& options, std::uint64_t seed) {
  ConstellationAnswer answer;
  answer.T_world_winner = answer.T_world_rival = T_world_robot;
  const core::JointGaussian ground = reference_ground(view, old, options.reach_m);
  if (ground.ids.size() < 3) return answer;
  const pf_relocalize::ReferenceMapResult reference = pf_relocalize::try_reference_map(ground, options.reference);
  if (!reference.map) return answer;  // without a reference map nothing matches
  const pf_relocalize::ReferenceMap& map = *reference.map;

  pf_relocalize::Constellation constellation = constellation_on(map, view, old, options);
  const std::vector<pf_relocalize::BranchLandmark> confirmed =
      seen_often_enough(constellation.branch, options.constellation.least_hits);
  const pf_relocalize::RivalPoses poses =
      pf_relocalize::find_rivals(map, confirmed, core::between(map.T_world_base, T_world_robot), options.rivals, seed);
  std::vector<core::Pose2> hypotheses = poses.rivals;
  hypotheses.push_back(poses.winner);
  add_coverage(view, map.T_world_base, search_begun_path_m, options, hypotheses, constellation);
  answer.verdict = judge_constellation(constellation, poses.winner, poses.rivals, options.constellation);
  if (answer.verdict.rival_share > 1.0 && is_likely(answer.verdict.rival.T_map_robot, map.prior)) {
    pf_relocalize::ConstellationVerdict other = judge_rival(constellation, answer.verdict, poses, options);
    if (other.accepted) {
      answer.verdict = std::move(other);
      answer.adopted = true;
    }
  }
  answer.T_world_winner = core::compose(map.T_world_base, answer.verdict.winner.T_map_robot);
  answer.T_world_rival = answer.verdict.rival.matched > 0
                             ? core::compose(map.T_world_base, answer.verdict.rival.T_map_robot)
                             : answer.T_world_winner;
  return answer;
}

core::VerificationDecision verification_decision(const ConstellationAnswer& answer) {
  const pf_relocalize::ConstellationVerdict& v = answer.verdict;
  core::VerificationDecision decision;
  decision.verdict = verdict_of(v.reason);
  decision.matched = v.winner.matched;
  decision.unmatched_branch = v.winner.unmatched_branch;
  decision.unmatched_old = v.winner.unmatched_old;
  decision.ratio = v.winner.ratio;
  decision.rival_matched = v.rival.matched;
  decision.rival_ratio = v.rival.ratio;
  decision.rival_share = v.rival_share;
  decision.rivals_tried = v.rivals_tried;
  decision.adopted = answer.adopted;
  decision.T_world_winner = answer.T_world_winner;
  decision.T_world_rival = answer.T_world_rival;
  return decision;
}

}  // namespace helixnav::supervisor
