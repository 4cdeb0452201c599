// SPDX-License-Identifier: BSD-3-Clause
//
// FastSLAM compared with what it reduces to in special cases.
#include <cmath>
#include <map>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "helixnav/core/observation.hpp"
#include "small_drives.hpp"

namespace helixnav::fastslam {
namespace {

Options one_particle() {
  Options options;
  options.particles = 1;
  options.proposal = Proposal::motion;
  options.association = Association::known;
  options.existence.remove = false;
  return options;
}

/// Landmarks one by one, each with its own Kalman filter, at known poses.
struct LandmarkFilters {
  std::map<KnownName, core::PointGaussian> landmarks;

  void take(const core::Pose2& pose, const test::Stage& stage) {
    for (std::size_t j = 0; j < stage.names.size(); ++j) {
      const core::Observation& z = stage.scan.observations[j];
      if (stage.names[j] == no_name) continue;
      const auto known = landmarks.find(stage.names[j]);
      if (known == landmarks.end()) {
        const auto m = core::locate_landmark(z, pose, stage.scan.T_robot_sensor);
        landmarks[stage.names[j]] = {m.point_world_m, m.G_z * Eigen::Matrix2d(z.R) * m.G_z.transpose()};
        continue;
      }
      auto& [mean, P] = known->second;
      const auto h = core::predict_observation(z.kind, pose, stage.scan.T_robot_sensor, mean);
      const Eigen::Matrix2d H = h.H_landmark, S = H * P * H.transpose() + Eigen::Matrix2d(z.R);
      const Eigen::Matrix2d K = P * H.transpose() * S.inverse();
      mean += K * Eigen::Vector2d(core::innovation(z.kind, z.z, h.z_hat));
      P -= K * S * K.transpose();
    }
  }
};

TEST(Twins, OneParticleOfFastSlam1IsTheEkfOfItsLandmarksAtItsPoses) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    FastSlam slam(core::PoseGaussian{}, one_particle(), seed);
    LandmarkFilters twin;
    for (const test::Stage& stage : test::drive(300, seed)) {
      test::step(slam, stage, true);
      twin.take(slam.poses().front(), stage);
    }
    const std::vector<core::MapLandmark> map = slam.map();
    ASSERT_EQ(map.size(), twin.landmarks.size());
    for (const core::MapLandmark& landmark : map) {
      const core::PointGaussian& expected = twin.landmarks.at(slam.name_of(landmark.id));
      EXPECT_LT((landmark.point.mean_m - expected.mean_m).norm(), 1e-5);
      EXPECT_LT((landmark.point.covariance_m2 - expected.covariance_m2).norm(), 1e-5 * expected.covariance_m2.norm());
    }
  }
}

/// A robot that cannot turn and sees points in its own axes: everything is linear.
TEST(Twins, NormaliserAndInnovationsOfFastSlam2AreThoseOfTheLinearCase) {
  Options options = one_particle();
  options.proposal = Proposal::motion_and_scan;
  options.added_sigma_m = options.added_sigma_rad = 0.0;
  FastSlam slam(core::PoseGaussian{}, options, 1);
  const Eigen::Matrix2d R0 = Eigen::Vector2d(0.04, 0.09).asDiagonal(), R1 = Eigen::Vector2d(0.02, 0.05).asDiagonal();
  core::Scan scan;
  scan.observations = {core::make_cartesian({3.0, 1.0}, R0), core::make_cartesian({-1.0, 4.0}, R0)};
  slam.update_known(scan, {7, 8});
  core::Odometry odometry;
  odometry.T_before_after = core::Pose2(0.5, 0.2, 0.0);
  odometry.covariance.topLeftCorner<2, 2>() << 0.09, 0.02, 0.02, 0.04;
  slam.predict(odometry);
  core::Scan second;
  second.observations = {core::make_cartesian({2.7, 0.9}, R1), core::make_cartesian({-1.6, 3.9}, R1)};
  const core::StepReport report = slam.update_known(second, {7, 8});

  // The innovations of both, from before the scan, with their joint covariance.
  const Eigen::Matrix2d Q = odometry.covariance.topLeftCorner<2, 2>();
  const Eigen::Vector4d nu(0.2, 0.1, -0.1, 0.1);
  Eigen::Matrix4d S = Q.replicate<2, 2>();
  S.topLeftCorner<2, 2>() += R0 + R1;
  S.bottomRightCorner<2, 2>() += R0 + R1;
  EXPECT_NEAR(report.joint_nis, nu.dot(S.inverse() * nu), 1e-5);
  const Eigen::Matrix2d S_of_one = Q + R0 + R1;
  for (int j = 0; j < 2; ++j) {
    const Eigen::Vector2d of_one = nu.segment<2>(2 * j);
    EXPECT_NEAR(report.associations[static_cast<std::size_t>(j)].nis, of_one.dot(S_of_one.inverse() * of_one), 1e-5);
  }

  // p(z) = ∫ N(x; f, Q) Π N(z_j; m_j − x, Σ_j + R) dx by the trapezoidal rule, which is exact for such functions.
  const Eigen::Matrix2d Q_inverse = odometry.covariance.topLeftCorner<2, 2>().inverse();
  const Eigen::Matrix2d S_inverse = (R0 + R1).inverse();
  const double scale = std::pow(2.0 * core::pi, -3.0) * std::sqrt(Q_inverse.determinant()) * S_inverse.determinant();
  double integral = 0.0;
  const double h = 0.02;
  for (double x = -2.0; x <= 3.0; x += h) {
    for (double y = -2.0; y <= 2.5; y += h) {
      const Eigen::Vector2d at(x, y), d = at - Eigen::Vector2d(0.5, 0.2);
      const Eigen::Vector2d nu0 = Eigen::Vector2d(2.7, 0.9) - (Eigen::Vector2d(3.0, 1.0) - at);
      const Eigen::Vector2d nu1 = Eigen::Vector2d(-1.6, 3.9) - (Eigen::Vector2d(-1.0, 4.0) - at);
      integral += scale * std::exp(-0.5 * (d.dot(Q_inverse * d) + nu0.dot(S_inverse * nu0) + nu1.dot(S_inverse * nu1)));
    }
  }
  EXPECT_NEAR(slam.cloud().log_evidence, std::log(integral * h * h), 1e-5);
}

