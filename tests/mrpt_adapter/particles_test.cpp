// SPDX-License-Identifier: BSD-3-Clause
//
// filter = fastslam is FastSLAM, number by number.
#include <cmath>

#include <gtest/gtest.h>
#include <mrpt/math/CMatrixDynamic.h>
#include <mrpt/math/CVectorDynamic.h>
#include <mrpt/math/TPoint2D.h>
#include <mrpt/poses/CPose3DPDFParticles.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/fastslam/observe.hpp"
#include "helixnav/sim/simulate.hpp"
#include "quiet_builder.hpp"

namespace helixnav::mrpt_adapter {
namespace {

using testing::as_mrpt_keeps;
using testing::QuietBuilder;

constexpr std::size_t scans_driven = 40;

MapBuilderOptions with_particles() {
  MapBuilderOptions options;
  options.filter = "fastslam";
  options.fastslam_particles = 30;
  options.fastslam_seed = 5;
  return options;
}

/// The same cloud as the builder's, fed what MRPT's types keep.
fastslam::FastSlam driven_cloud(const core::Recording& run, bool by_name) {
  fastslam::Options options;
  options.particles = 30;
  if (by_name) options.association = fastslam::Association::known;
  if (by_name) options.existence.remove = false;
  fastslam::FastSlam slam(core::PoseGaussian{}, options, 5);
  std::optional<core::Odometry> motion;
  std::size_t scans = 0;
  for (const core::Event& event : run.events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
      motion = motion ? core::chain(*motion, *odometry) : *odometry;
    } else if (const auto* scan = std::get_if<core::Scan>(&event)) {
      if (motion) slam.predict(as_mrpt_keeps(*motion));
      motion.reset();
      const core::Scan kept = as_mrpt_keeps(*scan);
      by_name ? fastslam::observe_known(slam, kept, run.labels[scans]) : fastslam::observe(slam, kept);
      if (++scans == scans_driven) break;
    }
  }
  return slam;
}

void expect_same_map(const MapBuilder& builder, const fastslam::FastSlam& slam) {
  const std::vector<core::MapLandmark> map = RunAccess::map(builder), expected = slam.map();
  ASSERT_EQ(map.size(), expected.size());
  for (std::size_t i = 0; i < map.size(); ++i) EXPECT_EQ(map[i].point.mean_m, expected[i].point.mean_m);
}

TEST(ParticleBuilder, IsFastSlamWithUnknownAssociationAndByName) {
  const core::Recording run = sim::simulate(sim::named_scenario("circuit"), 2);
  for (const bool by_name : {false, true}) {
    QuietBuilder builder(with_particles());
    testing::drive(builder, run, by_name, [](const core::Scan&, std::size_t k) { return k + 1 < scans_driven; });
    const fastslam::FastSlam slam = driven_cloud(run, by_name);
    EXPECT_EQ(RunAccess::pose(builder).mean.vector(), slam.pose().mean.vector());
    expect_same_map(builder, slam);
    EXPECT_TRUE(builder.isPlaceKnown());
    EXPECT_FALSE(RunAccess::joint_map(builder).has_value());
  }
}

TEST(ParticleBuilder, TheEstimateIsTheCloudWithItsWeights) {
  const core::Recording run = sim::simulate(sim::named_scenario("circuit"), 2);
  QuietBuilder builder(with_particles());
  testing::drive(builder, run, false, [](const core::Scan&, std::size_t k) { return k + 1 < scans_driven; });
  const fastslam::FastSlam slam = driven_cloud(run, false);
  const auto pdf = builder.getCurrentPoseEstimation();
  const auto* particles = dynamic_cast<const mrpt::poses::CPose3DPDFParticles*>(pdf.get());
  ASSERT_NE(particles, nullptr);
  ASSERT_EQ(particles->size(), 30u);
  const std::vector<double> weights = slam.weights();
  for (std::size_t i = 0; i < 30; ++i) {
    EXPECT_EQ(particles->getParticlePose(i).x, slam.poses()[i].x_m);
    EXPECT_DOUBLE_EQ(std::exp(particles->getW(i)), weights[i]);
  }
}

TEST(ParticleBuilder, TheStateIsThatOfTheHeaviestParticleBesideTheCloudsPose) {
  const core::Recording run = sim::simulate(sim::named_scenario("circuit"), 2);
  QuietBuilder builder(with_particles());
  testing::drive(builder, run, false, [](const core::Scan&, std::size_t k) { return k + 1 < scans_driven; });
  mrpt::poses::CPosePDFGaussian pose;
  std::vector<mrpt::math::TPoint2D> points;
  std::map<unsigned int, std::int64_t> numbers;
  mrpt::math::CVectorDouble state;
  mrpt::math::CMatrixDouble covariance;
  builder.getCurrentState(pose, points, numbers, state, &covariance);
  const std::vector<core::MapLandmark> map = driven_cloud(run, false).map();
  ASSERT_EQ(points.size(), map.size());
  ASSERT_EQ(covariance.rows(), 3 + 2 * static_cast<int>(map.size()));
  EXPECT_EQ(covariance(3, 4), map[0].point.covariance_m2(0, 1));
  EXPECT_EQ(covariance(0, 3), 0.0);
  EXPECT_EQ(covariance(0, 2), RunAccess::pose(builder).covariance(0, 2));
}

TEST(ParticleBuilder, DoesNotTakeFixes) {
  MapBuilderOptions options = with_particles();
  options.gps_use = true;
  EXPECT_THROW(QuietBuilder{options}, core::InputError);
}

}  // namespace
}  // namespace helixnav::mrpt_adapter
