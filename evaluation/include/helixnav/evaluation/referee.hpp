// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/recording.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::evaluation {

/// Distances are distances driven, measured along the truth.
struct RefereeOptions {
  double wrong_position_m = 2.0;  ///< a pose farther from the truth than this is wrong …
  double wrong_heading_rad = 8.0 * core::pi / 180.0;
  double most_wrong_share = 0.05;   ///< … and so is a closing with a larger share of wrong pairs, if there are …
  int least_wrong_pairs = 2;        ///< … at least this many of them
  double old_after_m = 60.0;        ///< a landmark unseen for this long is old: its identity is fixed
  double old_ground_left_m = 30.0;  ///< at the start of a return, a landmark unseen for this long is old, too
  int old_sightings = 3;            ///< with fewer, neither it nor matches with it count as mapped
  int reentry_observations = 3;     ///< of trees mapped before, in one scan: old ground is re-entered
  int association_matches = 10;     ///< matches with old landmarks after a return: closed without any closure
  double slip_known_m = 150.0;      ///< a slip may be decided up to this distance after it happened
  int relative_landmarks = 8;       ///< number of nearest old ones used for the relative error
};

/// Estimate against truth, absolute values; NaN when unknown.
struct PoseError {
  double position_m = std::numeric_limits<double>::quiet_NaN();
  double heading_rad = std::numeric_limits<double>::quiet_NaN();
};

/// A pose in the map, judged. Absolute: in the map frame, which is that of the truth. Relative: after the rigid motion
/// that aligns the recognised old landmarks (or the nearest ones, if fewer than three were recognised) with their
/// trees, so that errors of the old map itself cancel. Absolute if fewer than three are within 80 m. NEES = eᵀP⁻¹e of
/// the absolute error in (x, y, heading).
struct JudgedPose {
  PoseError absolute;
  PoseError relative;
  double nees = std::numeric_limits<double>::quiet_NaN();
};

/// One accepted closure.
struct ClosureScore {
  std::int64_t step = 0;
  double after_reentry_m = std::numeric_limits<double>::quiet_NaN();  ///< NaN: no old ground yet, or closed before
  JudgedPose pose;                                                    ///< after the closing
  int pairs = 0;
  int wrong_pairs = 0;                                            ///< not the same tree, or not a tree
  double rival_share = std::numeric_limits<double>::quiet_NaN();  ///< of the last constellation test that was passed
  bool is_false = false;
};

/// One return to old ground.
struct ReturnScore {
  double error_before_m = std::numeric_limits<double>::quiet_NaN();  ///< position error, before an old tree is in view
  std::int64_t reentry_step = -1;                                    ///< -1: the drive ended before
  int old_matches = 0;                                               ///< by association, until the next return
  int wrong_old_matches = 0;
  bool closed = false;           ///< by a closure or by association
  JudgedPose end_on_old_ground;  ///< as in RunScore, before the next return or the end
  JudgedPose associated;         ///< at the last scan before that with reentry_observations matches with old landmarks
};

enum class RunVerdict {
  closed,         ///< every return was closed, none wrongly
  false_closure,  ///< at least one closing is wrong, by its place or by its pairs' labels
  undecided,      ///< nothing wrong, but a return was left open, or the road never returns
};

/// One run, judged. If nothing returns, `undecided` is the right verdict.
struct RunScore {
  RunVerdict verdict = RunVerdict::undecided;
  bool diverged_after_closure = false;  ///< every closing was right, but the position of end_on_old_ground is wrong
  bool closed_by_association = false;   ///< a return was closed, rightly or wrongly, without any closure
  std::vector<ReturnScore> returns;
  std::vector<ClosureScore> closures;
  int triggers = 0;
  int rolled_back = 0;       ///< searches begun after a rollback
  int refused = 0;           ///< closures
  int undecided = 0;         ///< closures
  int new_ground = 0;        ///< searches that ended as new ground, and …
  int new_ground_wrong = 0;  ///< … those that were in truth on old ground
  int old_matches = 0;
  int wrong_old_matches = 0;
  int wrong_before_trigger = 0;   ///< wrong old matches before the first trigger of a return, rollbacks included
  int wrong_without_trigger = 0;  ///< those in returns without any trigger
  int slips = 0;                  ///< that actually happened (Recording::true_slips_ns)
  int slips_decided = 0;          ///< those the navigator decided on, and …
  int slips_unfounded = 0;        ///< … those of them without a true slip in the last slip_known_m
  double spacing_m = 0.0;         ///< median distance from a tree seen before the first return to its nearest neighbour
  JudgedPose end;
  JudgedPose end_on_old_ground;  ///< at the last scan with old trees in view, or that closed: behind them, all drift
  int trees_seen = 0;
  int mature_landmarks = 0;
  int duplicates = 0;      ///< mature landmarks on a tree that already has one
  int not_trees = 0;       ///< mature landmarks from false detections or from moving objects
  double map_rms_m = 0.0;  ///< of the mature landmarks after a rigid alignment; NaN with fewer than two
};

/// Scores a navigator's run in a world whose truth is known; nothing of it reaches the navigator. A landmark is the
/// tree that most of its observations came from. The identity of an old landmark is fixed once it has been unseen for
/// old_after_m, or at the begin of a return if it has been unseen for old_ground_left_m, so that wrong matches cannot
/// old landmarks and no closure) is judged by the pose where it was last associated with old landmarks and by its
/// matches. Poses are judged by the relative error; the absolute one is given as well. Test:
/// evaluation/referee_test.cpp (a hand-made report for every verdict).
class Referee {
 public:
  using Map = std::function<std::vector<core::MapLandmark>()>;

  /// `recording` outlives the referee and has labels and a true pose for every scan, else PreconditionError.
  /// `returns_at_m` ascending, as in World.
  Referee(const core::Recording& recording, std::vector<double> returns_at_m, const RefereeOptions& options = {});
  ~Referee();
  Referee(Referee&&) noexcept;
  Referee& operator=(Referee&&) noexcept;

  /// Every report in order. `map_now` is called where a closing is to be judged or a return ends, and nowhere else.
  /// PreconditionError for a step that is not the next.
  void watch(const core::StepReport& report, const Map& map_now);

  /// The verdict on what was watched, with the map at its end.
  RunScore score(const std::vector<core::MapLandmark>& map) const;

 private:
  struct Book;
  std::unique_ptr<Book> book_;
};

}  // namespace helixnav::evaluation
