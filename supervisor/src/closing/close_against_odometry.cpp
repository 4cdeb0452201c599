// SPDX-License-Identifier: BSD-3-Clause
#include "closing/close_against_odometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>
#include <variant>
#include <vector>

#include "closing/branch_pairs.hpp"
#include "closing/close_by_merge.hpp"
#include "closing/close_by_replay.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/odometry.hpp"
#include "helixnav/supervisor/lengths.hpp"
#include "smoothing/smooth_drive.hpp"

namespace helixnav::supervisor {
namespace {

constexpr double largest_factor = 1000.0;  ///< of a variance; beyond it, it was not noise
constexpr int free_dof = 3;                ///< of a pose

struct Input {
  const cekf::CompressedEkf& filter;
  const core::PoseGaussian& start;
  const ClosingView& view;
  const ForbiddenPlace& place;
  const SearchOptions& options;
  Branch branch;
};

/// The factor by which the odometry variance was too small, if the pairs should have their expected cost.
double factor_from(const Closing& closing) {
  const double should_cost = closing.dof - free_dof;
  return (closing.cost - should_cost) / free_dof;
}

/// Length driven since any of the paired old landmarks was last seen: over it, odometry was wrong.
double length_of_loop(const ClosingView& view, const std::vector<pf_relocalize::ConstellationPair>& pairs) {
  double last_seen_m = 0.0;
  for (const association::LandmarkRecord& record : view.life.records()) {
    const bool is_paired =
        std::any_of(pairs.begin(), pairs.end(), [&](const auto& p) { return p.old_landmark == record.id; });
    if (is_paired) last_seen_m = std::max(last_seen_m, record.last_seen_path_m);
  }
  return view.life.path_m() - last_seen_m;
}

double reach_of(const ClosingView& view, double when_unbounded_m) {
  return view.scan.field_of_view.reach().value_or(when_unbounded_m);
}

/// Solves the drive with the tape, and merges the branch at the place; false if either is refused.
bool solve_and_merge(const Input& in, Tape tape, Reconciled& result) {
  DriveMap drive(in.start, phase_length_m(reach_of(in.view, reference_reach_m)));
  std::optional<cekf::CompressedEkf> solved;
  Smoothing smoothing;
  result.closing = {};
  try {
    smoothing = smooth_drive(in.filter, tape, drive);
    if (!smoothing.accepted) return false;
    solved = filter_at_solution(drive, in.filter);
  } catch (const core::NumericalError&) {
    return false;
  }
  result.closing = close_by_merge(*solved, in.place.pairs, in.branch, in.view.search.old_landmarks(), in.options);
  if (!result.closing.accepted) return false;
  tape.append(Tape::Solved{smoothing.chi2});
  result.filter = std::move(solved);
  result.tape = std::move(tape);
  return true;
}

bool close_with_larger_noise(const Input& in, Reconciled& result) {
  constexpr int most_trials = 4;
  double factor = std::max(1.0, factor_from(in.place.as_measured));
  for (int trial = 0; trial < most_trials && factor <= largest_factor; ++trial) {
    result.odometry_factor = factor;
    if (solve_and_merge(in, in.view.record.tape.with_larger_noise(factor, result.loop_m), result)) return true;
    if (result.closing.dof == 0) return false;
    factor *= std::max(2.0, factor_from(result.closing));
  }
  return false;
}

/// From where the filter has the vehicle to where the place puts it: known to within the sensor's reach at both ends of
/// the drive since, unless the jump itself is smaller. The pairs fix it far better; a wider prior only costs digits,
/// and with a jump of 250 m and half a turn the covariance was no longer positive definite.
core::Odometry jump_from(const core::PoseGaussian& pose, const core::Pose2& T_map_branch, double driven_since_m,
                         double reach_m) {
  core::Odometry jump = core::no_motion(0);
  jump.T_before_after = core::between(pose.mean, core::compose(T_map_branch, pose.mean));
  const double sigma_m = std::min(jump.T_before_after.position_m().norm(), reach_m);
  const double sigma_rad =
      std::min(std::abs(jump.T_before_after.heading_rad), reach_m / std::max(driven_since_m, reach_m));
  const Eigen::Vector3d of_pose = pose.covariance.diagonal();
  jump.covariance.diagonal() << sigma_m * sigma_m + of_pose.x(), sigma_m * sigma_m + of_pose.y(),
      sigma_rad * sigma_rad + of_pose.z();
  return jump;
}

bool is_born_in(const Tape::Scan& scan, core::LandmarkId id) {
  return std::any_of(scan.fate.begin(), scan.fate.end(), [&](const core::AssociationReport& association) {
    return association.outcome == core::Outcome::augmented && association.landmark == id;
  });
}

/// When each landmark, by its present id, was seen on the tape since a position, from which positions are counted here.
/// One that was mapped before counts as seen at 0.
class Sightings {
 public:
  Sightings(const Tape& tape, Tape::Position from) : from_(from) {
    const core::MergedIds ids = merged_ids(tape);
    tape.read_from(from, [&](const Tape::Entry& entry) {
      driven_m_.push_back(driven_m_.back());
      if (const auto* motion = std::get_if<Tape::Motion>(&entry)) driven_m_.back() += motion->driven_m;
      const auto* scan = std::get_if<Tape::Scan>(&entry);
      if (scan == nullptr) return;
      for (const cekf::Match& match : used_observations(*scan)) {
        std::vector<Tape::Position>& seen = at_[ids.now(match.landmark)];
        if (seen.empty() && !is_born_in(*scan, match.landmark)) seen.push_back(0);
        seen.push_back(end());
      }
    });
  }

