// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/named_navigator.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "circuits.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/odometry.hpp"
#include "wrong_names.hpp"

namespace helixnav::supervisor {
namespace {

using core::Outcome;

/// The compressed EKF driven with all names known: nothing from the supervisor.
cekf::CompressedEkf driven_by_hand(const core::Recording& run) {
  cekf::CompressedEkf filter(run.start);
  std::map<core::Label, core::LandmarkId> landmarks;
  std::optional<core::Odometry> motion;
  std::size_t scans = 0;
  for (const core::Event& event : run.events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
      motion = motion ? core::chain(*motion, *odometry) : *odometry;
      continue;
    }
    const auto& scan = std::get<core::Scan>(event);
    if (motion) filter.predict(*motion);
    motion.reset();
    const std::vector<core::Label>& labels = run.labels[scans++];
    std::vector<cekf::Match> matches;
    std::vector<std::size_t> fresh;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (landmarks.count(labels[i]) > 0) {
        matches.push_back({landmarks[labels[i]], scan.observations[i], scan.T_robot_sensor});
      } else if (labels[i] != core::no_label) {
        fresh.push_back(i);
      }
    }
    if (!matches.empty()) filter.update(matches);
    for (const std::size_t i : fresh) landmarks[labels[i]] = filter.augment(scan.observations[i], scan.T_robot_sensor);
    filter.switch_region_if_due();
  }
  return filter;
}

TEST(NamedNavigator, IsTheCompressedEkfBitForBit) {
  sim::Scenario scenario = wide_circuit();
  scenario.scanner.clutter_per_scan = 0.5;  // without a name, so without effect
  const core::Recording run = sim::simulate(scenario, 1);
  NamedNavigator navigator(run.start);
  int switches = 0;
  drive(run, navigator, [&](const core::Scan& scan, std::size_t i) {
    switches += navigator.observe(scan, run.labels[i]).switched_region ? 1 : 0;
  });
  const cekf::CompressedEkf by_hand = driven_by_hand(run);
  EXPECT_GE(switches, 5);
  EXPECT_EQ(navigator.pose().mean.vector(), by_hand.pose().mean.vector());
  EXPECT_EQ(navigator.pose().covariance, by_hand.pose().covariance);
  ASSERT_EQ(navigator.filter().landmarks(), by_hand.landmarks());
  for (const core::MapLandmark& landmark : navigator.map()) {
    EXPECT_EQ(landmark.point.mean_m, by_hand.landmark(landmark.id).mean_m);
    EXPECT_EQ(landmark.point.covariance_m2, by_hand.landmark(landmark.id).covariance_m2);
    EXPECT_EQ(landmark.state, core::LandmarkState::mature);
  }
}

struct DrivenByName {
  double largest_error_m = 0.0;
  int left_out = 0;
  std::vector<core::MapLandmark> map;
};

DrivenByName drive_by(const core::Recording& run, const NavigatorOptions& options = {}) {
  NamedNavigator navigator(run.start, options);
  DrivenByName driven;
  drive(run, navigator, [&](const core::Scan& scan, std::size_t i) {
    const core::StepReport report = navigator.observe(scan, run.labels[i]);
    const auto truth = std::find_if(run.true_poses.begin(), run.true_poses.end(),
                                    [&](const core::TruePose& pose) { return pose.t_ns == scan.t_ns; });
    if (truth != run.true_poses.end()) {
      const double error_m = (report.pose.mean.position_m() - truth->T_world_robot.position_m()).norm();
      driven.largest_error_m = std::max(driven.largest_error_m, error_m);
    }
    for (const core::AssociationReport& one : report.associations) {
      driven.left_out += one.outcome == Outcome::rejected && one.landmark != core::no_landmark ? 1 : 0;
    }
  });
  driven.map = navigator.map();
  return driven;
}

