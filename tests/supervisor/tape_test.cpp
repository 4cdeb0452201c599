// SPDX-License-Identifier: BSD-3-Clause
#include "loop/tape.hpp"

#include <algorithm>
#include <map>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "circuits.hpp"
#include "helixnav/core/odometry.hpp"
#include "loop/belief.hpp"

namespace helixnav::supervisor {
namespace {

core::Odometry one_metre() {
  core::Odometry odometry;
  odometry.T_before_after = core::Pose2(1.0, 0.0, 0.02);
  odometry.covariance = Eigen::Vector3d(1e-2, 1e-3, 1e-4).asDiagonal();
  return odometry;
}

Tape::Scan scan_that_cost(double nis) {
  Tape::Scan scan;
  scan.nis = nis;
  scan.dof = 2;
  return scan;
}

Tape::Fix fix_that_cost(double nis, bool accepted = true) { return {WidenedFix{}, nis, accepted}; }

/// A belief on the wide circuit with known association, and its tape.
struct Driver {
  Belief belief{cekf::CompressedEkf{core::PoseGaussian{}}, association::LandmarkLife{}, CoverageTrace(4.0), {}, 0};
  Tape tape{0};
  std::map<core::Label, core::LandmarkId> known;

  void move(const Tape::Motion& motion) {
    belief.filter.predict(motion.odometry);
    belief.existence.drive(motion.driven_m);
    tape.append(motion);
  }

  void observe(const core::Scan& scan, const std::vector<core::Label>& labels) {
    std::vector<cekf::Match> matches;
    std::vector<core::LandmarkId> seen, born;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (labels[i] == core::no_label || known.count(labels[i]) == 0) continue;
      matches.push_back({known[labels[i]], scan.observations[i], scan.T_robot_sensor});
      seen.push_back(known[labels[i]]);
    }
    if (!matches.empty()) belief.filter.update(matches);
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (labels[i] == core::no_label || known.count(labels[i]) > 0) continue;
      born.push_back(known[labels[i]] = belief.filter.augment(scan.observations[i], scan.T_robot_sensor));
    }
    const core::Pose2 pose = belief.filter.pose().mean;
    for (const core::LandmarkId id : belief.existence.observe(pose.position_m(), seen, born, {}).died) {
      belief.filter.remove(id);
      known.erase(std::find_if(known.begin(), known.end(), [&](const auto& one) { return one.second == id; }));
    }
    belief.coverage.pass(belief.existence.path_m(), pose);
    belief.filter.switch_region_if_due();
    ++belief.step;
    tape.append(Tape::Scan{scan, {}, 0.0, 0, {}});
  }
};

TEST(Tape, LeavesOutMatchesByTheNamesThatLandmarksHaveNow) {
  const auto matched = [](core::LandmarkId id) {
    core::AssociationReport association;
    association.outcome = core::Outcome::matched;
    association.landmark = id;
    return association;
  };
  Tape tape(100);
  tape.append(Tape::Scan{{}, {matched(1), matched(2)}, 0.0, 0, {}});
  tape.append(Tape::Scan{{}, {matched(1), matched(2), matched(4)}, 0.0, 0, {}});
  tape.append(Tape::Merge{{{3, 4}}, 0.0});
  std::vector<std::vector<core::LandmarkId>> left;
  tape.without_matches_since(1, {2, 3}).read_from(0, [&](const Tape::Entry& entry) {
    const auto* scan = std::get_if<Tape::Scan>(&entry);
    if (scan == nullptr) return;
    left.emplace_back();
    for (const core::AssociationReport& one : scan->fate) {
      if (one.outcome == core::Outcome::matched) left.back().push_back(one.landmark);
    }
  });
  EXPECT_EQ(left, (std::vector<std::vector<core::LandmarkId>>{{1, 2}, {2, 4}}));
}

