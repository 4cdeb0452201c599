// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <variant>
#include <vector>

#include "helixnav/cekf/match.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/merged_ids.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/supervisor/systematic_errors.hpp"
#include "loop/judge_fix.hpp"

namespace helixnav::supervisor {

/// What came in and what became of it, in order. Replaying a search, rolling back and solving the drive all read this.
/// Memory: about 200 bytes per scan and 200 per observation used, over the whole drive while its scans and fixes are at
/// most `most_stops`; beyond that, or after drop_drive(), only what a checkpoint may still need. Scans since the last
/// checkpoint keep all their observations, earlier ones only those that were used. Test: supervisor/tape_test.cpp.
class Tape {
 public:
  /// Motion as one prediction of the filter, with the length of road and the time it covers.
  struct Motion {
    core::Odometry odometry;
    double driven_m = 0.0;
    TimeMoved time = {};
  };
  /// Motion that odometry did not measure. It is decided again when the scans are processed again.
  struct Slip {
    core::Odometry motion;
  };
  struct Fix {
    WidenedFix used;
    double nis = 0.0;
    bool accepted = false;
  };
  struct Scan {
    core::Scan scan;
    std::vector<core::AssociationReport> fate;  ///< outcome of its observations
    double nis = 0.0;                           ///< νᵀS⁻¹ν of the joint update
    int dof = 0;
    std::vector<core::LandmarkId> died;  ///< removed after it
    bool slipped = false;                ///< updated by update_after_slip
  };
  /// Landmarks merged by a closing, and the χ² that it may cost: its J is that of a filter linearised elsewhere, too
  /// small by tens if the pose was uncertain by a radian, and any solution of the drive within the limit would have
  /// been accepted.
  struct Merge {
    std::vector<core::MergedLandmarks> merged;
    double cost = 0.0;
  };
  /// The drive was solved as a whole: cost of all earlier measurements.
  struct Solved {
    double cost = 0.0;
  };
  using Entry = std::variant<Motion, Slip, Fix, Scan, Merge, Solved>;

  /// Counts entries from the beginning of the drive.
  using Position = std::size_t;

  explicit Tape(int most_stops) : most_stops_(most_stops) {}

  void append(Entry entry);
  Position begin() const { return forgotten_; }
  Position end() const { return forgotten_ + entries_.size(); }

  /// The tape of the same drive, had the covariances of all observations and of all measured motion been this many
  /// times as large. Costs are divided by the smaller factor: an upper bound, since nothing is solved again.
  Tape rescaled(double observations, double odometry) const;

  /// The tape, had all fixes been widened as much as this; those that are wider stay so, and so do costs, as upper bounds.
  Tape with_wider_fixes(double widened) const;

  /// The tape, had the covariance of the motion measured over the last `length_m`, or over as much until `ago_m` before its end, been
  /// this many times as large; costs stay as they were, which is an upper bound.
  Tape with_larger_noise(double odometry, double length_m, double ago_m = 0.0) const;

  /// The tape with these errors taken out of what was measured; costs stay as they were, which is an upper bound if the
  /// measurements have them.
  Tape without(const SystematicErrors& errors) const;

  /// The tape with an unmeasured motion inserted at `position`.
  Tape with_jump(Position position, const core::Odometry& jump) const;

  /// The tape without matches after `position` except those with these landmarks (ids as they are now); costs stay as they
  /// were, which is an upper bound.
  Tape without_matches_since(Position position, const std::set<core::LandmarkId>& but_with) const;

  /// The tape as it was before the merges at its end, and what these may cost.
  Tape without_last_merges() const;
  double cost_of_last_merges() const;

  /// The tape, had the drive not been solved when it last was: its cost is then the sum of all since the solution before.
  Tape without_last_solution() const;

  /// Takes off everything from `position` on and returns it.
  std::vector<Entry> cut(Position position);

  /// Nothing rolls back behind `position` any more: unused observations before it are dropped, and all entries if the
  /// drive is not kept. Amortised O(1) per entry.
  void settle(Position position);

  /// The drive before `position` is kept elsewhere (DriveMap): its entries are forgotten as soon as nothing rolls back
  /// behind them.
  void hand_on(Position position);
  bool holds_since(Position position) const { return forgotten_ <= position; }
  /// Scans and fixes used since the drive was handed on.
  int stops() const { return stops_; }

  /// Whatever settles, entries from `position` on stay as they came in; nothing: no longer.
  void keep_since(std::optional<Position> position) { kept_since_ = position; }

  /// Keeps only what is needed since the last checkpoint from now on; the drive can no longer be solved as a whole.
  void drop_drive() { most_stops_ = 0; }
  bool holds_drive() const { return handed_on_ == 0 && stops_ <= most_stops_ && stops_ > 0; }

  /// Calls read(entry) for every entry from `position` on.
  template <class Read>
  void read_from(Position position, Read&& read) const {
    read_between(position, end(), read);
  }
  /// Likewise, up to but not including the entry at `until`.
  template <class Read>
  void read_between(Position position, Position until, Read&& read) const {
    const Position first = position > forgotten_ ? position - forgotten_ : 0;
    for (Position i = first; i + forgotten_ < until; ++i) read(entries_[i]);
  }

 private:
  void forget(Position position);

  std::vector<Entry> entries_;
  Position forgotten_ = 0;
  Position settled_ = 0;
  Position handed_on_ = 0;
  std::optional<Position> kept_since_;
  int most_stops_;
  int stops_ = 0;  ///< scans and fixes used since the beginning of the drive, or since it was handed on
};

/// Observations that a scan's update and augmentation used: the matched ones, then those that began landmarks.
std::vector<cekf::Match> used_observations(const Tape::Scan& scan);

/// νᵀS⁻¹ν of all scans from `position` on.
cekf::UpdateResult innovation_cost(const Tape& tape, Tape::Position position);

/// Cost of all measurements and closings of the drive: for a linear filter the minimum over all drives and maps. `before`:
/// the cost of what is before `position`.
double drive_cost(const Tape& tape, Tape::Position position = 0, double before = 0.0);

/// The present id of every landmark merged by a closing since `position`.
core::MergedIds merged_ids(const Tape& tape, Tape::Position position = 0);

/// A place where something may have been observed, and how the vehicle got there from the previous one.
struct Stop {
  core::Nanoseconds t_ns = 0;
  std::optional<core::Odometry> motion;
  std::vector<cekf::Match> seen;  ///< used observations
  std::optional<core::AbsoluteFix> fix;
  bool repeats = false;  ///< nothing new from where the vehicle stands (StandingLooks)
};

/// The scans and accepted fixes of the drive since `position`, or between two positions, motion chained in between.
std::vector<Stop> stops_of(const Tape& tape, Tape::Position position = 0);
std::vector<Stop> stops_between(const Tape& tape, Tape::Position position, Tape::Position until);
/// Motion since the last stop, or since `position`.
std::optional<core::Odometry> motion_after_stops(const Tape& tape, Tape::Position position = 0);

}  // namespace helixnav::supervisor
