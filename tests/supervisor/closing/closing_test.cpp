// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "campaign.hpp"
#include "circuits.hpp"
#include "closing/close_by_merge.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/core/decision_row.hpp"
#include "helixnav/sim/world.hpp"
#include "judged_drive.hpp"

namespace helixnav::supervisor {
namespace {

NavigatorOptions one_thread() {
  NavigatorOptions options;
  options.search.relocalizer.threads = 1;
  return options;
}

/// What each landmark stands for, by the majority of its observations.
class Names {
 public:
  void note(const core::StepReport& report, const std::vector<core::Label>& labels) {
    for (const core::AssociationReport& a : report.associations) {
      const bool used = a.outcome == core::Outcome::matched || a.outcome == core::Outcome::augmented;
      if (used) ++votes_[a.landmark][labels[static_cast<std::size_t>(a.observation)]];
    }
  }
  core::Label of(core::LandmarkId id) const {
    const auto& votes = votes_.at(id);
    return std::max_element(votes.begin(), votes.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
  }

 private:
  std::map<core::LandmarkId, std::map<core::Label, int>> votes_;
};

int count(const core::StepReport& report, const std::string& kind, const std::string& verdict) {
  return static_cast<int>(std::count_if(report.decisions.begin(), report.decisions.end(), [&](const core::Decision& d) {
    const core::DecisionRow row = core::row_of(d);
    return row.kind == kind && row.verdict == verdict;
  }));
}

std::size_t distinct(const std::vector<core::Pose2>& poses) {
  std::set<std::pair<double, double>> places;
  for (const core::Pose2& pose : poses) places.emplace(pose.x_m, pose.y_m);
  return places.size();
}

struct Drive {
  int triggers = 0, rolled_back = 0, closures = 0, smoothed = 0, not_smoothed = 0;
  int searching_scans = 0, clouds = 0, pairs = 0, wrong_pairs = 0;
  double error_after_closing_m = 0.0;
  core::PoseGaussian end;
  double nees_at_end = 0.0;
  std::size_t landmarks = 0;
};

Drive drive_scenario(const std::string& name, std::uint64_t seed, const NavigatorOptions& options) {
  const core::Recording run = sim::simulate(sim::named_scenario(name), seed);
  Navigator navigator(run.start, options);
  Names names;
  Drive result;
  drive(run, navigator, [&](const core::Scan& scan, std::size_t i) {
    const core::StepReport report = navigator.observe(scan);
    result.triggers += count(report, "trigger", "started");
    result.rolled_back += count(report, "trigger", "rolled-back");
    result.smoothed += count(report, "smoothing", "accepted");
    result.not_smoothed += count(report, "smoothing", "refused");
    result.searching_scans += report.mode == core::Mode::searching ? 1 : 0;
    result.clouds += report.cloud.empty() ? 0 : 1;
    EXPECT_EQ(report.drawn.empty(), count(report, "search", "started") == 0);
    EXPECT_EQ(distinct(report.drawn), report.drawn.size());  // resampling would leave duplicates
    if (count(report, "closure", "accepted") > 0) {
      ++result.closures;
      const Eigen::Vector2d truth_m = run.true_poses[i].T_world_robot.position_m();
      result.error_after_closing_m = (report.pose.mean.position_m() - truth_m).norm();
    }
    for (const core::MergedLandmarks& one : report.merged) {
      ++result.pairs;
      result.wrong_pairs += names.of(one.kept) != names.of(one.removed) ? 1 : 0;
      EXPECT_FALSE(navigator.filter().contains(one.removed));
    }
    names.note(report, run.labels[i]);
  });
  result.end = navigator.filter().pose();
  result.nees_at_end = nees(result.end, run.true_poses.back().T_world_robot);
  result.landmarks = navigator.map().size();
  return result;
}

/// Seeds not used in development. At a rate of 20 %, a false closing would show in twelve drives with probability 0.93;
/// campaigns of a thousand are `helixnav montecarlo`.
TEST(ClosingCampaign, ClosesLoopsWithTheRightLandmarksAndAPoseThatIsRight) {
  for (const std::uint64_t seed : support::campaign_seeds(7001, 6)) {
    for (const char* name : {"large-loop-changed", "sparse"}) {
      const Drive drive = drive_scenario(name, seed, one_thread());
      EXPECT_GE(drive.triggers, 1) << name << " " << seed;
      EXPECT_GE(drive.closures, 1) << name << " " << seed;
      EXPECT_GE(drive.pairs, 5 * drive.closures);
      EXPECT_EQ(drive.wrong_pairs, 0) << name << " " << seed;
      EXPECT_LT(drive.error_after_closing_m, 2.0) << name << " " << seed;
      EXPECT_GT(drive.searching_scans, 5);
      EXPECT_GT(drive.clouds, 3);
    }
  }
}

/// drive_scenario checks the drawn cloud against the step that starts an attempt, here with scans in between that are not looks.
TEST(Closing, ShowsWhatWasDrawnInOneStepOnly) {
  NavigatorOptions options = one_thread();
  options.search.look_distance_m = 4.0;
  EXPECT_GT(drive_scenario("sparse", 7001, options).clouds, 3);
}

TEST(ClosingCampaign, ClosesNothingOnARoadThatNeverReturns) {
  for (const std::uint64_t seed : support::campaign_seeds(7101, 6)) {
    EXPECT_EQ(drive_scenario("open-road", seed, one_thread()).closures, 0) << seed;
  }
}

TEST(Closing, IsTheSameForAnyNumberOfThreads) {
  NavigatorOptions two = one_thread();
  two.search.relocalizer.threads = 2;
  const Drive a = drive_scenario("sparse", 7201, one_thread());
  const Drive b = drive_scenario("sparse", 7201, two);
  EXPECT_EQ(a.closures, 1);
  EXPECT_EQ(a.end.mean.vector(), b.end.mean.vector());
  EXPECT_EQ(a.end.covariance, b.end.covariance);
}

TEST(Closing, CanBeSwitchedOff) {
  NavigatorOptions off = one_thread();
  off.search.enabled = false;
  const Drive drive = drive_scenario("large-loop-changed", 7001, off);
  EXPECT_EQ(drive.triggers + drive.closures + drive.searching_scans, 0);
}

// Development drives whose pose was lost because an observation between two old landmarks was assigned to the wrong
// one, each outside the other's gate: 0.3 to 1.5 nats told them apart.
TEST(Closing, SearchesWhereAnObservationMayBeEitherOfTwoOldLandmarks) {
  for (const std::uint64_t seed : {730u, 2073u, 2655u}) {
    const evaluation::RunScore score = navigate_and_judge(sim::named_scenario("figure-of-eight"), seed);
    EXPECT_EQ(score.verdict, evaluation::RunVerdict::closed) << seed;
    EXPECT_EQ(score.wrong_before_trigger + score.wrong_without_trigger, 0) << seed;
    EXPECT_EQ(score.rolled_back, 0) << seed;
  }
}

// Three closings, the second on ground mapped with 10° of drift: two-sided, 0.1 %. What solving the drive is worth
// there is shown by SmoothDriveCampaign.MakesTheFigureOfEightConsistent.
TEST(ClosingCampaign, SolvesTheDriveAndIsConsistentAfterwards) {
  const int runs = support::campaign_runs(12);
  double sum = 0.0;
  for (const std::uint64_t seed : support::campaign_seeds(7301, 12)) {
    const Drive drive = drive_scenario("figure-of-eight", seed, one_thread());
    EXPECT_GE(drive.closures, 1);
    EXPECT_EQ(drive.smoothed, drive.closures);
    sum += drive.nees_at_end;
  }
  const support::Band band = support::chi2_band(runs, 3, 0.001);
  EXPECT_GT(sum, band.low) << "mean " << sum / runs;
  EXPECT_LT(sum, band.high) << "mean " << sum / runs;
}

// A closing, scans processed again in a search from before it, another closing: the log holds what the filter holds.
TEST(Closing, SolvesADriveOfWhichPartWasGoneThroughTwice) {
  const Drive drive = drive_scenario("sparse", 1867, one_thread());
  EXPECT_EQ(drive.rolled_back, 1);
  EXPECT_EQ(drive.closures, 2);
  EXPECT_EQ(drive.smoothed, 2);
}

// A drive whose correct closing was doubted because of the felled trees beside it, and searched for again from before.
TEST(Closing, IsNotDoubtedForWhatItDidNotFind) {
  const Drive drive = drive_scenario("sparse", 7119, one_thread());
  EXPECT_EQ(drive.closures, 1);
  EXPECT_EQ(drive.wrong_pairs, 0);
  EXPECT_LT(drive.error_after_closing_m, 2.0);
  EXPECT_EQ(drive.rolled_back, 0);
}

// For a drive longer than the tape holds, the atlas has been begun before.
TEST(Closing, SolvesDrivesHoweverLongUnlessNoneIsToBe) {
  NavigatorOptions options = one_thread();
  for (const int scans : {0, 100, 20000}) {
    options.search.smooth_up_to_scans = scans;
    const Drive drive = drive_scenario("large-loop-changed", 7001, options);
    EXPECT_EQ(drive.closures, 1);
    EXPECT_EQ(drive.smoothed, scans == 0 ? 0 : 1);
    EXPECT_EQ(drive.not_smoothed, 0);
  }
}

// What a restart discards from the map is not on the tape.
TEST(Closing, LeavesDrivesUnsolvedThatWereRestarted) {
  NavigatorOptions options = one_thread();
  options.search.closing = ClosingMethod::restart;
  const Drive drive = drive_scenario("large-loop-changed", 7001, options);
  EXPECT_EQ(drive.smoothed + drive.not_smoothed, 0);
}

/// Covariance trace of the best-known landmark 90 m from the start, where a fix gave the position to 1 cm.
double best_variance_where_fixed_m2(bool solved) {
  const core::Recording run = sim::simulate(sim::named_scenario("large-loop-changed"), 7001);
  NavigatorOptions options = one_thread();
  options.search.smooth_up_to_scans = solved ? 1000 : 0;
  Navigator navigator(run.start, options);
  constexpr std::size_t fixed_at = 60;
  int smoothed = 0;
  drive(run, navigator, [&](const core::Scan& scan, std::size_t i) {
    smoothed += count(navigator.observe(scan), "smoothing", "accepted");
    if (i != fixed_at) return;
    core::AbsoluteFix fix;
    fix.position_world_m = run.true_poses[i].T_world_robot.position_m();
    fix.covariance_m2 = 1e-4 * Eigen::Matrix2d::Identity();
    EXPECT_TRUE(navigator.fix(fix));
  });
  EXPECT_EQ(smoothed, solved ? 1 : 0);
  double best_m2 = 1e9;
  for (const core::LandmarkId id :
       navigator.filter().landmarks_within(run.true_poses[fixed_at].T_world_robot.position_m(), 15.0)) {
    best_m2 = std::min(best_m2, navigator.filter().landmark(id).covariance_m2.trace());
  }
  return best_m2;
}

TEST(Closing, SolvesTheDriveWithItsFixes) {
  const double solved_m2 = best_variance_where_fixed_m2(true);
  const double filtered_m2 = best_variance_where_fixed_m2(false);
  EXPECT_NEAR(solved_m2, filtered_m2, 0.2 * filtered_m2);
}

/// Five landmarks, seen at the start and again after a drive that the odometry got wrong by `slip_m`.
struct Return {
  cekf::CompressedEkf filter{core::PoseGaussian{}};
  std::vector<core::LandmarkId> old;
  Branch branch;
  std::vector<pf_relocalize::ConstellationPair> pairs;