/// One name in fifty is wrong. A drive may be a metre further off than with right names; one in ten may be worse.
TEST(NamedNavigator, LeavesWrongNamesOut) {
  int right = 0;
  constexpr int drives = 10;
  for (int seed = 101; seed < 101 + drives; ++seed) {
    const core::Recording run = sim::simulate(wide_circuit(), static_cast<std::uint64_t>(seed));
    const DrivenByName by_right_names = drive_by(run);
    EXPECT_EQ(by_right_names.left_out, 0) << seed;
    const core::Recording wrong = with_wrong_names(run, 0.02, static_cast<std::uint64_t>(seed));
    const DrivenByName weighed = drive_by(wrong);
    EXPECT_GT(weighed.left_out, 3) << seed;
    right += weighed.largest_error_m < by_right_names.largest_error_m + 1.0 ? 1 : 0;
    NavigatorOptions believing;
    believing.names.wrong = 0.0;
    EXPECT_GT(drive_by(wrong, believing).largest_error_m, by_right_names.largest_error_m + 3.0) << seed;
  }
  EXPECT_GE(right, drives - 1);
}

/// The landmark is where it was seen under its own name, and is there once.
TEST(NamedNavigator, BeginsALandmarkAnewThatWasFirstSeenByAnothersName) {
  const core::Recording run = sim::simulate(wide_circuit(), 3);
  const DrivenByName right = drive_by(run);
  const DrivenByName wrong = drive_by(with_a_wrong_first_name(run));
  EXPECT_GE(wrong.left_out, 4);
  EXPECT_EQ(wrong.map.size(), right.map.size());
  EXPECT_LT(wrong.largest_error_m, right.largest_error_m + 1.0);
}

/// One scan of one landmark ahead.
core::Scan one_look(core::Nanoseconds t_ns) {
  core::Scan scan;
  scan.t_ns = t_ns;
  scan.field_of_view.max_range_m = 30.0;
  scan.observations = {core::make_range_bearing(10.0, 0.1, 0.1, 0.02)};
  return scan;
}

core::Odometry one_metre(core::Nanoseconds t_ns) {
  core::Odometry odometry;
  odometry.t_ns = t_ns;
  odometry.T_before_after = core::Pose2(1.0, 0.0, 0.02);
  odometry.covariance = Eigen::Vector3d(1e-2, 1e-3, 1e-4).asDiagonal();
  return odometry;
}

TEST(NamedNavigator, RefusesAWrongNumberOfIdentitiesAndStaysAsItWas) {
  NamedNavigator navigator(core::PoseGaussian{});
  navigator.move(one_metre(1));
  navigator.observe(one_look(1), {4});
  const core::PoseGaussian before = navigator.pose();
  navigator.move(one_metre(2));  // pending motion waits for the next scan that is taken
  const std::vector<std::int64_t> none;
  const std::vector<std::int64_t> two{4, 5};
  EXPECT_THROW(navigator.observe(one_look(2), none), core::PreconditionError);
  EXPECT_THROW(navigator.observe(one_look(2), two), core::PreconditionError);
  EXPECT_EQ(navigator.pose().mean.vector(), before.mean.vector());
  EXPECT_EQ(navigator.pose().covariance, before.covariance);
  EXPECT_EQ(navigator.filter().mapped_count(), 1);
  EXPECT_EQ(navigator.map().front().observations, 1);
}

TEST(NamedNavigator, LosesNoMotionToACallThatItRefused) {
  NamedNavigator refused(core::PoseGaussian{});
  NamedNavigator plain(core::PoseGaussian{});
  for (NamedNavigator* navigator : {&refused, &plain}) {
    navigator->observe(one_look(0), {4});
    navigator->move(one_metre(1));
  }
  EXPECT_THROW(refused.observe(one_look(1), std::vector<std::int64_t>{}), core::PreconditionError);
  const core::StepReport a = refused.observe(one_look(1), {4});
  const core::StepReport b = plain.observe(one_look(1), {4});
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.pose.mean.vector(), b.pose.mean.vector());
  EXPECT_EQ(a.pose.covariance, b.pose.covariance);
}

TEST(NamedNavigator, TakesANewIdentityOnceAScan) {
  NamedNavigator navigator(core::PoseGaussian{});
  core::Scan scan = one_look(0);
  scan.observations.push_back(scan.observations.front());
  const core::StepReport report = navigator.observe(scan, {4, 4});
  EXPECT_EQ(report.associations[0].outcome, Outcome::augmented);
  EXPECT_EQ(report.associations[1].outcome, Outcome::rejected);
  EXPECT_EQ(navigator.filter().mapped_count(), 1);
}

}  // namespace
}  // namespace helixnav::supervisor
