// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>

#include <gtest/gtest.h>

#include "genealogy.hpp"
#include "helixnav/core/errors.hpp"
#include "small_drives.hpp"

namespace helixnav::fastslam {
namespace {

/// Everything that a run outputs, number by number.
std::vector<double> transcript(const Options& options, int scans, std::uint64_t seed) {
  FastSlam slam(core::PoseGaussian{}, options, seed);
  std::vector<double> numbers;
  for (const test::Stage& stage : test::drive(scans, 5)) {
    const core::StepReport report = test::step(slam, stage, options.association == Association::known);
    numbers.insert(numbers.end(), {report.pose.mean.x_m, report.pose.mean.heading_rad, report.pose.covariance(0, 1),
                                   slam.cloud().effective_size, slam.cloud().log_evidence,
                                   static_cast<double>(slam.cloud().distinct_ancestors)});
    for (const core::AssociationReport& a : report.associations) numbers.push_back(a.landmark);
  }
  for (std::size_t i = 0; i < slam.poses().size(); ++i) {
    numbers.push_back(slam.poses()[i].x_m);
    for (const core::MapLandmark& m : slam.map_of(i)) {
      numbers.insert(numbers.end(), {static_cast<double>(m.id), m.point.mean_m.x(), m.point.covariance_m2(0, 0)});
    }
  }
  return numbers;
}

bool same_bytes(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

constexpr Association all_associations[] = {Association::known, Association::nearest_neighbour,
                                            Association::likelihood_ratio, Association::sampled,
                                            Association::multiple_hypotheses};

TEST(Filter, GivesTheSameBytesForAnyNumberOfThreads) {
  for (const Association association : all_associations) {
    Options options;
    options.particles = 150;
    options.association = association;
    if (association == Association::nearest_neighbour) options.proposal = Proposal::motion;
    const std::vector<double> one = transcript(options, 25, 3);
    options.threads = 3;
    EXPECT_TRUE(same_bytes(one, transcript(options, 25, 3))) << static_cast<int>(association);
    options.threads = 1;
    EXPECT_FALSE(same_bytes(one, transcript(options, 25, 4)));
  }
}

TEST(Filter, IsBetterThanDeadReckoningWithEveryAssociationAndProposal) {
  for (const Association association : all_associations) {
    for (const Proposal proposal : {Proposal::motion, Proposal::motion_and_scan}) {
      Options options;
      options.particles = 100;
      options.association = association;
      options.proposal = proposal;
      FastSlam slam(core::PoseGaussian{}, options, 1);
      double squares = 0.0, squares_without = 0.0;
      core::Pose2 dead_reckoning;
      const std::vector<test::Stage> stages = test::drive(250, 7);
      for (const test::Stage& stage : stages) {
        const core::Pose2 pose = test::step(slam, stage, association == Association::known).pose.mean;
        squares += (pose.position_m() - stage.truth.position_m()).squaredNorm();
        dead_reckoning = core::compose(dead_reckoning, stage.odometry.T_before_after);
        squares_without += (dead_reckoning.position_m() - stage.truth.position_m()).squaredNorm();
      }
      EXPECT_LT(squares, squares_without) << static_cast<int>(association);
    }
  }
}

TEST(Filter, LeavesEverythingAsItWasWhenTheInputIsBad) {
  Options options;
  options.particles = 50;
  const std::vector<test::Stage> stages = test::drive(30, 5);
  const auto run = [&](bool disturbed) {
    FastSlam slam(core::PoseGaussian{}, options, 3);
    for (const test::Stage& stage : stages) {
      if (disturbed) {
        core::Scan bad = stage.scan;
        bad.observations.push_back(core::make_range_bearing(std::nan(""), 0.0, 0.1, 0.1));
        EXPECT_THROW(slam.update(bad), core::PreconditionError);
        bad.observations.back() = core::make_bearing(0.1, 0.1);
        EXPECT_THROW(slam.update(bad), core::PreconditionError);
        EXPECT_THROW(slam.update_known(stage.scan, stage.names), core::PreconditionError);
        EXPECT_THROW(slam.update(stage.scan, 1), core::PreconditionError);
        core::Odometry nonsense;
        nonsense.covariance(0, 0) = -1.0;
        EXPECT_THROW(slam.predict(nonsense), core::PreconditionError);
      }
      test::step(slam, stage, false);
    }
    std::vector<double> numbers;
    for (const core::Pose2& p : slam.poses()) numbers.insert(numbers.end(), {p.x_m, p.y_m, p.heading_rad});
    for (const core::MapLandmark& m : slam.map()) numbers.push_back(m.point.mean_m.x());
    return numbers;
  };
  EXPECT_TRUE(same_bytes(run(false), run(true)));
}

/// An observation that overflows every weight: no particle can explain it.
TEST(Filter, LeavesEverythingAsItWasWhenNoParticleExplainsTheScan) {
  Options options;
  options.particles = 20;
  options.association = Association::known;
  const auto run = [&](bool disturbed) {
    FastSlam slam(core::PoseGaussian{}, options, 3);
    for (const test::Stage& stage : test::drive(20, 5)) {
      slam.predict(stage.odometry);
      if (disturbed && !stage.names.empty() && stage.names[0] != no_name && stage.scan.t_ns > 500'000'000) {
        core::Scan far = stage.scan;
        far.observations[0].z[0] = 1e200;
        far.observations[0].R.setIdentity();
        EXPECT_THROW(slam.update_known(far, stage.names), core::NumericalError);
      }
      slam.update_known(stage.scan, stage.names);
    }
    std::vector<double> numbers{slam.pose().mean.x_m, slam.cloud().log_evidence};
    for (const core::Pose2& p : slam.poses()) numbers.insert(numbers.end(), {p.x_m, p.y_m, p.heading_rad});
    return numbers;
  };
  EXPECT_TRUE(same_bytes(run(false), run(true)));
}

TEST(Filter, RefusesOptionsOutOfRange) {
  const auto refuses = [](auto change) {
    Options options;
    change(options);
    EXPECT_THROW(FastSlam(core::PoseGaussian{}, options, 1), core::PreconditionError);
  };
  refuses([](Options& o) { o.particles = 0; });
  refuses([](Options& o) { o.new_gate = o.match_gate - 1.0; });
  refuses([](Options& o) { o.detection_probability = 1.0; });
  refuses([](Options& o) { o.new_density = 0.0; });
  refuses([](Options& o) { o.threads = 0; });
  refuses([](Options& o) { o.existence.false_hit_probability = 0.9; });
  EXPECT_THROW(FastSlam(std::vector<core::PoseGaussian>{}, Options{}, 1), core::PreconditionError);
}

TEST(Filter, TwoRobotsShareOneMap) {
  Options options;
  options.particles = 60;
  options.association = Association::known;
  options.existence.remove = false;
  const std::vector<test::Stage> stages = test::drive(60, 5);
  FastSlam slam(std::vector<core::PoseGaussian>(2), options, 1);
  for (const test::Stage& stage : stages) {
    for (const std::size_t robot : {0U, 1U}) {
      slam.predict(stage.odometry, robot);
      slam.update_known(stage.scan, stage.names, robot);
    }
  }
  FastSlam lone(core::PoseGaussian{}, options, 1);
  for (const test::Stage& stage : stages) test::step(lone, stage, true);
  ASSERT_EQ(slam.map().size(), lone.map().size());
  EXPECT_EQ(slam.map()[0].observations, 2 * lone.map()[0].observations);
  EXPECT_LT((slam.pose(0).mean.position_m() - slam.pose(1).mean.position_m()).norm(), 0.2);
}

TEST(Filter, MemoryComesBackWhenLandmarksDie) {
  Options options;
  options.particles = 40;
  FastSlam slam(core::PoseGaussian{}, options, 1);
  core::Scan scan;
  scan.field_of_view = {0.0, 20.0, -core::pi, core::pi};
  scan.observations = {core::make_range_bearing(5.0, 0.2, 0.1, 0.02)};
  slam.update(scan);
  EXPECT_EQ(slam.map().size(), 1U);
  EXPECT_GT(slam.memory().nodes, 0U);
  scan.observations.clear();
  core::Odometry odometry;
  odometry.T_before_after = core::Pose2(0.5, 0.0, 0.0);
  for (int k = 0; k < 8; ++k) {
    slam.predict(odometry);
    slam.update(scan);
  }
  EXPECT_EQ(slam.map().size(), 0U);
}

TEST(Filter, BeginsWithAMapThatIsGivenAndMatchesIt) {
  Options options;
  options.particles = 30;
  FastSlam slam(core::PoseGaussian{}, options, 1);
  const Eigen::Matrix2d P = 0.01 * Eigen::Matrix2d::Identity();
  slam.begin_with({{{4.0, 1.0}, P}, {{5.0, -2.0}, P}});
  core::Scan scan;
  scan.observations = {core::make_cartesian({5.05, -2.0}, P)};
  const core::StepReport report = slam.update(scan);
  EXPECT_EQ(report.associations[0].landmark, 1);
  EXPECT_EQ(slam.map().size(), 2U);
  EXPECT_NEAR(slam.map()[0].point.mean_m.x(), 4.0, 1e-6);
  EXPECT_THROW(slam.begin_with({}), core::PreconditionError);
}

TEST(Genealogy, CountsAncestorsOverTheDriveThatWasAskedFor) {
  Genealogy genealogy(4, 8.0);
  EXPECT_EQ(genealogy.distinct_ancestors(), 4U);
  genealogy.descend({0, 0, 2, 2});
  EXPECT_EQ(genealogy.distinct_ancestors(), 2U);
  for (int k = 0; k < 8; ++k) genealogy.drive(1.0, 4);  // the mark at 0 m is 8 m ago: nothing later is old enough
  EXPECT_EQ(genealogy.distinct_ancestors(), 2U);
  genealogy.drive(1.0, 4);  // the mark at 1 m was set after that resampling
  EXPECT_EQ(genealogy.distinct_ancestors(), 4U);
  genealogy.descend({1, 1, 1, 3});
  EXPECT_EQ(genealogy.distinct_ancestors(), 2U);
}

}  // namespace
}  // namespace helixnav::fastslam