  explicit Return(double slip_m, double spoiled_m = 0.0) {
    const Eigen::Matrix2d R = 0.01 * Eigen::Matrix2d::Identity();
    const std::vector<Eigen::Vector2d> points{{5.0, 3.0},   {9.0, -4.0}, {14.0, 2.0},
                                              {18.0, -1.0}, {7.0, 8.0},  {12.0, -9.0}};
    for (const Eigen::Vector2d& p : points) old.push_back(filter.augment(core::make_cartesian(p, R), {}));
    core::Odometry odometry;
    odometry.covariance.diagonal() << 4.0, 4.0, 0.01;
    filter.predict(odometry);
    for (std::size_t i = 0; i < points.size(); ++i) {
      Eigen::Vector2d seen = points[i] + Eigen::Vector2d(slip_m, -0.5 * slip_m);
      if (i == 0) seen.x() += spoiled_m;
      const core::LandmarkId id = filter.augment(core::make_cartesian(seen, R), {});
      branch.confirmed.push_back(id);
      if (i + 1 < points.size()) pairs.push_back({id, old[i], 0.0});
    }
  }
};

TEST(CloseByMerge, MergesPairsAndThenWhatHasBecomeACopy) {
  Return back(2.0);
  const Closing closing = close_by_merge(back.filter, back.pairs, back.branch, back.old, {});
  ASSERT_TRUE(closing.accepted);
  EXPECT_EQ(closing.dropped, 0);
  EXPECT_EQ(closing.dof, 10);
  ASSERT_EQ(closing.merged.size(), 6u) << "the sixth by itself";
  EXPECT_EQ(closing.merged.back().kept, back.old.back());
  EXPECT_EQ(back.filter.mapped_count(), 6);
  EXPECT_NEAR(back.filter.pose().mean.x_m, -2.0, 0.2);
  EXPECT_NEAR(back.filter.pose().mean.y_m, 1.0, 0.2);
}

TEST(CloseByMerge, DropsOneWrongPair) {
  Return back(1.0, 1.2);
  const Closing closing = close_by_merge(back.filter, back.pairs, back.branch, back.old, {});
  ASSERT_TRUE(closing.accepted);
  EXPECT_EQ(closing.dropped, 1);
  for (const core::MergedLandmarks& one : closing.merged) EXPECT_NE(one.kept, back.old.front());
}

/// Twelve landmarks seen again, of which the first `wrong` are of other things beside them, each on another side.
Closing close_with_wrong_pairs(int wrong) {
  const Eigen::Matrix2d R = 0.0025 * Eigen::Matrix2d::Identity();
  cekf::CompressedEkf filter{core::PoseGaussian{}};
  std::vector<core::LandmarkId> old;
  std::vector<Eigen::Vector2d> points_m;
  for (int i = 0; i < 12; ++i) points_m.emplace_back(3.0 + 2.0 * i, i % 2 == 0 ? 6.0 : -5.0);
  for (const Eigen::Vector2d& p : points_m) old.push_back(filter.augment(core::make_cartesian(p, R), {}));
  core::Odometry odometry;
  odometry.covariance.diagonal() << 4.0, 4.0, 0.01;
  filter.predict(odometry);
  Branch branch;
  std::vector<pf_relocalize::ConstellationPair> pairs;
  for (int i = 0; i < 12; ++i) {
    const double side_rad = 1.3 * i;
    const Eigen::Vector2d beside_m = 0.8 * Eigen::Vector2d(std::cos(side_rad), std::sin(side_rad));
    const Eigen::Vector2d seen_m = points_m[static_cast<std::size_t>(i)] + Eigen::Vector2d(1.0, -0.5);
    const core::LandmarkId id = filter.augment(core::make_cartesian(i < wrong ? seen_m + beside_m : seen_m, R), {});
    branch.confirmed.push_back(id);
    pairs.push_back({id, old[static_cast<std::size_t>(i)], 0.0});
  }
  return close_by_merge(filter, pairs, branch, old, {});
}

/// As clutter that gathers in the same bush on both passes leaves them; beyond a quarter, a rival may explain as much.
TEST(CloseByMerge, DropsUpToAQuarterOfThePairsIfTheRestContradictsThem) {
  for (int wrong = 0; wrong <= 3; ++wrong) {
    const Closing closing = close_with_wrong_pairs(wrong);
    EXPECT_TRUE(closing.accepted) << wrong;
    EXPECT_EQ(closing.dropped, wrong);
    EXPECT_EQ(closing.merged.size(), static_cast<std::size_t>(12 - wrong));
  }
  EXPECT_FALSE(close_with_wrong_pairs(4).accepted);
}

TEST(CloseByMerge, RefusesWhatTheMapCannotBelieveAndLeavesItAsItWas) {
  Return back(30.0);  // fifteen σ of the odometry
  const core::PoseGaussian before = back.filter.pose();
  const Closing closing = close_by_merge(back.filter, back.pairs, back.branch, back.old, {});
  EXPECT_FALSE(closing.accepted);
  EXPECT_GT(closing.cost, closing.limit);
  EXPECT_TRUE(closing.merged.empty());
  EXPECT_EQ(back.filter.pose().mean.vector(), before.mean.vector());
  EXPECT_EQ(back.filter.pose().covariance, before.covariance);
  EXPECT_EQ(back.filter.mapped_count(), 12);
}

TEST(CloseByMerge, RefusesFewerThanThreePairs) {
  Return back(1.0);
  back.pairs.resize(2);
  EXPECT_FALSE(close_by_merge(back.filter, back.pairs, back.branch, back.old, {}).accepted);
}

TEST(CloseByMerge, ForgetsUnconfirmedCopies) {
  Return back(1.0);
  back.branch.unconfirmed = {back.branch.confirmed.back()};
  back.branch.confirmed.pop_back();
  const Closing closing = close_by_merge(back.filter, back.pairs, back.branch, back.old, {});
  ASSERT_TRUE(closing.accepted);
  EXPECT_EQ(closing.forgotten, back.branch.unconfirmed);
  EXPECT_FALSE(back.filter.contains(back.branch.unconfirmed.front()));
}

}  // namespace
}  // namespace helixnav::supervisor
