// SPDX-License-Identifier: BSD-3-Clause
#include "closing/close_against_odometry.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <variant>
#include <vector>

#include "closing/branch_pairs.hpp"
#include "closing/close_by_merge.hpp"
#include "closing/close_by_replay.hpp"
#include "helixnav/core/odometry.hpp"
#include "smoothing/smooth_drive.hpp"

namespace helixnav::supervisor {
namespace {

constexpr double largest_factor = 1000.0;  ///< of a variance; beyond it was no noise
constexpr int free_dof = 3;                ///< of a pose

struct Input {
  const cekf::CompressedEkf& filter;
  const core::PoseGaussian& start;
  const ClosingView& view;
  const ForbiddenPlace& place;
  const SearchOptions& options;
  Branch branch;
};

/// By how much the variance of odometry was too small, had the pairs cost what they should.
double factor_from(const Closing& closing) {
  const double should_cost = closing.dof - free_dof;
  return (closing.cost - should_cost) / free_dof;
}

/// Since any of the old landmarks was last seen: along that drive odometry was wrong.
double length_of_loop(const ClosingView& view, const std::vector<pf_relocalize::ConstellationPair>& pairs) {
  double last_seen_m = 0.0;
  for (const association::LandmarkRecord& record : view.life.records()) {
    const bool is_paired =
        std::any_of(pairs.begin(), pairs.end(), [&](const auto& p) { return p.old_landmark == record.id; });
    if (is_paired) last_seen_m = std::max(last_seen_m, record.last_seen_path_m);
  }
  return view.life.path_m() - last_seen_m;
}

/// The drive solved with the tape, and the branch merged at the place; false when either is refused.
bool solve_and_merge(const Input& in, Tape tape, const std::set<core::LandmarkId>& displaced, Reconciled& result) {
  Smoothing smoothing = smooth_drive(in.filter, in.start, tape, displaced);
  result.closing = {};
  if (!smoothing.solved) return false;
  result.closing =
      close_by_merge(*smoothing.solved, in.place.pairs, in.branch, in.view.search.old_landmarks(), in.options);
  if (!result.closing.accepted) return false;
  tape.append(Tape::Solved{smoothing.chi2});
  result.filter = std::move(smoothing.solved);
  result.tape = std::move(tape);
  return true;
}

bool close_with_larger_noise(const Input& in, Reconciled& result) {
  constexpr int most_trials = 4;
  double factor = std::max(1.0, factor_from(in.place.as_measured));
  for (int trial = 0; trial < most_trials && factor <= largest_factor; ++trial) {
    result.odometry_factor = factor;
    if (solve_and_merge(in, in.view.record.tape.with_larger_noise(factor, result.loop_m), {}, result)) return true;
    if (result.closing.dof == 0) return false;
    factor *= std::max(2.0, factor_from(result.closing));
  }
  return false;
}

/// From where the filter has the vehicle to where the place says it was, as uncertain as it is large.
core::Odometry jump_from(const core::PoseGaussian& pose, const core::Pose2& T_map_branch) {
  core::Odometry jump = core::no_motion(0);
  jump.T_before_after = core::between(pose.mean, core::compose(T_map_branch, pose.mean));
  const double moved_m2 = jump.T_before_after.position_m().squaredNorm();
  const double turned_rad2 = jump.T_before_after.heading_rad * jump.T_before_after.heading_rad;
  const Eigen::Vector3d of_pose = pose.covariance.diagonal();
  jump.covariance.diagonal() << moved_m2 + of_pose.x(), moved_m2 + of_pose.y(), turned_rad2 + of_pose.z();
  return jump;
}

/// One who is carried away sees no more of what he has mapped. The last such place of the tape before the branch: nothing
/// that was begun before it was matched after it.
struct Cut {
  Tape::Position position = 0;
  core::Odometry odometry_since;         ///< up to now
  std::set<core::LandmarkId> displaced;  ///< begun after it
};

std::optional<Cut> last_cut(const Tape& tape, const std::vector<pf_relocalize::ConstellationPair>& pairs) {
  struct Seen {
    Tape::Position first, last;
  };
  std::map<core::LandmarkId, Seen> seen;
  const core::MergedIds ids = merged_ids(tape);
  Tape::Position position = 0;
  tape.read_from(0, [&](const Tape::Entry& entry) {
    ++position;
    if (const auto* scan = std::get_if<Tape::Scan>(&entry)) {
      for (const cekf::Match& match : used_observations(*scan)) {
        seen.emplace(ids.now(match.landmark), Seen{position, position}).first->second.last = position;
      }
    }
  });
  Tape::Position at = position;
  for (const pf_relocalize::ConstellationPair& pair : pairs) {
    const auto found = seen.find(pair.branch);
    if (found != seen.end()) at = std::min(at, found->second.first);
  }
  // Whoever was begun before and matched after it moves the cut back to where that one was begun.
  Cut cut;
  for (bool moved = true; moved;) {
    moved = false;
    for (const auto& [id, one] : seen) {
      if (one.first >= at || one.last < at) continue;
      at = one.first;
      moved = true;
    }
  }
  for (const auto& [id, one] : seen) {
    if (one.first < at) cut.position = std::max(cut.position, one.last);
    if (one.first >= at) cut.displaced.insert(id);
  }
  if (cut.position == 0) return std::nullopt;
  cut.odometry_since = core::no_motion(0);
  position = cut.position;
  tape.read_from(cut.position, [&](const Tape::Entry& entry) {
    const auto* motion = std::get_if<Tape::Motion>(&entry);
    if (motion != nullptr) cut.odometry_since = core::chain(cut.odometry_since, motion->odometry);
  });
  return cut;
}

bool close_after_cut(const Input& in, Reconciled& result) {
  const std::optional<Cut> cut = last_cut(in.view.record.tape, in.place.pairs);
  if (!cut) return false;
  core::PoseGaussian there = in.filter.pose();
  there.mean = core::compose(there.mean, core::inverse(cut->odometry_since.T_before_after));
  const core::Odometry jump = jump_from(there, in.place.T_map_branch);
  return solve_and_merge(in, in.view.record.tape.with_jump(cut->position, jump), cut->displaced, result);
}

/// Where the drive as a whole is not known any more.
bool replay_after_jump(const Input& in, Reconciled& result) {
  const BranchRecord& record = in.view.record;
  cekf::CompressedEkf filter = in.filter;
  filter.restore(record.trigger.filter);
  Tape tape = record.tape.with_jump(record.trigger.position, jump_from(filter.pose(), in.place.T_map_branch));
  filter = in.filter;
  result.closing = replay_with_pairs(filter, {record.trigger, tape}, kept_removed(in.place.pairs), in.branch,
                                     in.view.search.old_landmarks(), in.options, {});
  if (!result.closing.accepted) return false;
  result.filter = std::move(filter);
  result.tape = std::move(tape);
  return true;
}

}  // namespace

Reconciled close_against_odometry(const cekf::CompressedEkf& filter, const core::PoseGaussian& start,
                                  const ClosingView& view, const ForbiddenPlace& place, const SearchOptions& options) {
  const Input in{filter, start, view, place, options, branch_of(view, options)};
  Reconciled result;
  result.loop_m = length_of_loop(view, place.pairs);
  const bool holds_drive = view.record.tape.holds_drive();
  if (holds_drive && close_with_larger_noise(in, result)) return result;
  result.odometry_factor = 0.0;
  if (!(holds_drive && close_after_cut(in, result))) replay_after_jump(in, result);
  return result;
}

}  // namespace helixnav::supervisor
