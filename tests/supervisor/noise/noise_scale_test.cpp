// SPDX-License-Identifier: BSD-3-Clause
#include "noise/noise_scale.hpp"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/core/random.hpp"

namespace helixnav::supervisor {
namespace {

/// Six landmarks known exactly, a vehicle whose motion has covariance Q, and a detector of 10 cm.
struct NoisyDrive {
  explicit NoisyDrive(double odometry_factor, double detector_factor,
                      const Eigen::Vector3d& bias = Eigen::Vector3d::Zero(), int lasting = 1, double motion = 1.0)
      : odometry_factor_(odometry_factor),
        detector_factor_(detector_factor),
        bias_(bias),
        lasting_(lasting),
        claimed_Q_(motion * Eigen::Matrix3d(Eigen::Vector3d(0.01, 0.01, 1e-4).asDiagonal())) {
    geometry_.points_m = {{5, 3}, {12, -4}, {20, 6}, {25, -7}, {9, 8}, {16, -9}};
    geometry_.ids = {0, 1, 2, 3, 4, 5};
  }

  /// Scans with the noise assumed at that time; odometry and detector are this many times (variance) worse.
  NoiseScale learn(int scans) {
    NoiseScale scale;
    for (int k = 0; k < scans; ++k) {
      const double before = scale.observations();
      const Eigen::Matrix3d Q = scale.odometry() * claimed_Q_;
      const Eigen::Matrix3d true_Q = odometry_factor_ * claimed_Q_;
      const core::Pose2 T_displaced_predicted =
          core::inverse(core::Pose2(Eigen::Vector3d(random_.normal3(true_Q) + bias_)));
      std::vector<SeenPoint> seen;
      std::vector<PointPair> pairs;
      for (std::size_t i = 0; i < geometry_.points_m.size(); ++i) {
        const double sigma_m = 0.1 * std::sqrt(detector_factor_);
        if (k % lasting_ == 0) {
          noise_[i].x() = random_.normal(0.0, sigma_m);
          noise_[i].y() = random_.normal(0.0, sigma_m);
        }
        seen.push_back({static_cast<int>(i), core::transform(T_displaced_predicted, geometry_.points_m[i]) + noise_[i],
                        0.01 * scale.observations() * Eigen::Matrix2d::Identity()});
        pairs.push_back({i, i});
      }
      geometry_.covariance_m2 = by_pose() * Q * by_pose().transpose();
      scale.observe(PairEquations(geometry_, seen, pairs, Eigen::Vector3d::Zero()), looks(k), 0.0, Q);
      withdrawn += before < 1.0 && scale.observations() == 1.0 ? 1 : 0;
    }
    return scale;
  }

  int withdrawn = 0;     ///< how often less noise of the detector was no longer believed
  std::size_t fair = 6;  ///< landmarks whose errors could be as large as they are; the others stand in rows

 private:
  /// Every tenth scan looks from another side.
  std::vector<Look> looks(int scan) const {
    std::vector<Look> looks;
    for (const core::LandmarkId id : geometry_.ids) looks.push_back({id, scan % 10 == 9, looks.size() < fair});
    return looks;
  }

  Eigen::MatrixXd by_pose() const {
    Eigen::MatrixXd J(2 * static_cast<Eigen::Index>(geometry_.points_m.size()), 3);
    for (std::size_t i = 0; i < geometry_.points_m.size(); ++i) {
      const Eigen::Vector2d& p = geometry_.points_m[i];
      J.middleRows<2>(2 * static_cast<Eigen::Index>(i)) << -1.0, 0.0, p.y(), 0.0, -1.0, -p.x();
    }
    return J;
  }

