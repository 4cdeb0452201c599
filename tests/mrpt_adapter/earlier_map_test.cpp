// SPDX-License-Identifier: BSD-3-Clause
//
// Continuing in the map of an earlier run does what the navigator does, bit for bit.
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <functional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <mrpt/maps/CSimpleMap.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/runs/joint_map_file.hpp"
#include "helixnav/runs/map_folder.hpp"
#include "helixnav/sim/simulate.hpp"
#include "helixnav/supervisor/joint_map.hpp"
#include "helixnav/supervisor/navigator.hpp"
#include "input_error.hpp"
#include "quiet_builder.hpp"
#include "temporary_folder.hpp"
#include "wide_circuit.hpp"

namespace helixnav::mrpt_adapter {
namespace {

using testing::as_mrpt_keeps;
using testing::QuietBuilder;

core::Recording drive_of_day(std::uint64_t seed) {
  const sim::Scenario scenario = sim::wide_circuit();
  return sim::simulate_in(sim::build_world(scenario.world, 1), scenario, seed);
}

using Poses = std::vector<core::PoseGaussian>;
using Scans = std::size_t;
constexpr Scans skipped = 60;  ///< of the second day: it begins in the middle

/// The second day from scan `skipped` on; `before(k)` is called before scan k.
Poses built_from(MapBuilder& builder, const core::Recording& run, Scans from,
                 const std::function<void(Scans)>& before = {}) {
  core::Recording rest = run;
  Scans scans = 0;
  const auto begin = std::find_if(run.events.begin(), run.events.end(), [&](const core::Event& event) {
    return std::holds_alternative<core::Scan>(event) && scans++ == from;
  });
  rest.events.assign(begin, run.events.end());
  Poses poses;
  if (before) before(0);
  testing::drive(builder, rest, false, [&](const core::Scan&, Scans k) {
    poses.push_back(RunAccess::last_steps(builder).back().report.pose);
    if (before) before(k + 1);
    return true;
  });
  return poses;
}

enum class FirstMotion { left_out, used };

/// The navigator, fed what MRPT's types keep.
Poses navigated_from(supervisor::Navigator& navigator, const core::Recording& run, Scans from,
                     const std::function<void(Scans)>& before = {}, FirstMotion first = FirstMotion::left_out) {
  Poses poses;
  std::optional<core::Odometry> motion;
  Scans scans = 0;
  for (const core::Event& event : run.events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
      motion = motion ? core::chain(*motion, *odometry) : *odometry;
    } else if (const auto* scan = std::get_if<core::Scan>(&event)) {
      const std::optional<core::Odometry> moved = std::exchange(motion, std::nullopt);
      if (scans++ < from) continue;
      if (before) before(poses.size());
      const bool left_out = poses.empty() && from > 0 && first == FirstMotion::left_out;
      if (moved && !left_out) navigator.move(as_mrpt_keeps(*moved));
      poses.push_back(navigator.observe(as_mrpt_keeps(*scan)).pose);
    }
  }
  return poses;
}

void expect_same_poses(const Poses& a, const Poses& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Eigen::Vector3d mean_a = a[i].mean.vector(), mean_b = b[i].mean.vector();
    ASSERT_EQ(std::memcmp(mean_a.data(), mean_b.data(), sizeof(double) * 3), 0) << "scan " << i;
    ASSERT_EQ(a[i].covariance, b[i].covariance) << "scan " << i;
  }
}

mrpt::poses::CPosePDFGaussian pdf_of(const core::PoseGaussian& pose) {
  return {mrpt::poses::CPose2D(pose.mean.x_m, pose.mean.y_m, pose.mean.heading_rad), testing::matrix(pose.covariance)};
}

/// MRPT wraps headings and thereby rounds them.
core::Pose2 as_mrpt_keeps_pose(const core::Pose2& T) {
  return {T.x_m, T.y_m, mrpt::poses::CPose2D(T.x_m, T.y_m, T.heading_rad).phi()};
}

