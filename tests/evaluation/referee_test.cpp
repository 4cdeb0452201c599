// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/evaluation/referee.hpp"

#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/decision_row.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::evaluation {
namespace {

using core::Label;
using core::LandmarkId;

constexpr double lap_m = 400.0;
constexpr double step_m = 2.0;
constexpr double range_m = 10.0;
constexpr int trees = 45;
constexpr double tree_spacing_m = 2.0;
constexpr double degrees = core::pi / 180.0;

core::Pose2 on_circle(double along_m) {
  const double angle_rad = 2.0 * core::pi * along_m / lap_m;
  const double radius_m = lap_m / (2.0 * core::pi);
  return {radius_m * std::sin(angle_rad), radius_m * (1.0 - std::cos(angle_rad)), core::wrap_to_pi(angle_rad)};
}

/// Trees along the first 90 m of a circular road of 400 m; each scan sees those within 10 m, in order.
core::Recording circle_drive(double length_m) {
  core::Recording recording;
  for (int i = 0; i < trees; ++i) {
    recording.true_landmarks.push_back({i, on_circle(tree_spacing_m * i).position_m()});
  }
  for (double along_m = 0.0; along_m <= length_m; along_m += step_m) {
    const core::Pose2 pose = on_circle(along_m);
    core::Scan scan;
    scan.field_of_view.max_range_m = range_m;
    std::vector<Label>& labels = recording.labels.emplace_back();
    for (const core::TrueLandmark& tree : recording.true_landmarks) {
      if ((tree.point_m - pose.position_m()).norm() <= range_m) labels.push_back(tree.label);
    }
    scan.observations.resize(labels.size());
    recording.true_poses.push_back({scan.t_ns, pose});
    recording.events.emplace_back(scan);
  }
  return recording;
}

/// A navigator that errs only as scripted. On the first lap landmark = tree; then it creates new landmarks 100 + tree
/// until it closes, and uses the old ones again afterwards.
struct Script {
  std::vector<double> returns_at_m{lap_m};
  double length_m = 490.0;          ///< trees are in view to the end
  double trigger_at_m = 390.0;      ///< beyond the end: never
  const char* trigger = "started";  ///< or "rolled-back"
  double close_at_m = 430.0;        ///< beyond the end: never
  bool new_after_return = true;     ///< false: old landmarks are matched at once
  int swapped_pairs = 0;            ///< of the closing
  int match_shift = 0;              ///< old landmarks are matched with the tree this many further on
  core::Pose2 drift;                ///< of the pose, until the closing or drift_to_m: T_true_estimate
  double drift_to_m = 1e9;
  core::Pose2 error;                    ///< of the pose, from the closing on
  core::Pose2 end_error;                ///< of the last pose, instead of the above, unless it is the identity
  core::Pose2 T_map_true;               ///< the whole map is displaced by this
  std::vector<core::MapLandmark> more;  ///< in the map
  double carried_at_m = 1e9;            ///< from there on the map is a different, empty one
};

class Run {
 public:
  explicit Run(const Script& script) : script_(script), recording_(circle_drive(script.length_m)) {}

  RunScore judged() {
    if (script_.carried_at_m < script_.length_m) recording_.true_carries_ns = {0};
    Referee referee(recording_, script_.returns_at_m);
    const auto map_now = [this] { return map(); };
    for (std::size_t k = 0; k < recording_.labels.size(); ++k) referee.watch(report(k), map_now);
    return referee.score(map());
  }

 private:
  double along_m(std::size_t k) const { return step_m * static_cast<double>(k); }
  bool is_branch(double at_m) const {
    return script_.new_after_return && at_m > lap_m - 50.0 && at_m <= script_.close_at_m;
  }