  const std::map<core::LandmarkId, std::vector<Tape::Position>>& at() const { return at_; }
  Tape::Position end() const { return driven_m_.size() - 1; }
  Tape::Position on_tape(Tape::Position position) const { return from_ + position; }
  double driven_m(Tape::Position from, Tape::Position until) const { return driven_m_[until] - driven_m_[from]; }

  /// The last position at which the vehicle had driven no more than this until the end.
  Tape::Position position_at(double before_end_m) const {
    constexpr double rounding_m = 1e-6;
    const double driven_m = driven_m_.back() - before_end_m + rounding_m;
    const auto after = std::upper_bound(driven_m_.begin(), driven_m_.end(), driven_m);
    return after == driven_m_.begin() ? 0 : static_cast<Tape::Position>(after - driven_m_.begin()) - 1;
  }

  /// From there back to the last scan that saw something; 0 if there is none.
  Tape::Position last_before(Tape::Position until) const {
    Tape::Position last = 0;
    for (const auto& [id, positions] : at_) {
      for (const Tape::Position at : positions) last = at <= until ? std::max(last, at) : last;
    }
    return last;
  }

  /// First sighting of any paired branch landmark.
  Tape::Position first_of(const std::vector<pf_relocalize::ConstellationPair>& pairs) const {
    Tape::Position first = end();
    for (const pf_relocalize::ConstellationPair& pair : pairs) {
      const auto found = at_.find(pair.branch);
      if (found != at_.end()) first = std::min(first, found->second.front());
    }
    return first;
  }

  /// [position] how often landmarks begun by then were seen after it.
  std::vector<int> across() const {
    std::vector<int> count(driven_m_.size(), 0);
    for (const auto& [id, positions] : at_) {
      for (std::size_t i = 1; i < positions.size(); ++i) {
        ++count[positions.front()];
        --count[positions[i]];
      }
    }
    std::partial_sum(count.begin(), count.end(), count.begin());
    return count;
  }