std::vector<core::MapLandmark> mature_of(std::vector<core::MapLandmark> map) {
  const auto is_tentative = [](const auto& landmark) { return landmark.state != core::LandmarkState::mature; };
  map.erase(std::remove_if(map.begin(), map.end(), is_tentative), map.end());
  return map;
}

class EarlierMap : public ::testing::Test {
 protected:
  void SetUp() override {
    QuietBuilder yesterday;
    built_from(yesterday, drive_of_day(1), 0);
    yesterday.saveMapToFolder(folder());
    earlier_ = runs::read_joint_map(folder() + "/map.bin");
    pose_.mean = as_mrpt_keeps_pose(today_.true_poses[skipped].T_world_robot);
    pose_.covariance = Eigen::Vector3d(0.04, 0.04, 0.001).asDiagonal();
  }

  std::string path(const char* name) const { return (temporary_.path() / name).string(); }
  std::string folder() const { return path("monday"); }

  helixnav::testing::TemporaryFolder temporary_;
  core::JointMap earlier_;
  const core::Recording today_ = drive_of_day(71);
  core::PoseGaussian pose_;  ///< true, where the second day begins
};

TEST_F(EarlierMap, IsSavedWithTheReachOfTheSensorAndAllLandmarks) {
  EXPECT_FLOAT_EQ(static_cast<float>(earlier_.reach_m), 30.0F);
  EXPECT_GE(earlier_.joint.ids.size(), 22u);
}

TEST_F(EarlierMap, TheVehicleBegunAnywhereIsFoundAsTheNavigatorFindsIt) {
  QuietBuilder builder;
  builder.loadCurrentMapFromFile(folder());
  EXPECT_FALSE(builder.isPlaceKnown());
  const Poses poses = built_from(builder, today_, skipped);
  EXPECT_TRUE(builder.isPlaceKnown());
  supervisor::Navigator navigator(core::PoseGaussian{});
  navigator.look_for_place_in(earlier_);
  expect_same_poses(poses, navigated_from(navigator, today_, skipped));
  const core::Pose2& truth = today_.true_poses.back().T_world_robot;
  EXPECT_LT((poses.back().mean.position_m() - truth.position_m()).norm(), 0.8);
}

TEST_F(EarlierMap, FromAPoseItGoesOnAsTheNavigatorDoes) {
  QuietBuilder builder;
  const mrpt::poses::CPosePDFGaussian x0 = pdf_of(pose_);
  builder.initializeFromRun(folder(), &x0);
  EXPECT_TRUE(builder.isPlaceKnown());
  supervisor::Navigator navigator = supervisor::Navigator::go_on_in(supervisor::begun_at(earlier_, pose_));
  expect_same_poses(built_from(builder, today_, skipped), navigated_from(navigator, today_, skipped));
}

TEST_F(EarlierMap, APoseGivenWhileThePlaceIsSoughtBeginsThereOnTheEarlierMap) {
  constexpr Scans later = 2;  // before any landmark is mature
  const core::Pose2 truth = today_.true_poses[skipped + later - 1].T_world_robot;
  const core::PoseGaussian pose{as_mrpt_keeps_pose(truth), pose_.covariance};
  QuietBuilder builder;
  builder.loadCurrentMapFromFile(folder() + "/map.bin");
  const Poses poses = built_from(builder, today_, skipped, [&](Scans k) {
    if (k != later) return;
    EXPECT_FALSE(builder.isPlaceKnown());
    builder.setInitialPose(pdf_of(pose));
  });
  EXPECT_TRUE(builder.isPlaceKnown());
  supervisor::Navigator navigator = supervisor::Navigator::go_on_in(supervisor::begun_at(earlier_, pose));
  expect_same_poses({poses.begin() + later, poses.end()},
                    navigated_from(navigator, today_, skipped + later, {}, FirstMotion::used));
}