  core::StepReport report(std::size_t k) {
    const double at_m = along_m(k);
    core::StepReport report;
    report.step = static_cast<std::int64_t>(k);
    const bool last = k + 1 == recording_.labels.size();
    const bool ends_wrong = last && script_.end_error.vector().norm() > 0.0;
    const core::Pose2 error = ends_wrong                                                 ? script_.end_error
                              : at_m >= std::min(script_.close_at_m, script_.drift_to_m) ? script_.error
                                                                                         : script_.drift;
    report.pose.mean = core::compose(script_.T_map_true, core::compose(recording_.true_poses[k].T_world_robot, error));
    report.pose.covariance = Eigen::Vector3d(0.04, 0.04, 1e-4).asDiagonal();
    if (at_m == script_.trigger_at_m) report.decisions.push_back(core::decision_of({"trigger", script_.trigger, {}}));
    for (std::size_t j = 0; j < recording_.labels[k].size(); ++j) {
      report.associations.push_back(association(static_cast<int>(j), recording_.labels[k][j], at_m));
    }
    if (at_m == script_.close_at_m) close(report);
    if (at_m == script_.carried_at_m) {
      known_.clear();
      report.decisions.emplace_back(core::CarriedDecision{});
    }
    return report;
  }

  core::AssociationReport association(int observation, Label label, double at_m) {
    const auto tree = static_cast<LandmarkId>(label);
    const bool again = at_m > lap_m - 50.0;
    const LandmarkId id = is_branch(at_m) ? 100 + tree : again ? (tree + script_.match_shift) % trees : tree;
    core::AssociationReport a;
    a.observation = observation;
    a.landmark = id;
    a.outcome = known_.insert(id).second ? core::Outcome::augmented : core::Outcome::matched;
    return a;
  }

  void close(core::StepReport& report) const {
    report.decisions.push_back(core::decision_of({"closure", "accepted", {}}));
    std::vector<LandmarkId> branch;
    for (const LandmarkId id : known_) {
      if (id >= 100) branch.push_back(id);
    }
    for (std::size_t i = 0; i < branch.size(); ++i) {
      const bool swapped = static_cast<int>(i) < script_.swapped_pairs;
      report.merged.push_back({(branch[i] - 100 + (swapped ? 1 : 0)) % trees, branch[i]});
    }
  }

  std::vector<core::MapLandmark> map() const {
    std::vector<core::MapLandmark> map = script_.more;
    for (const LandmarkId id : known_) {
      if (id >= trees) continue;
      core::MapLandmark& landmark = map.emplace_back();
      landmark.id = id;
      landmark.state = core::LandmarkState::mature;
      landmark.point.mean_m =
          core::transform(script_.T_map_true, recording_.true_landmarks[static_cast<std::size_t>(id)].point_m);
    }
    return map;
  }

