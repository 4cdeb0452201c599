// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "helixnav/evaluation/referee.hpp"
#include "identities.hpp"

namespace helixnav::evaluation {

/// An estimated pose and the true one, and the old landmarks by which the vehicle was located.
struct Judgeable {
  core::PoseGaussian estimate;
  core::Pose2 truth;
  std::set<core::LandmarkId> recognised = {};
};

/// Absolute values.
PoseError error_between(const core::Pose2& estimate, const core::Pose2& truth);

/// A pose to be judged by the map of its own time, which a later closing moves. It is judged at the first scan for
/// which it no longer holds, because listing a map is costly.
struct Judgement {
  std::optional<Judgeable> open;
  std::optional<JudgedPose> judged;  ///< if nothing is open

  bool is_known() const { return open || judged; }
};

/// What was seen so far.
struct Referee::Book {
  const core::Recording& recording;
  std::vector<double> returns_at_m;
  RefereeOptions options;
  double in_sight_m;
  Identities identities;
  std::vector<std::set<core::Label>> seen_until_return;  ///< trees, up to then
  std::set<core::Label> seen;
  std::set<core::Label> old_trees;  ///< at the present return
  double driven_m = 0.0;
  double reentered_at_m = std::numeric_limits<double>::quiet_NaN();  ///< of the present return
  bool triggered = false;                                            ///< since the present return
  int wrong_so_far = 0;                   ///< wrong old matches since the present return, while nothing triggered
  bool on_old_ground = false;             ///< in the present scan
  std::set<core::LandmarkId> recognised;  ///< old landmarks matched in the present scan
  bool judges_at_once;                    ///< a vehicle that is carried leaves its map of that time
  bool is_apart = false;                  ///< it was carried, and the relation of its map to the one before is unknown
  std::size_t steps = 0;
  double last_slip_m = -std::numeric_limits<double>::infinity();  ///< distance driven until then
  core::PoseGaussian pose;
  Judgement last_on_old_ground;  ///< or at a closing behind it
  Judgement last_associated;     ///< with old ground, since the present return
  RunScore score;

  Book(const core::Recording& run, std::vector<double> returns_m, const RefereeOptions& how, double sight_m)
      : recording(run),
        returns_at_m(std::move(returns_m)),
        options(how),
        in_sight_m(sight_m),
        identities(how.old_sightings),
        judges_at_once(is_carried(run)) {}

  const core::Pose2& truth() const { return recording.true_poses[steps - 1].T_world_robot; }
  /// In the present scan, with old landmarks.
  bool is_associated() const {
    return !is_apart && !score.returns.empty() && static_cast<int>(recognised.size()) >= options.reentry_observations;
  }
  bool is_wrong(const PoseError& error) const {
    return error.position_m > options.wrong_position_m || error.heading_rad > options.wrong_heading_rad;
  }
  bool too_many_wrong(int wrong, int all) const {
    return wrong >= options.least_wrong_pairs && wrong > options.most_wrong_share * all;
  }

  static bool is_carried(const core::Recording& recording);
  void note_carried(const core::StepReport& report);
  void drive_on(const core::StepReport& report, const Map& map_now);
  void begin_return(bool searching);
  void note_triggers(const core::StepReport& report);
  void look_out(const std::vector<core::Label>& labels);
  void note_slips(const core::StepReport& report);
  void count_matches(const core::StepReport& report, const std::vector<core::Label>& labels);
  void revise(const core::StepReport& report);
  void judge_closure(const core::StepReport& report, const std::vector<core::MapLandmark>& map);
  JudgedPose judge(const Judgeable& pose_at, const std::vector<core::MapLandmark>& map) const;
  JudgedPose judge(const Judgement& judgement, const std::vector<core::MapLandmark>& map) const {
    return judgement.open ? judge(*judgement.open, map) : *judgement.judged;
  }
  void judge_if_open(Judgement& judgement, const Map& map_now) const {
    if (!judgement.open) return;
    judgement.judged = judge(*judgement.open, map_now());
    judgement.open.reset();
  }
  PoseError relative_error(const Judgeable& pose_at, const std::vector<core::MapLandmark>& map) const;
  double spacing_m() const;
  void score_map(const std::vector<core::MapLandmark>& map, RunScore& result) const;
  void pass_verdict(RunScore& result) const;
};

}  // namespace helixnav::evaluation