TEST(Checkpoint, GoingThroughTheTapeAgainEndsWhereItEnded) {
  const core::Recording run = sim::simulate(wide_circuit(), 3);
  constexpr std::int64_t moment = 150;
  Driver driver;
  std::optional<Checkpoint> checkpoint;
  std::map<core::Label, core::LandmarkId> known_then;
  std::size_t scans = 0;
  for (const core::Event& event : run.events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
      driver.move({*odometry, odometry->T_before_after.position_m().norm()});
    }
    if (const auto* scan = std::get_if<core::Scan>(&event)) driver.observe(*scan, run.labels[scans++]);
    if (!checkpoint && driver.belief.step == moment) {
      checkpoint.emplace(take_checkpoint(driver.belief, driver.tape));
      known_then = driver.known;
    }
  }
  EXPECT_GT(driver.belief.filter.phases_kept(), 1) << "the drive after the checkpoint should have switched regions";
  const core::PoseGaussian end = driver.belief.filter.pose();
  const double path_m = driver.belief.existence.path_m();
  const std::size_t coverage = driver.belief.coverage.between(0.0, 1e9).size();
  const std::map<core::Label, core::LandmarkId> named = std::exchange(driver.known, known_then);

  const std::vector<Tape::Entry> since = driver.tape.cut(checkpoint->position);
  EXPECT_EQ(driver.tape.end(), checkpoint->position);
  roll_back(*checkpoint, driver.belief);
  EXPECT_EQ(driver.belief.step, moment);
  EXPECT_LT(driver.belief.existence.path_m(), path_m);
  EXPECT_LT(driver.belief.coverage.between(0.0, 1e9).size(), coverage);
  for (const Tape::Entry& entry : since) {
    if (const auto* motion = std::get_if<Tape::Motion>(&entry)) driver.move(*motion);
    if (const auto* scan = std::get_if<Tape::Scan>(&entry)) {
      driver.observe(scan->scan, run.labels[static_cast<std::size_t>(driver.belief.step)]);
    }
  }
  EXPECT_EQ(driver.belief.step, static_cast<std::int64_t>(scans));
  EXPECT_EQ(driver.known, named);
  EXPECT_DOUBLE_EQ(driver.belief.existence.path_m(), path_m);
  EXPECT_EQ(driver.belief.coverage.between(0.0, 1e9).size(), coverage);
  EXPECT_EQ(driver.belief.filter.pose().mean.vector(), end.mean.vector());
  EXPECT_EQ(driver.belief.filter.pose().covariance, end.covariance);
}

TEST(Checkpoint, RestoresTheLandmarkThatWaitsForItsConfirmation) {
  Driver driver;
  constexpr double reach_m = 5.0;
  const auto hit = [](core::LandmarkId id, double path_m) {
    return IsolatedHit{id, path_m, Eigen::Vector2d::Zero(), Eigen::Matrix2d::Identity(), Eigen::Matrix2d::Zero()};
  };
  EXPECT_FALSE(driver.belief.confirmation.confirms(hit(7, 1.0), reach_m));
  const Checkpoint checkpoint = take_checkpoint(driver.belief, driver.tape);
  EXPECT_FALSE(driver.belief.confirmation.confirms(hit(8, 2.0), reach_m));
  roll_back(checkpoint, driver.belief);
  EXPECT_TRUE(driver.belief.confirmation.confirms(hit(7, 3.0), reach_m));
}

TEST(Tape, CutTakesOffWhatCameAfterThePosition) {
  Tape tape(1000);
  Tape::Position after_third_scan = 0;
  for (int k = 0; k < 4; ++k) {
    tape.append(Tape::Motion{one_metre(), 1.0});
    tape.append(scan_that_cost(2.0));
    if (k == 2) after_third_scan = tape.end();
    tape.append(Tape::Motion{one_metre(), 1.0});
    tape.append(fix_that_cost(1.0));
  }
  tape.append(Tape::Motion{one_metre(), 1.0});
  ASSERT_EQ(stops_of(tape).size(), 8u);
  EXPECT_EQ(tape.cut(after_third_scan).size(), 7u);
  EXPECT_EQ(stops_of(tape).size(), 5u);
  EXPECT_FALSE(stops_of(tape).back().fix);
  EXPECT_FALSE(motion_after_stops(tape));
  EXPECT_DOUBLE_EQ(drive_cost(tape), 3 * 2.0 + 2 * 1.0);
}

TEST(Tape, WithoutTheMergesAtItsEndIsTheTapeBeforeTheClosing) {
  Tape tape(100);
  tape.append(scan_that_cost(3.0));
  tape.append(Tape::Merge{{}, 5.0});
  tape.append(scan_that_cost(4.0));
  EXPECT_EQ(tape.cost_of_last_merges(), 0.0);
  EXPECT_EQ(tape.without_last_merges().end(), tape.end());
  const Tape::Position before = tape.end();
  tape.append(Tape::Merge{{}, 6.0});
  tape.append(Tape::Merge{{}, 7.0});
  EXPECT_EQ(tape.cost_of_last_merges(), 13.0);
  EXPECT_EQ(tape.without_last_merges().end(), before);
  EXPECT_EQ(drive_cost(tape.without_last_merges()), 12.0);
  EXPECT_EQ(drive_cost(tape), 25.0);
}

double variance_of(const Tape& tape, Tape::Position position) {
  double variance = 0.0;
  tape.read_between(position, position + 1, [&](const Tape::Entry& entry) {
    if (const auto* motion = std::get_if<Tape::Motion>(&entry)) variance = motion->odometry.covariance(0, 0);
  });
  return variance;
}

TEST(Tape, LargerNoiseOfALoopDrivenSomeTimeAgoIsTakenBackWhereItWas) {
  Tape tape(100);
  for (int k = 0; k < 6; ++k) {
    core::Odometry metre = core::no_motion(k);
    metre.covariance = Eigen::Matrix3d::Identity();
    tape.append(Tape::Motion{metre, 1.0});
  }
  const Tape larger = tape.with_larger_noise(4.0, 2.0, 3.0);  // two metres, three metres ago
  for (Tape::Position k = 0; k < 6; ++k) EXPECT_EQ(variance_of(larger, k), k == 1 || k == 2 ? 4.0 : 1.0) << k;
  const Tape back = larger.with_larger_noise(0.25, 2.0, 3.0);
  for (Tape::Position k = 0; k < 6; ++k) EXPECT_EQ(variance_of(back, k), 1.0) << k;
}

