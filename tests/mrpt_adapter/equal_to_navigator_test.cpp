// SPDX-License-Identifier: BSD-3-Clause
//
// The component adds nothing to the navigator and takes nothing away: whole drives, poses and covariances bit for bit.
#include <cstring>
#include <thread>

#include <gtest/gtest.h>
#include <mrpt/poses/CPose3DPDFParticles.h>

#include "helixnav/sim/simulate.hpp"
#include "helixnav/supervisor/named_navigator.hpp"
#include "helixnav/supervisor/navigator.hpp"
#include "quiet_builder.hpp"

namespace helixnav::mrpt_adapter {
namespace {

using testing::as_mrpt_keeps;
using testing::QuietBuilder;

bool same_bytes(const core::PoseGaussian& a, const core::PoseGaussian& b) {
  const Eigen::Vector3d mean_a = a.mean.vector();
  const Eigen::Vector3d mean_b = b.mean.vector();
  return std::memcmp(mean_a.data(), mean_b.data(), sizeof(double) * 3) == 0 &&
         std::memcmp(a.covariance.data(), b.covariance.data(), sizeof(double) * 9) == 0;
}

/// Poses of the navigator, fed what MRPT's types keep of a recording.
std::vector<core::PoseGaussian> navigated(const core::Recording& recording, bool by_name, std::size_t scans) {
  supervisor::Navigator navigator(core::PoseGaussian{});
  supervisor::NamedNavigator named(core::PoseGaussian{});
  std::vector<core::PoseGaussian> poses;
  std::optional<core::Odometry> motion;
  for (const core::Event& event : recording.events) {
    if (poses.size() == scans) break;
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
      motion = motion ? core::chain(*motion, *odometry) : *odometry;
    } else if (const auto* scan = std::get_if<core::Scan>(&event)) {
      if (motion) by_name ? named.move(as_mrpt_keeps(*motion)) : navigator.move(as_mrpt_keeps(*motion));
      motion.reset();
      const core::Scan kept = as_mrpt_keeps(*scan);
      poses.push_back(by_name ? named.observe(kept, recording.labels[poses.size()]).pose
                              : navigator.observe(kept).pose);
    }
  }
  return poses;
}

std::vector<core::PoseGaussian> built(const core::Recording& recording, bool by_name, std::size_t scans,
                                      std::string* said = nullptr) {
  QuietBuilder builder;
  std::vector<core::PoseGaussian> poses;
  testing::drive(builder, recording, by_name, [&](const core::Scan&, std::size_t) {
    poses.push_back(RunAccess::last_steps(builder).back().report.pose);
    return poses.size() < scans;
  });
  if (said != nullptr) *said = builder.said();
  return poses;
}

void expect_same(const std::vector<core::PoseGaussian>& a, const std::vector<core::PoseGaussian>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_TRUE(same_bytes(a[i], b[i])) << "scan " << i;
}

constexpr std::size_t all_scans = 1'000'000;

TEST(EqualToNavigator, ThroughALargeLoopAndItsClosing) {
  const core::Recording recording = sim::simulate(sim::named_scenario("large-loop"), 3);
  const std::vector<core::PoseGaussian> expected = navigated(recording, false, all_scans);
  ASSERT_GT(expected.size(), 300u);
  std::string said;
  expect_same(built(recording, false, all_scans, &said), expected);
  EXPECT_NE(said.find("Accepted: the cost"), std::string::npos);
}

TEST(EqualToNavigator, WithLandmarksKnownByName) {
  const core::Recording recording = sim::simulate(sim::named_scenario("large-loop"), 4);
  expect_same(built(recording, true, 200), navigated(recording, true, 200));
}

TEST(EqualToNavigator, TwoBuildersInTwoThreads) {
  const core::Recording first = sim::simulate(sim::named_scenario("large-loop"), 5);
  const core::Recording second = sim::simulate(sim::named_scenario("large-loop"), 6);
  std::vector<core::PoseGaussian> poses_of_first, poses_of_second;
  std::thread one([&] { poses_of_first = built(first, false, 250); });
  std::thread other([&] { poses_of_second = built(second, false, 250); });
  one.join();
  other.join();
  expect_same(poses_of_first, built(first, false, 250));
  expect_same(poses_of_second, built(second, false, 250));
}

TEST(PoseEstimation, IsAGaussianWhileMappingAndParticlesWhileRelocalising) {
  const core::Recording recording = sim::simulate(sim::named_scenario("large-loop"), 7);
  QuietBuilder builder;
  std::size_t clouds = 0, gaussians_after_closing = 0;
  testing::drive(builder, recording, false, [&](const core::Scan&, std::size_t) {
    const core::StepReport& report = RunAccess::last_steps(builder).back().report;
    const auto pdf = builder.getCurrentPoseEstimation();
    const auto* particles = dynamic_cast<const mrpt::poses::CPose3DPDFParticles*>(pdf.get());
    EXPECT_EQ(particles != nullptr, !report.cloud.empty());
    EXPECT_EQ(builder.getLastDataAssociation().searching, report.mode == core::Mode::searching);
    if (particles != nullptr) {
      ++clouds;
      EXPECT_EQ(particles->size(), report.cloud.size());
      EXPECT_EQ(particles->getParticlePose(0).x, report.cloud[0].x_m);
      EXPECT_EQ(particles->getParticlePose(0).yaw, report.cloud[0].heading_rad);
    } else if (clouds > 0) {
      ++gaussians_after_closing;
      const auto [covariance, mean] = pdf->getCovarianceAndMean();
      EXPECT_EQ(mean.x(), report.pose.mean.x_m);
      EXPECT_EQ(covariance(0, 3), report.pose.covariance(0, 2));
      EXPECT_EQ(covariance(2, 2), 0.0);
    }
    return gaussians_after_closing < 10;
  });
  EXPECT_GT(clouds, 3u);
  EXPECT_EQ(gaussians_after_closing, 10u);
  EXPECT_NE(builder.said().find("Accepted: the cost"), std::string::npos);
}

}  // namespace
}  // namespace helixnav::mrpt_adapter
