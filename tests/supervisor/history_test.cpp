// SPDX-License-Identifier: BSD-3-Clause
#include "history.hpp"

#include <algorithm>
#include <map>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "circuits.hpp"
#include "track.hpp"

namespace helixnav::supervisor {
namespace {

/// A filter on the wide circuit with known association: only what History needs of a drive.
struct Driver {
  cekf::CompressedEkf filter{core::PoseGaussian{}};
  association::LandmarkLife life;
  std::map<core::Label, core::LandmarkId> known;

  void move(const History::Motion& motion) {
    filter.predict(motion.odometry);
    life.drive(motion.driven_m);
  }

  void observe(const core::Scan& scan, const std::vector<core::Label>& labels) {
    std::vector<cekf::Match> matches;
    std::vector<core::LandmarkId> seen, born;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (labels[i] == core::no_label || known.count(labels[i]) == 0) continue;
      matches.push_back({known[labels[i]], scan.observations[i], scan.T_robot_sensor});
      seen.push_back(known[labels[i]]);
    }
    if (!matches.empty()) filter.update(matches);
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (labels[i] == core::no_label || known.count(labels[i]) > 0) continue;
      born.push_back(known[labels[i]] = filter.augment(scan.observations[i], scan.T_robot_sensor));
    }
    for (const core::LandmarkId id : life.observe(filter.pose().mean.position_m(), seen, born, {}).died) {
      filter.remove(id);
      known.erase(std::find_if(known.begin(), known.end(), [&](const auto& one) { return one.second == id; }));
    }
    filter.switch_region_if_due();
  }
};

TEST(History, GoingThroughItAgainEndsWhereItEnded) {
  const core::Recording run = sim::simulate(wide_circuit(), 3);
  Driver driver;
  History history;
  std::size_t scans = 0;
  constexpr std::int64_t moment = 150;
  std::map<core::Label, core::LandmarkId> known_then;
  for (const core::Event& event : run.events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
      const History::Motion motion{*odometry, odometry->T_before_after.position_m().norm()};
      history.note(motion);
      driver.move(motion);
    }
    if (const auto* scan = std::get_if<core::Scan>(&event)) {
      history.note(*scan);
      driver.observe(*scan, run.labels[scans]);
      if (static_cast<std::int64_t>(scans) <= moment) {
        history.settle(static_cast<std::int64_t>(scans), driver.filter, driver.life);
        if (history.step() == static_cast<std::int64_t>(scans)) known_then = driver.known;
      }
      ++scans;
    }
  }
  ASSERT_EQ(scans, run.labels.size());
  EXPECT_GT(driver.filter.phases_kept(), 1) << "the drive after the moment should have switched regions";
  const core::PoseGaussian end = driver.filter.pose();
  const double path_m = driver.life.path_m();
  const std::int64_t step = history.step();
  EXPECT_LE(step, moment);
  EXPECT_GT(step, moment - 10);

  const std::map<core::Label, core::LandmarkId> named = driver.known;
  const std::vector<History::Event> since = history.rewind(driver.filter, driver.life);
  EXPECT_TRUE(history.empty());
  EXPECT_EQ(driver.filter.phases_kept(), 1);
  EXPECT_LT(driver.life.path_m(), path_m);
  driver.known = known_then;
  std::size_t again = static_cast<std::size_t>(step) + 1;
  for (const History::Event& event : since) {
    if (const auto* motion = std::get_if<History::Motion>(&event)) driver.move(*motion);
    if (const auto* scan = std::get_if<core::Scan>(&event)) driver.observe(*scan, run.labels[again++]);
  }
  EXPECT_EQ(again, scans);
  EXPECT_EQ(driver.known, named);
  EXPECT_DOUBLE_EQ(driver.life.path_m(), path_m);
  EXPECT_LT((driver.filter.pose().mean.vector() - end.mean.vector()).norm(), 1e-9);
  EXPECT_LT((driver.filter.pose().covariance - end.covariance).norm(), 1e-9 * end.covariance.norm());
}

TEST(History, LetsTheFilterAbsorbWhatLiesBeforeTheMoment) {
  const core::Recording run = sim::simulate(wide_circuit(), 4);
  Driver driver;
  History history;
  std::size_t scans = 0;
  int switches = 0;
  for (const core::Event& event : run.events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) driver.move({*odometry, 0.0});
    if (const auto* scan = std::get_if<core::Scan>(&event)) {
      const long phase = driver.filter.phase();
      driver.observe(*scan, run.labels[scans]);
      switches += driver.filter.phase() != phase;
      history.settle(static_cast<std::int64_t>(scans++), driver.filter, driver.life);
      ASSERT_EQ(driver.filter.phases_kept(), 1);
    }
  }
  EXPECT_GT(switches, 3);
}

TEST(History, NotesNothingBeforeThereIsAMoment) {
  cekf::CompressedEkf filter{core::PoseGaussian{}};
  association::LandmarkLife life;
  History history;
  history.note(History::Motion{});
  EXPECT_TRUE(history.empty());
  history.settle(0, filter, life);
  history.note(core::AbsoluteFix{});
  const std::vector<History::Event> since = history.rewind(filter, life);
  ASSERT_EQ(since.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<core::AbsoluteFix>(since.front()));
}

TEST(Track, ForgetsWhatWasPassedLater) {
  Track track(4.0);
  for (int i = 0; i < 10; ++i) track.pass(5.0 * i, core::Pose2(5.0 * i, 0.0, 0.0));
  track.back_to(20.0);
  EXPECT_EQ(track.between(0.0, 1e9).size(), 5u);
}

}  // namespace
}  // namespace helixnav::supervisor