TEST_F(EarlierMap, APoseGivenOnThePresentMapKeepsItsLandmarks) {
  QuietBuilder builder;
  built_from(builder, drive_of_day(1), 0);
  const std::vector<core::MapLandmark> before = mature_of(RunAccess::map(builder));
  builder.setInitialPose(pdf_of(pose_));
  const std::vector<core::MapLandmark> after = RunAccess::map(builder);
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_EQ(after[i].id, before[i].id);
    EXPECT_LT((after[i].point.mean_m - before[i].point.mean_m).norm(), 0.02) << "the drive until then is solved";
    EXPECT_EQ(after[i].state, before[i].state);
  }
  EXPECT_LT((RunAccess::pose(builder).mean.vector() - pose_.mean.vector()).norm(), 1e-3);
  const Poses poses = built_from(builder, today_, skipped);
  const core::Pose2& truth = today_.true_poses.back().T_world_robot;
  EXPECT_LT((poses.back().mean.position_m() - truth.position_m()).norm(), 0.8);
}

TEST_F(EarlierMap, RelocalisingIsTheNavigatorsLosing) {
  constexpr Scans when = 30;
  QuietBuilder builder;
  const Poses poses = built_from(builder, today_, 0, [&](Scans k) {
    if (k == when) builder.relocalize();
    if (k == when) {
      EXPECT_FALSE(builder.isPlaceKnown());
    }
  });
  supervisor::Navigator navigator(core::PoseGaussian{});
  expect_same_poses(poses, navigated_from(navigator, today_, 0, [&](Scans k) {
                      if (k == when) navigator.lose({});
                    }));
  EXPECT_TRUE(builder.isPlaceKnown());
}

TEST_F(EarlierMap, LandmarksKnownByNameAreNotSearchedFor) {
  QuietBuilder builder;
  testing::drive(builder, today_, true, [](const core::Scan&, Scans k) { return k < 5; });
  EXPECT_THROW(builder.relocalize(), core::PreconditionError);
  EXPECT_TRUE(builder.isPlaceKnown());
  builder.setInitialPose(pdf_of(pose_));  // is another matter
  EXPECT_EQ(RunAccess::pose(builder).mean.vector(), pose_.mean.vector());
}

TEST_F(EarlierMap, NamesArePassedOverOnAMapWithoutThem) {
  QuietBuilder builder;
  const mrpt::poses::CPosePDFGaussian x0 = pdf_of(pose_);
  builder.initializeFromRun(folder(), &x0);
  testing::drive(builder, today_, true, [](const core::Scan&, Scans k) { return k < 3; });
  EXPECT_NE(builder.said().find("later IDs are passed over"), std::string::npos);
}

TEST_F(EarlierMap, WhatCannotBeUsedLeavesTheBuilderAsItWas) {
  QuietBuilder builder;
  built_from(builder, today_, skipped);
  const core::PoseGaussian before = RunAccess::pose(builder);
  EXPECT_THROW(builder.initializeFromRun(path("nowhere")), core::InputError);
  EXPECT_THROW(builder.loadCurrentMapFromFile(path("nowhere") + "/map.bin"), core::InputError);
  EXPECT_THROW(builder.loadCurrentMapFromFile(path("nowhere")), core::InputError)
      << "MRPT would begin with an empty map";
  core::JointMap one;
  one.joint.ids = {0};
  one.joint.points_m = {{1.0, 2.0}};
  one.joint.covariance = Eigen::MatrixXd::Identity(5, 5);
  one.states = {core::LandmarkState::mature};
  one.observations = {3};
  one.next_name = 1;
  std::filesystem::create_directories(path("one"));
  runs::write_map(path("one"), one);
  const std::string said = helixnav::testing::input_error_of([&] { builder.initializeFromRun(path("one")); });
  EXPECT_NE(said.find("1 mature"), std::string::npos) << said;
  EXPECT_EQ(RunAccess::pose(builder).mean.vector(), before.mean.vector());
  MapBuilderOptions particles;
  particles.filter = "fastslam";
  QuietBuilder cloud(particles);
  EXPECT_THROW(cloud.initializeFromRun(folder()), core::PreconditionError);
  EXPECT_THROW(cloud.relocalize(), core::PreconditionError);
}

}  // namespace
}  // namespace helixnav::mrpt_adapter