  double odometry_factor_;
  double detector_factor_;
  Eigen::Vector3d bias_;
  int lasting_;  ///< scans for which the detector's errors stay the same
  std::array<Eigen::Vector2d, 6> noise_;
  Eigen::Matrix3d claimed_Q_;
  core::RandomStream random_{1, "noise scale test"};
  RelativeGeometry geometry_{core::JointGaussian{{}, {}, {}, Eigen::MatrixXd::Identity(3, 3)}};
};

/// Six landmarks are seen exactly where they are expected, except for residuals as large as the detector's errors, as
/// if nothing had displaced the vehicle.
void observe_too_little(double share, NoiseScale& scale) {
  RelativeGeometry geometry(core::JointGaussian{{}, {}, {}, Eigen::MatrixXd::Identity(3, 3)});
  geometry.points_m = {{8, 0}, {4, 7}, {-4, 7}, {-8, 0}, {-4, -7}, {4, -7}};
  geometry.ids = {0, 1, 2, 3, 4, 5};
  std::vector<SeenPoint> seen;
  std::vector<PointPair> pairs;
  for (std::size_t i = 0; i < geometry.points_m.size(); ++i) {
    const double outward = i % 2 == 0 ? 1.02 : 0.98;  // sums to no displacement
    seen.push_back({static_cast<int>(i), outward * geometry.points_m[i], 0.01 * Eigen::Matrix2d::Identity()});
    pairs.push_back({i, i});
  }
  const double q_m2 = scale.odometry() * share / (1.0 - share) * 0.01 / 6.0;
  const Eigen::Matrix3d Q = Eigen::Vector3d(q_m2, q_m2, q_m2 / 64.0).asDiagonal();
  Eigen::MatrixXd by_pose(12, 3);
  for (Eigen::Index i = 0; i < 6; ++i) {
    const Eigen::Vector2d& p = geometry.points_m[static_cast<std::size_t>(i)];
    by_pose.middleRows<2>(2 * i) << -1.0, 0.0, p.y(), 0.0, -1.0, -p.x();
  }
  geometry.covariance_m2 = by_pose * Q * by_pose.transpose();
  scale.observe(PairEquations(geometry, seen, pairs, Eigen::Vector3d::Zero()), std::vector<Look>(6), 0.0, Q);
}

TEST(NoiseScale, StaysAtOneWhereTheNoiseIsAsClaimed) {
  const NoiseScale scale = NoisyDrive(1.0, 1.0).learn(2000);
  EXPECT_EQ(scale.odometry(), 1.0);
  EXPECT_EQ(scale.observations(), 1.0);
}

TEST(NoiseScale, TellsOdometryFromDetector) {
  const NoiseScale odometry = NoisyDrive(4.0, 1.0).learn(1500);
  EXPECT_NEAR(odometry.odometry(), 4.0, 0.8);
  EXPECT_EQ(odometry.observations(), 1.0);
  const NoiseScale detector = NoisyDrive(1.0, 4.0).learn(1500);
  EXPECT_NEAR(detector.observations(), 4.0, 0.5);
  EXPECT_LT(detector.odometry(), 1.6);
  const NoiseScale both = NoisyDrive(4.0, 4.0).learn(1500);
  EXPECT_NEAR(both.observations(), 4.0, 0.5);
  EXPECT_NEAR(both.odometry(), 4.0, 1.0);
}

TEST(NoiseScale, LearnsNoLessFromErrorsThatCouldNotBeLarger) {
  NoisyDrive in_rows(0.1, 0.1);
  in_rows.fair = 0;
  const NoiseScale as_assumed = in_rows.learn(2000);
  EXPECT_EQ(as_assumed.odometry(), 1.0);
  EXPECT_EQ(as_assumed.observations(), 1.0);
  NoisyDrive three_apart(0.1, 0.1);
  three_apart.fair = 3;
  EXPECT_LT(three_apart.learn(2000).odometry(), 0.5) << "what three that stand apart say";
  NoisyDrive worse(4.0, 4.0);
  worse.fair = 0;
  const NoiseScale more = worse.learn(1500);
  EXPECT_NEAR(more.observations(), 4.0, 0.5) << "larger than they could be if it were less";
  EXPECT_NEAR(more.odometry(), 4.0, 1.0);
}

/// Odometry's share of a displacement is a few per cent as assumed: one scan says next to nothing, a thousand do.
TEST(NoiseScale, LearnsOdometrysNoiseWhereTheDetectorHidesIt) {
  const Eigen::Vector3d no_bias = Eigen::Vector3d::Zero();
  constexpr double little = 0.003;
  const NoiseScale sixteen = NoisyDrive(16.0, 1.0, no_bias, 1, little).learn(1500);
  EXPECT_NEAR(std::log(sixteen.odometry() / 16.0), 0.0, std::log(2.0));
  EXPECT_EQ(sixteen.observations(), 1.0);
  EXPECT_EQ(NoisyDrive(1.0, 1.0, no_bias, 1, little).learn(1500).odometry(), 1.0);
}

TEST(NoiseScale, LearnsThatThereIsLessNoise) {
  const NoiseScale both = NoisyDrive(0.25, 0.25).learn(1500);
  EXPECT_NEAR(both.observations(), 0.25, 0.05);
  EXPECT_NEAR(both.odometry(), 0.25, 0.12);
  const NoiseScale detector = NoisyDrive(1.0, 0.25).learn(1500);
  EXPECT_NEAR(detector.observations(), 0.25, 0.08);
  EXPECT_EQ(detector.odometry(), 1.0);
}

TEST(NoiseScale, TakesErrorsThatAreTheSameFromOnePlaceForNoLessNoise) {
  EXPECT_EQ(NoisyDrive(1.0, 0.25).learn(9).observations(), 1.0) << "no landmark was seen from another side yet";
}

TEST(NoiseScale, TakesErrorsThatLastForSixScansForNoLessNoise) {
  const Eigen::Vector3d no_bias = Eigen::Vector3d::Zero();
  EXPECT_EQ(NoisyDrive(1.0, 0.25, no_bias, 6).learn(1500).observations(), 1.0);
}

TEST(NoiseScale, TakesDisplacementsThatOdometryDoesNotExplainForErrorsOfTheDetectorThatAreNotWhite) {
  EXPECT_EQ(NoisyDrive(4.0, 0.25).learn(1500).observations(), 1.0);
}

TEST(NoiseScale, DoesNotBelieveInTurnsInLessNoiseAndInNone) {
  NoisyDrive drive(1.45, 0.25);  // displacements about as large as just contradicts it
  drive.learn(6000);
  EXPECT_LE(drive.withdrawn, 2);
}

/// Displacements smaller than the detector's errors alone explain say nothing about odometry that hardly contributes to them.
TEST(NoiseScale, BelievesNoLessThanItIsSureOf) {
  constexpr double share = 0.25;  // of odometry in a displacement
  NoiseScale scale;
  double least = 1.0;
  int changes = 0;
  for (int scan = 0; scan < 400; ++scan) {
    const double before = scale.odometry();
    observe_too_little(share, scale);
    least = std::min(least, scale.odometry());
    changes += scale.odometry() != before && (before == 1.0 || scale.odometry() == 1.0) ? 1 : 0;
  }
  EXPECT_GT(least, 0.1) << "25 times less";
  EXPECT_LE(changes, 1) << "believed and withdrawn in turn";
}

TEST(NoiseScale, RisesWithinAMinuteOfScans) {
  const NoiseScale scale = NoisyDrive(4.0, 4.0).learn(60);
  EXPECT_GT(scale.observations(), 2.5);
  EXPECT_GT(scale.odometry(), 1.35);
}

/// Three pairs that are metres off in one scan, as where the vehicle is not where it is believed to be. The drive would be solved
/// again with 25 times the noise.
TEST(NoiseScale, BelievesNoSingleScanOfThreePairs) {
  NoiseScale scale;
  RelativeGeometry geometry(core::JointGaussian{{}, {}, {}, Eigen::MatrixXd::Identity(3, 3)});
  geometry.points_m = {{8, 0}, {4, 7}, {-4, 7}};
  geometry.ids = {0, 1, 2};
  geometry.covariance_m2 = 1e-4 * Eigen::MatrixXd::Identity(6, 6);
  const std::vector<Eigen::Vector2d> off_m = {{2.0, 1.0}, {-1.5, 2.0}, {0.5, -3.0}};
  std::vector<SeenPoint> seen;
  std::vector<PointPair> pairs;
  for (std::size_t i = 0; i < off_m.size(); ++i) {
    seen.push_back({static_cast<int>(i), geometry.points_m[i] + off_m[i], 0.01 * Eigen::Matrix2d::Identity()});
    pairs.push_back({i, i});
  }
  const Eigen::Matrix3d Q = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
  scale.observe(PairEquations(geometry, seen, pairs, Eigen::Vector3d::Zero()), std::vector<Look>(3), 0.0, Q);
  EXPECT_EQ(scale.observations(), 1.0);
}

TEST(NoiseScale, TakesABiasForNoNoise) {
  const NoiseScale scale = NoisyDrive(1.0, 1.0, {0.2, 0.0, 0.0}).learn(1500);
  EXPECT_LT(scale.odometry(), 1.6) << "two deviations of forward motion too much in every scan";
  EXPECT_EQ(scale.observations(), 1.0);
}

TEST(NoiseScale, IsBounded) {
  const NoiseScale scale = NoisyDrive(1.0, 400.0).learn(1000);
  EXPECT_EQ(scale.observations(), 25.0);
}

}  // namespace
}  // namespace helixnav::supervisor