/// Same case: the reported mean and covariance are the Kalman filter's for the pose, landmarks known to N(m, R0).
TEST(Twins, ManyParticlesOfEitherProposalHaveTheMeanOfTheLinearPosterior) {
  for (const Proposal proposal : {Proposal::motion, Proposal::motion_and_scan}) {
    Options options = one_particle();
    options.proposal = proposal;
    options.particles = 20'000;
    FastSlam slam(core::PoseGaussian{}, options, 4);
    const Eigen::Matrix2d R0 = 0.04 * Eigen::Matrix2d::Identity(), R1 = 0.02 * Eigen::Matrix2d::Identity();
    core::Scan scan;
    scan.observations = {core::make_cartesian({3.0, 1.0}, R0)};
    options.added_sigma_m = 0.0;
    slam.update_known(scan, {7});
    core::Odometry odometry;
    odometry.T_before_after = core::Pose2(0.5, 0.2, 0.0);
    odometry.covariance.topLeftCorner<2, 2>() = 0.09 * Eigen::Matrix2d::Identity();
    slam.predict(odometry);
    core::Scan second;
    second.observations = {core::make_cartesian({2.9, 0.9}, R1)};
    const core::StepReport report = slam.update_known(second, {7});
    // Gain 0.09 / (0.09 + 0.06) on what the observation says of the pose, (0.1, 0.1) against (0.5, 0.2). Four standard
    // errors of the mean of 20 000 particles: 0.0054 m for 2.0, whose particles have nearly equal weights, less than
    // twice that for 1.0.
    EXPECT_NEAR(report.pose.mean.x_m, 0.5 - 0.6 * 0.4, 0.011);
    EXPECT_NEAR(report.pose.mean.y_m, 0.2 - 0.6 * 0.1, 0.011);
    EXPECT_NEAR(report.pose.covariance(0, 0), 0.036, 0.003);
    EXPECT_NEAR(report.pose.covariance(1, 1), 0.036, 0.003);
  }
}

TEST(Twins, HeadingsAreAveragedOnTheCircle) {
  Options options = one_particle();
  options.particles = 2000;
  core::PoseGaussian start;
  start.mean = core::Pose2(0.0, 0.0, core::pi);
  start.covariance(2, 2) = 0.01;
  FastSlam slam(start, options, 2);
  const core::StepReport report = slam.update_known(core::Scan{}, {});
  EXPECT_NEAR(core::wrap_to_pi(report.pose.mean.heading_rad - core::pi), 0.0, 4.5 * 0.1 / std::sqrt(2000.0));
  EXPECT_NEAR(report.pose.covariance(2, 2), 0.01, 0.0016);
}

}  // namespace
}  // namespace helixnav::fastslam
