// SPDX-License-Identifier: BSD-3-Clause
//
// A scanner that sees all around, landmarks behind the vehicle, unknown association: MRPT issue 909.
#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>
#include <mrpt/version.h>

#include "helixnav/core/random.hpp"
#include "kf_slam.hpp"
#include "quiet_builder.hpp"

namespace helixnav::mrpt_adapter {
namespace {

constexpr double sigma_range_m = 0.05;
constexpr double sigma_bearing_rad = 0.5 * core::pi / 180.0;
constexpr std::size_t steps = 80;

/// A vehicle that turns on the spot and drives between landmarks that surround it on all sides.
core::Recording surrounded(std::uint64_t seed) {
  core::RandomStream random(seed, "surrounded");
  std::vector<Eigen::Vector2d> landmarks_m;
  for (int i = 0; i < 12; ++i) {
    const double angle = 2.0 * core::pi * i / 12.0;
    landmarks_m.emplace_back(6.0 * std::cos(angle), 6.0 * std::sin(angle));
  }
  core::Recording recording;
  core::Pose2 truth;
  for (std::size_t k = 0; k < steps; ++k) {
    const core::Pose2 moved(0.05, 0.0, 2.0 * core::pi / 40.0);
    core::Odometry odometry;
    odometry.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-4).asDiagonal();
    odometry.T_before_after = core::Pose2(moved.vector() + random.normal3(odometry.covariance));
    truth = core::compose(truth, moved);
    core::Scan scan;
    scan.t_ns = static_cast<core::Nanoseconds>(k) * 100'000'000;
    scan.field_of_view = {0.0, 15.0, -core::pi, core::pi};
    for (const Eigen::Vector2d& landmark_m : landmarks_m) {
      const Eigen::Vector2d p = core::transform(core::inverse(truth), landmark_m);
      scan.observations.push_back(
          core::make_range_bearing(p.norm() + random.normal(0.0, sigma_range_m),
                                   core::wrap_to_pi(std::atan2(p.y(), p.x()) + random.normal(0.0, sigma_bearing_rad)),
                                   sigma_range_m, sigma_bearing_rad));
    }
    recording.events.emplace_back(odometry);
    recording.events.emplace_back(scan);
  }
  for (const Eigen::Vector2d& point_m : landmarks_m) recording.true_landmarks.push_back({0, point_m});
  return recording;
}

std::size_t landmarks_of_kf_slam(const core::Recording& recording) {
  helixnav::testing::KfSlam filter(sigma_range_m, sigma_bearing_rad);
  auto actions = std::make_shared<mrpt::obs::CActionCollection>();
  for (const core::Event& event : recording.events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
      *actions = testing::action_of(*odometry);
    } else {
      auto frame = std::make_shared<mrpt::obs::CSensoryFrame>(testing::frame_of(std::get<core::Scan>(event)));
      filter.take(actions, frame);
    }
  }
  return filter.landmarks_m().size();
}

TEST(FullCircle, EveryLandmarkIsMappedOnceWhereKfSlamMapsItAgain) {
  for (const std::uint64_t seed : {11u, 12u, 13u}) {
    const core::Recording recording = surrounded(seed);
    testing::QuietBuilder builder;
    testing::drive(builder, recording, false, [](const core::Scan&, std::size_t) { return true; });
    const std::vector<core::MapLandmark> map = RunAccess::map(builder);
    EXPECT_EQ(map.size(), recording.true_landmarks.size()) << "seed " << seed;
    for (const core::TrueLandmark& truth : recording.true_landmarks) {
      const auto near = std::count_if(map.begin(), map.end(), [&](const core::MapLandmark& landmark) {
        return (landmark.point.mean_m - truth.point_m).norm() < 0.5;
      });
      EXPECT_EQ(near, 1) << "seed " << seed;
    }
#if MRPT_VERSION == 0x258
    EXPECT_GT(landmarks_of_kf_slam(recording), recording.true_landmarks.size()) << "seed " << seed;
#endif
  }
}

}  // namespace
}  // namespace helixnav::mrpt_adapter