TEST(Tape, WithoutItsLastSolutionCostsWhatWasPaidSinceTheOneBefore) {
  Tape tape(100);
  tape.append(Tape::Solved{50.0});
  tape.append(Tape::Merge{{{0, 1}}, 7.0});
  tape.append(Tape::Solved{53.0});
  tape.append(Tape::Merge{{}, 2.0});
  EXPECT_EQ(drive_cost(tape), 55.0);
  const Tape unsolved = tape.without_last_solution();
  EXPECT_EQ(drive_cost(unsolved), 59.0);
  EXPECT_EQ(unsolved.end(), tape.end()) << "positions stay";
  EXPECT_EQ(unsolved.cost_of_last_merges(), 9.0);
}

TEST(Tape, ChainsMotionThatLeadsToNoStop) {
  Tape tape(1000);
  tape.append(Tape::Motion{one_metre(), 1.0});
  tape.append(fix_that_cost(100.0, false));
  tape.append(Tape::Motion{one_metre(), 1.0});
  tape.append(scan_that_cost(2.0));
  const core::Pose2 step = one_metre().T_before_after;
  ASSERT_EQ(stops_of(tape).size(), 1u);
  EXPECT_EQ(stops_of(tape).front().motion->T_before_after.vector(), core::compose(step, step).vector());
  EXPECT_DOUBLE_EQ(drive_cost(tape), 2.0) << "a fix that was refused costs nothing";
}

TEST(Tape, LetsGoOfTheDriveBeyondItsLimitForGood) {
  Tape tape(2);
  for (int k = 0; k < 2; ++k) tape.append(scan_that_cost(1.0));
  tape.settle(tape.end());
  EXPECT_TRUE(tape.holds_drive());
  tape.append(scan_that_cost(1.0));
  const Tape::Position before_last = tape.end();
  tape.append(scan_that_cost(1.0));
  tape.settle(before_last);
  EXPECT_FALSE(tape.holds_drive());
  int kept = 0;
  tape.read_from(0, [&](const Tape::Entry&) { ++kept; });
  EXPECT_EQ(kept, 1) << "what came since the checkpoint stays";
  EXPECT_EQ(tape.end(), 4u);
  EXPECT_EQ(tape.cut(before_last).size(), 1u);
  EXPECT_FALSE(tape.holds_drive());
}

TEST(Tape, KeepsUnusedObservationsOnlySinceTheCheckpoint) {
  Tape::Scan scan;
  const core::Observation seen = core::make_range_bearing(10.0, 0.1, 0.1, 0.02);
  scan.scan.observations = {seen, seen, core::make_range_bearing(12.0, 0.2, 0.1, 0.02)};
  scan.fate = {{0, core::Outcome::ambiguous, 3}, {1, core::Outcome::augmented, 7}, {2, core::Outcome::matched, 5}};
  Tape tape(1000);
  tape.append(scan);
  tape.append(scan);
  const std::vector<Stop> before = stops_of(tape);
  tape.settle(1);
  std::vector<std::size_t> observations;
  tape.read_from(0, [&](const Tape::Entry& entry) {
    observations.push_back(std::get<Tape::Scan>(entry).scan.observations.size());
  });
  EXPECT_EQ(observations, (std::vector<std::size_t>{2, 3}));
  const std::vector<Stop> after = stops_of(tape);
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_EQ(after[i].seen.size(), 2u);
    EXPECT_EQ(after[i].seen[0].landmark, 5) << "matched ones first";
    EXPECT_EQ(after[i].seen[1].landmark, 7);
    EXPECT_EQ(after[i].seen[0].observation.z, before[i].seen[0].observation.z);
  }
}

TEST(Tape, KnowsWhatALandmarkIsNow) {
  Tape tape(10);
  tape.append(Tape::Merge{{{3, 7}}, 0.5});
  tape.append(Tape::Merge{{{1, 3}}, 0.5});
  const core::MergedIds ids = merged_ids(tape);
  EXPECT_EQ(ids.now(7), 1);
  EXPECT_EQ(ids.now(3), 1);
  EXPECT_EQ(ids.now(5), 5);
  EXPECT_DOUBLE_EQ(drive_cost(tape), 1.0);
  tape.append(Tape::Solved{0.25});
  EXPECT_DOUBLE_EQ(drive_cost(tape), 0.25);
}

TEST(CoverageTrace, ForgetsWhatWasPassedLater) {
  CoverageTrace trace(4.0);
  for (int i = 0; i < 10; ++i) trace.pass(5.0 * i, core::Pose2(5.0 * i, 0.0, 0.0));
  trace.back_to(20.0);
  EXPECT_EQ(trace.between(0.0, 1e9).size(), 5u);
}

}  // namespace
}  // namespace helixnav::supervisor