  Script script_;
  core::Recording recording_;
  std::set<LandmarkId> known_;
};

RunScore judged(const Script& script) { return Run(script).judged(); }

Script closing_with_error(const core::Pose2& error) {
  Script script;
  script.error = error;
  return script;
}

/// Old landmarks are matched at once, and nothing triggers or closes.
Script association_alone() {
  Script script;
  script.close_at_m = script.trigger_at_m = 1e9;
  script.new_after_return = false;
  return script;
}

TEST(Referee, CallsARightClosingClosed) {
  const RunScore score = judged({});
  EXPECT_EQ(score.verdict, RunVerdict::closed);
  EXPECT_FALSE(score.diverged_after_closure);
  EXPECT_FALSE(score.closed_by_association);
  ASSERT_EQ(score.closures.size(), 1u);
  EXPECT_GT(score.closures[0].pairs, 15);
  EXPECT_EQ(score.closures[0].wrong_pairs, 0);
  EXPECT_EQ(score.triggers, 1);
  EXPECT_EQ(score.wrong_old_matches, 0);
}

TEST(Referee, MeasuresTheDistanceFromTheThirdOldTreeInViewToTheClosing) {
  const RunScore score = judged({});
  ASSERT_EQ(score.returns.size(), 1u);
  const double reentry_m = step_m * static_cast<double>(score.returns[0].reentry_step);
  EXPECT_GE(reentry_m, lap_m - range_m + 2 * tree_spacing_m - 0.1);  // the third tree is 4 m inside
  EXPECT_LE(reentry_m, lap_m - range_m + 2 * tree_spacing_m + step_m);
  EXPECT_NEAR(score.closures[0].after_reentry_m, 430.0 - reentry_m, 0.1);
}

TEST(Referee, CallsAClosingFalseWhenItsPoseIsWrong) {
  EXPECT_EQ(judged(closing_with_error({1.9, 0.0, 0.0})).verdict, RunVerdict::closed);
  EXPECT_EQ(judged(closing_with_error({2.1, 0.0, 0.0})).verdict, RunVerdict::false_closure);
  EXPECT_EQ(judged(closing_with_error({0.0, 0.0, 7.9 * degrees})).verdict, RunVerdict::closed);
  EXPECT_EQ(judged(closing_with_error({0.0, 0.0, -8.1 * degrees})).verdict, RunVerdict::false_closure);
}

TEST(Referee, CallsAClosingFalseWhenItsPairsAreWrong) {
  Script script;
  script.swapped_pairs = 1;
  const RunScore one = judged(script);
  EXPECT_EQ(one.verdict, RunVerdict::closed) << "a single wrong pair is reports::counted, and no more";
  EXPECT_EQ(one.closures.at(0).wrong_pairs, 1);
  script.swapped_pairs = 2;
  EXPECT_EQ(judged(script).verdict, RunVerdict::false_closure);
  script.close_at_m = 484.0;  // 45 pairs: two are less than 5 %
  const RunScore many = judged(script);
  EXPECT_GT(many.closures.at(0).pairs, 40);
  EXPECT_EQ(many.verdict, RunVerdict::closed);
}

TEST(Referee, JudgesThePoseOnTheOldMapAndTellsTheAbsoluteError) {
  Script script;
  script.T_map_true = {4.0, -3.0, 0.0};
  const RunScore score = judged(script);
  EXPECT_EQ(score.verdict, RunVerdict::closed);
  EXPECT_NEAR(score.closures.at(0).pose.absolute.position_m, 5.0, 1e-9);
  EXPECT_NEAR(score.closures.at(0).pose.relative.position_m, 0.0, 1e-9);
  EXPECT_NEAR(score.end.absolute.position_m, 5.0, 1e-9);
  EXPECT_NEAR(score.map_rms_m, 0.0, 1e-9);
}

TEST(Referee, ComputesNeesOfTheAbsoluteError) {
  Script script = closing_with_error({0.0, 0.0, 0.02});
  script.end_error = {0.3, 0.4, 0.0};
  const RunScore score = judged(script);
  EXPECT_NEAR(score.closures.at(0).pose.nees, 0.02 * 0.02 / 1e-4, 1e-6);
  EXPECT_NEAR(score.end.nees, 0.25 / 0.04, 1e-6);
}

TEST(Referee, CallsLateWhatWasClosedRightlyAndThenLost) {
  Script script;
  script.end_error = {2.1, 0.0, 0.0};
  const RunScore score = judged(script);
  EXPECT_EQ(score.verdict, RunVerdict::closed);
  EXPECT_TRUE(score.diverged_after_closure);
}

TEST(Referee, DoesNotCallLateWhatDriftsAfterOldGroundIsLeft) {
  Script script;
  script.length_m = 600.0;  // the last tree is out of view from 500 m on
  script.end_error = {5.0, 0.0, 0.0};
  const RunScore score = judged(script);
  EXPECT_FALSE(score.diverged_after_closure);
  EXPECT_NEAR(score.end.relative.position_m, 5.0, 1e-9);
  EXPECT_NEAR(score.end_on_old_ground.relative.position_m, 0.0, 1e-9);
}

TEST(Referee, JudgesTheEndByAClosingThatComesAfterOldGroundIsLeft) {
  Script script;
  script.length_m = 600.0;
  script.close_at_m = 520.0;  // the last tree is out of view from 500 m on
  script.drift = {6.0, 0.0, 0.0};
  const RunScore right = judged(script);
  EXPECT_EQ(right.verdict, RunVerdict::closed);
  EXPECT_FALSE(right.diverged_after_closure) << "what the closing put right was wrong before it";
  EXPECT_NEAR(right.end_on_old_ground.relative.position_m, 0.0, 1e-9);
  script.error = {1.5, 0.0, 0.0};
  EXPECT_NEAR(judged(script).end_on_old_ground.relative.position_m, 1.5, 1e-9);
}

TEST(Referee, CallsLateWhatIsLostOnOldGroundAfterTheClosing) {
  Script script;
  script.drift = {6.0, 0.0, 0.0};
  script.close_at_m = 480.0;
  script.end_error = {2.1, 0.0, 0.0};  // at 490 m
  EXPECT_TRUE(judged(script).diverged_after_closure);
}

/// The map of that time, which is displaced by 5 m as a whole, is gone when the drive ends.
TEST(Referee, JudgesAVehicleThatIsCarriedAwayOnTheMapOfThen) {
  Script script;
  script.T_map_true = {4.0, -3.0, 0.0};
  script.carried_at_m = 484.0;
  const RunScore score = judged(script);
  EXPECT_EQ(score.verdict, RunVerdict::closed);
  EXPECT_NEAR(score.end_on_old_ground.relative.position_m, 0.0, 1e-9);
}

TEST(Referee, JudgesAClosingByItsPairsWhereNoReturnIsPlanned) {
  Script script;
  script.returns_at_m = {};
  EXPECT_EQ(judged(script).verdict, RunVerdict::undecided) << "a tour that crosses its own way";
  script.swapped_pairs = 1000;
  EXPECT_EQ(judged(script).verdict, RunVerdict::false_closure);
  script.swapped_pairs = 0;
  script.error = {2.1, 0.0, 0.0};
  EXPECT_EQ(judged(script).verdict, RunVerdict::false_closure) << "right pairs, a wrong place";
}

TEST(Referee, CallsAClosingWithoutPairsFalseWhereNothingReturns) {
  Script script;
  script.returns_at_m = {};
  script.new_after_return = false;
  EXPECT_EQ(judged(script).verdict, RunVerdict::false_closure);
}

TEST(Referee, CallsMatchesWithOldLandmarksFalseWhereNothingReturns) {
  Script script = association_alone();
  script.returns_at_m = {};
  script.match_shift = 5;
  const RunScore score = judged(script);
  EXPECT_EQ(score.verdict, RunVerdict::false_closure);
  EXPECT_TRUE(score.closed_by_association);
}

TEST(Referee, LeavesUndecidedWhatWasNotClosed) {
  Script script;
  script.close_at_m = 1e9;
  const RunScore score = judged(script);
  EXPECT_EQ(score.verdict, RunVerdict::undecided);
  EXPECT_EQ(score.old_matches, 0);
}

TEST(Referee, WantsEveryReturnClosed) {
  Script script;
  script.returns_at_m = {lap_m, 2.0 * lap_m};
  EXPECT_EQ(judged(script).verdict, RunVerdict::undecided) << "the second return was never driven";
  script.length_m = 960.0;
  const RunScore both = judged(script);
  EXPECT_EQ(both.verdict, RunVerdict::closed);
  EXPECT_TRUE(both.closed_by_association) << "the second by plain matches";
}

TEST(Referee, JudgesWhatAssociationClosedWhereThatGroundIsLeft) {
  Script script = association_alone();
  script.returns_at_m = {lap_m, 2.0 * lap_m};
  script.length_m = 960.0;
  script.drift = {1.9, 0.0, 0.0};
  script.drift_to_m = 600.0;  // beyond the first return
  EXPECT_EQ(judged(script).verdict, RunVerdict::closed);
  script.drift = {2.1, 0.0, 0.0};
  const RunScore score = judged(script);
  EXPECT_EQ(score.verdict, RunVerdict::false_closure) << "that the second return is right does not help the first";
  EXPECT_NEAR(score.returns.at(0).end_on_old_ground.relative.position_m, 2.1, 1e-9);
  EXPECT_NEAR(score.returns.at(1).end_on_old_ground.relative.position_m, 0.0, 1e-9);
}

TEST(Referee, JudgesWhatAssociationClosedByTheEndAndByItsMatches) {
  Script script = association_alone();
  const RunScore right = judged(script);
  EXPECT_EQ(right.verdict, RunVerdict::closed);
  EXPECT_TRUE(right.closed_by_association);
  script.end_error = {0.0, 2.5, 0.0};
  EXPECT_EQ(judged(script).verdict, RunVerdict::false_closure);
  script.end_error = {};
  script.match_shift = 1;
  EXPECT_EQ(judged(script).verdict, RunVerdict::false_closure);
}

TEST(Referee, DoesNotLetWrongMatchesMakeAnOldLandmarkAnother) {
  Script script = association_alone();
  script.match_shift = 1;
  const RunScore score = judged(script);
  EXPECT_GT(score.old_matches, 300);
  EXPECT_EQ(score.wrong_old_matches, score.old_matches);
  EXPECT_EQ(score.duplicates, 0);
}

TEST(Referee, CountsWrongMatchesBeforeTheTriggerOnly) {
  Script script = association_alone();
  script.match_shift = 1;
  script.trigger_at_m = 386.0;  // no tree is in view yet
  EXPECT_EQ(judged(script).wrong_before_trigger + judged(script).wrong_without_trigger, 0);
  script.trigger_at_m = 394.0;
  const RunScore tardy = judged(script);
  EXPECT_GT(tardy.wrong_before_trigger, 0);
  EXPECT_LT(tardy.wrong_before_trigger, 10);
  EXPECT_EQ(tardy.wrong_without_trigger, 0);
  script.trigger = "rolled-back";
  EXPECT_EQ(judged(script).wrong_before_trigger, tardy.wrong_before_trigger) << "what it undoes had been believed";
}

TEST(Referee, TellsTheWrongMatchesOfReturnsThatNothingTriggered) {
  Script script = association_alone();
  script.match_shift = 1;
  const RunScore never = judged(script);
  EXPECT_EQ(never.wrong_before_trigger, 0);
  EXPECT_GT(never.wrong_without_trigger, 300);
  EXPECT_EQ(never.wrong_without_trigger, never.wrong_old_matches);
  script.returns_at_m = {lap_m, 2.0 * lap_m};
  script.length_m = 960.0;
  const RunScore both = judged(script);
  EXPECT_EQ(both.wrong_without_trigger, both.wrong_old_matches);
  script.trigger_at_m = 786.0;  // the second return has begun, no tree is in view yet
  const RunScore second_only = judged(script);
  EXPECT_EQ(second_only.wrong_without_trigger, second_only.returns.at(0).wrong_old_matches);
  EXPECT_EQ(second_only.wrong_before_trigger, 0);
}

TEST(Referee, CountsMatureDuplicatesAndTheMapsErrorAfterAlignment) {
  Script script;
  script.close_at_m = 1e9;  // the branch stays in the map
  const core::Recording recording = circle_drive(script.length_m);
  for (const LandmarkId id : {103, 104, 105}) {
    core::MapLandmark& landmark = script.more.emplace_back();
    landmark.id = id;
    landmark.state = id == 105 ? core::LandmarkState::tentative : core::LandmarkState::mature;
    landmark.point.mean_m = recording.true_landmarks[static_cast<std::size_t>(id - 100)].point_m;
  }
  const RunScore score = judged(script);
  EXPECT_EQ(score.duplicates, 2);
  EXPECT_EQ(score.mature_landmarks, trees + 2);
  EXPECT_EQ(score.trees_seen, trees);
  EXPECT_NEAR(score.map_rms_m, 0.0, 1e-9);
}

TEST(Referee, CountsMatureLandmarksThatNoTreeWasSeenAs) {
  Script script;
  core::MapLandmark& landmark = script.more.emplace_back();
  landmark.id = 900;  // nothing that was observed
  landmark.state = core::LandmarkState::mature;
  const RunScore score = judged(script);
  EXPECT_EQ(score.not_trees, 1);
  EXPECT_EQ(score.mature_landmarks, trees + 1);
  EXPECT_EQ(score.duplicates, 0);
}

TEST(Referee, TellsTheErrorBeforeOldGroundAndTheSpacingOfTheTrees) {
  Script script;
  script.T_map_true = {3.0, 0.0, 0.0};
  const RunScore score = judged(script);
  EXPECT_NEAR(score.returns.at(0).error_before_m, 3.0, 1e-9);
  EXPECT_NEAR(score.spacing_m, tree_spacing_m, 0.01);
}

TEST(Referee, RefusesStepsOutOfOrder) {
  const core::Recording recording = circle_drive(20.0);
  Referee referee(recording, {});
  core::StepReport report;
  report.step = 1;
  EXPECT_THROW(referee.watch(report, [] { return std::vector<core::MapLandmark>{}; }), core::PreconditionError);
}

}  // namespace
}  // namespace helixnav::evaluation