 private:
  Tape::Position from_;
  std::map<core::LandmarkId, std::vector<Tape::Position>> at_;
  std::vector<double> driven_m_{0.0};
};

struct Cut {
  Tape::Position position = 0;           ///< on the tape
  core::Odometry odometry_since;         ///< up to now
  double driven_since_m = 0.0;           ///< likewise
  std::set<core::LandmarkId> displaced;  ///< begun after it
};

Cut cut_at(Tape::Position position, const Sightings& sightings, const Tape& tape) {
  Cut cut;
  cut.position = sightings.on_tape(position);
  for (const auto& [id, positions] : sightings.at()) {
    if (positions.front() > position) cut.displaced.insert(id);
  }
  cut.odometry_since = core::no_motion(0);
  tape.read_from(cut.position, [&](const Tape::Entry& entry) {
    const auto* motion = std::get_if<Tape::Motion>(&entry);
    if (motion != nullptr) cut.odometry_since = core::chain(cut.odometry_since, motion->odometry);
  });
  cut.driven_since_m = sightings.driven_m(position, sightings.end());
  return cut;
}

/// A vehicle that is carried away no longer sees what it has mapped: the last such place before the branch.
std::optional<Tape::Position> last_place_without_view_across(const Sightings& sightings, Tape::Position branch) {
  const std::vector<int> across = sightings.across();
  Tape::Position unseen = branch;
  while (unseen > 0 && across[unseen - 1] > 0) --unseen;
  if (unseen > 0) --unseen;
  const Tape::Position position = sightings.last_before(unseen);
  return position > 0 ? std::optional(position) : std::nullopt;
}

/// A vehicle put down among trees that fit those it expects still matches some of them: the place within the last
/// `within_m` before the branch with the fewest such matches, if they are few among all matches since.
std::optional<Tape::Position> place_with_fewest_across(const Sightings& sightings, Tape::Position branch,
                                                       double within_m) {
  const std::vector<int> across = sightings.across();
  Tape::Position best = branch - 1;
  for (Tape::Position at = branch; at-- > 1 && sightings.driven_m(at, branch) <= within_m;) {
    if (across[at] < across[best]) best = at;
  }
  std::ptrdiff_t since = 0;
  for (const auto& [id, positions] : sightings.at()) {
    since += std::count_if(positions.begin(), positions.end(), [&](Tape::Position at) { return at > best; });
  }
  constexpr int few = 3;  // at most one in three
  const bool is_cut = best > 0 && few * across[best] <= since;
  return is_cut ? std::optional(best) : std::nullopt;
}

core::Odometry jump_at(const Input& in, const Cut& cut) {
  core::PoseGaussian there = in.filter.pose();
  there.mean = core::compose(there.mean, core::inverse(cut.odometry_since.T_before_after));
  return jump_from(there, in.place.T_map_branch, cut.driven_since_m,
                   reach_of(in.view, std::numeric_limits<double>::max()));
}

bool close_at_cut(const Input& in, const Cut& cut, const Tape& tape, Reconciled& result) {
  const core::Odometry jump = jump_at(in, cut);
  return solve_and_merge(in, tape.with_jump(cut.position, jump), result);
}

/// Where it is known to have been carried. A later cut, as on a bare street, would leave what was mapped in between where it never was.
bool close_where_carried(const Input& in, double carried_m, const Sightings& sightings, Reconciled& result) {
  const Tape& tape = in.view.record.tape;
  const Tape::Position at = sightings.last_before(sightings.position_at(in.view.life.path_m() - carried_m));
  return at > 0 && close_at_cut(in, cut_at(at, sightings, tape), tape, result);
}

bool close_after_cut(const Input& in, Reconciled& result) {
  const Tape& tape = in.view.record.tape;
  const Sightings sightings(tape, 0);
  if (in.place.carried_m) return close_where_carried(in, *in.place.carried_m, sightings, result);
  const Tape::Position branch = sightings.first_of(in.place.pairs);
  if (branch == 0) return false;
  const auto unseen = last_place_without_view_across(sightings, branch);
  if (unseen && close_at_cut(in, cut_at(*unseen, sightings, tape), tape, result)) return true;
  const auto fewest = place_with_fewest_across(sightings, branch, in.options.branch_seen_within_m);
  if (!fewest || fewest == unseen) return false;
  const Cut cut = cut_at(*fewest, sightings, tape);
  return close_at_cut(in, cut, tape.without_matches_since(*fewest, cut.displaced), result);
}

bool replay_with_jump(const Input& in, Tape::Position position, const core::Odometry& jump, Reconciled& result) {
  const BranchRecord& record = in.view.record;
  Tape tape = record.tape.with_jump(position, jump);
  cekf::CompressedEkf filter = in.filter;
  result.closing = replay_with_pairs(filter, {record.trigger, tape}, kept_removed(in.place.pairs), in.branch,
                                     in.view.search.old_landmarks(), in.options, {});
  if (!result.closing.accepted) return false;
  result.filter = std::move(filter);
  result.tape = std::move(tape);
  return true;
}

/// For a drive that is no longer kept as a whole: the jump is where the vehicle stopped seeing what it had mapped,
/// otherwise where the search began, as it did if everything had vanished.
bool replay_after_jump(const Input& in, Reconciled& result) {
  const BranchRecord& record = in.view.record;
  const Sightings sightings(record.tape, record.trigger.position);
  const auto unseen = last_place_without_view_across(sightings, sightings.first_of(in.place.pairs));
  if (unseen && !in.place.carried_m) {
    const Cut cut = cut_at(*unseen, sightings, record.tape);
    if (replay_with_jump(in, cut.position, jump_at(in, cut), result)) return true;
  }
  cekf::CompressedEkf filter = in.filter;
  filter.restore(record.trigger.filter);
  const double driven_since_m = sightings.driven_m(0, sightings.end());
  const core::Odometry jump = jump_from(filter.pose(), in.place.T_map_branch, driven_since_m,
                                        reach_of(in.view, std::numeric_limits<double>::max()));
  return replay_with_jump(in, record.trigger.position, jump, result);
}

}  // namespace

double nats_against_odometry(const Closing& as_measured) {
  constexpr double something_else = 1e-6;
  return std::min(1.5 * std::log(std::max(1.0, factor_from(as_measured))), -std::log(something_else));
}

bool was_no_noise(const Closing& as_measured) { return factor_from(as_measured) > largest_factor; }

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
