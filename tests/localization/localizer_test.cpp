// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/localization/localizer.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "campaign.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/sim/simulate.hpp"

namespace helixnav::localization {
namespace {

using core::Outcome;

sim::Scenario circuit() {
  sim::Scenario scenario = sim::named_scenario("circuit");
  scenario.scanner.clutter_per_scan = 0.5;
  return scenario;
}

/// The true map; each landmark is named by its label.
std::vector<core::MapLandmark> map_of(const core::Recording& run) {
  std::vector<core::MapLandmark> map;
  for (const core::TrueLandmark& landmark : run.true_landmarks) {
    core::MapLandmark& known = map.emplace_back();
    known.id = static_cast<core::LandmarkId>(landmark.label);
    known.point.mean_m = landmark.point_m;
  }
  return map;
}

std::vector<core::LandmarkId> names_of(const std::vector<core::Label>& labels) {
  return {labels.begin(), labels.end()};
}

struct Driven {
  std::vector<core::StepReport> reports;
  double last_nees = 0.0;
};

Driven drive(const core::Recording& run, bool known_association) {
  Localizer localizer(run.start, map_of(run));
  Driven driven;
  for (const core::Event& event : run.events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) localizer.move(*odometry);
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    const std::size_t i = driven.reports.size();
    driven.reports.push_back(known_association ? localizer.observe(*scan, names_of(run.labels[i]))
                                               : localizer.observe(*scan));
  }
  const core::PoseGaussian pose = localizer.pose();
  Eigen::Vector3d error = pose.mean.vector() - run.true_poses[driven.reports.size() - 1].T_world_robot.vector();
  error[2] = core::wrap_to_pi(error[2]);
  driven.last_nees = error.dot(pose.covariance.ldlt().solve(error));
  return driven;
}

// 30 worlds, each with its own band: NEES of the last pose (3 rows each) and NIS of all updates. Each sum leaves its
// band with probability 0.002. With exact linear models both are exact; the seeds were not used in development.
TEST(LocalizerCampaign, IsConsistentOnTheTrueMap) {
  double nees = 0.0;
  double nis = 0.0;
  int rows = 0;
  const std::vector<std::uint64_t> seeds = support::campaign_seeds(101, 30);
  for (const std::uint64_t seed : seeds) {
    const Driven driven = drive(sim::simulate(circuit(), seed), true);
    nees += driven.last_nees;
    for (const core::StepReport& report : driven.reports) {
      nis += report.joint_nis;
      rows += report.joint_dof;
    }
  }
  const support::Band band = support::chi2_band(static_cast<int>(seeds.size()), 3, 0.002);
  EXPECT_GT(nees, band.low);
  EXPECT_LT(nees, band.high);
  EXPECT_GT(nis, core::chi2_quantile(0.001, rows));
  EXPECT_LT(nis, core::chi2_quantile(0.999, rows));
}

TEST(Localizer, FindsTheAssociationsItselfAndRejectsClutter) {
  std::size_t right = 0;
  std::size_t wrong = 0;
  std::size_t of_map = 0;
  for (std::uint64_t seed = 201; seed < 206; ++seed) {
    const core::Recording run = sim::simulate(circuit(), seed);
    const Driven driven = drive(run, false);
    for (std::size_t k = 0; k < driven.reports.size(); ++k) {
      for (const core::AssociationReport& a : driven.reports[k].associations) {
        const core::Label label = run.labels[k][static_cast<std::size_t>(a.observation)];
        EXPECT_NE(a.outcome, Outcome::augmented) << "the map is given";
        of_map += label != core::no_label;
        if (a.outcome == Outcome::matched) ++(a.landmark == label ? right : wrong);
      }
    }
  }
  ASSERT_GT(of_map, 500u);
  EXPECT_GT(static_cast<double>(right), 0.98 * static_cast<double>(of_map));
  EXPECT_LT(static_cast<double>(wrong), 0.01 * static_cast<double>(right));
}

/// A pose that is known to some degree, three landmarks, one observation of each kind that fixes something.
class OneScan : public ::testing::Test {
 protected:
  OneScan() {
    start_.mean = {2.0, -1.0, 3.1};
    start_.covariance << 0.5, 0.1, 0.02, 0.1, 0.3, -0.03, 0.02, -0.03, 0.04;
    const std::vector<Eigen::Vector2d> points{{-8.0, 1.0}, {0.0, 6.0}, {5.0, -7.0}, {-3.0, -9.0}};
    for (std::size_t i = 0; i < points.size(); ++i) {
      map_.emplace_back();
      map_.back().id = static_cast<core::LandmarkId>(10 + i);
      map_.back().point.mean_m = points[i];
    }
    scan_.T_robot_sensor = {1.0, 0.3, -0.2};
    const core::Pose2 truth(2.3, -1.4, -3.1);
    const std::vector<core::Observation> forms{core::make_range_bearing(1.0, 0.0, 0.2, 0.02),
                                               core::make_cartesian({0.0, 0.0}, 0.1 * Eigen::Matrix2d::Identity()),
                                               core::make_bearing(0.0, 0.05), core::make_range(1.0, 0.3)};
    for (std::size_t i = 0; i < forms.size(); ++i) {
      scan_.observations.push_back(forms[i]);
      scan_.observations[i].z = core::predict_observation(forms[i].kind, truth, scan_.T_robot_sensor, points[i]).z_hat;
    }
  }

  core::PoseGaussian start_;
  std::vector<core::MapLandmark> map_;
  core::Scan scan_;
};

TEST_F(OneScan, UpdatesThePoseAsTheInformationFormDoes) {
  Eigen::Matrix3d information = start_.covariance.inverse();
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < scan_.observations.size(); ++i) {
    const core::Observation& o = scan_.observations[i];
    const auto p = core::predict_observation(o.kind, start_.mean, scan_.T_robot_sensor, map_[i].point.mean_m);
    const Eigen::MatrixXd W = Eigen::MatrixXd(o.R).inverse();
    const Eigen::VectorXd nu = core::innovation(o.kind, o.z, p.z_hat);
    information += p.H_pose.transpose() * W * p.H_pose;
    pull += p.H_pose.transpose() * W * nu;
  }
  const Eigen::Matrix3d P = information.inverse();
  const core::Pose2 expected(start_.mean.vector() + P * pull);

  Localizer localizer(start_, map_);
  const core::StepReport report = localizer.observe(scan_, {10, 11, 12, 13});
  EXPECT_EQ(report.joint_dof, 6);
  EXPECT_LT((report.pose.mean.vector() - expected.vector()).norm(), 1e-10);
  EXPECT_LT((report.pose.covariance - P).norm(), 1e-10);
  EXPECT_EQ(report.step, 0);
  EXPECT_EQ(localizer.observe(scan_, {10, 11, 12, 13}).step, 1);
}

TEST_F(OneScan, PredictsWithTheOdometryBeforeIt) {
  core::Odometry motion;
  motion.T_before_after = {1.0, 0.2, 0.1};
  motion.covariance = 0.01 * Eigen::Matrix3d::Identity();
  Localizer localizer(start_, map_);
  localizer.move(motion);
  scan_.observations.clear();
  const core::StepReport report = localizer.observe(scan_);
  const core::ComposeJacobians J = core::compose_jacobians(start_.mean, motion.T_before_after);
  EXPECT_EQ(report.joint_dof, 0);
  EXPECT_LT((report.pose.mean.vector() - core::compose(start_.mean, motion.T_before_after).vector()).norm(), 1e-15);
  EXPECT_LT((report.pose.covariance - J.J_first * start_.covariance * J.J_first.transpose() -
             J.J_second * motion.covariance * J.J_second.transpose())
                .norm(),
            1e-14);
}

TEST_F(OneScan, StaysAsItWasWhenACallIsRefused) {
  Localizer localizer(start_, map_);
  EXPECT_THROW(localizer.observe(scan_, {10, 11, 12}), core::PreconditionError);
  EXPECT_THROW(localizer.observe(scan_, {10, 11, 12, 99}), core::PreconditionError);
  core::Scan bad = scan_;
  bad.observations[1].z[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(localizer.observe(bad, {10, 11, 12, 13}), core::PreconditionError);
  EXPECT_EQ(localizer.pose().mean.vector(), start_.mean.vector());
  EXPECT_EQ(localizer.pose().covariance, start_.covariance);
}

TEST_F(OneScan, StaysAsItWasWhenALandmarkStandsAtTheSensor) {
  map_[1].point.mean_m = core::transform(start_.mean, scan_.T_robot_sensor.position_m());  // at the sensor itself
  scan_.observations[1] = core::make_bearing(0.1, 0.1);
  Localizer localizer(start_, map_);
  EXPECT_THROW(localizer.observe(scan_, {10, 11, 12, 13}), core::NumericalError);
  EXPECT_EQ(localizer.pose().covariance, start_.covariance);
}

TEST_F(OneScan, RefusesAMapWithALandmarkTwice) {
  map_.push_back(map_.front());
  EXPECT_THROW(Localizer(start_, map_), core::PreconditionError);
  map_.back().id = 77;
  map_.back().point.mean_m.x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(Localizer(start_, map_), core::PreconditionError);
  start_.covariance(0, 0) = -1.0;
  EXPECT_THROW(Localizer(start_, {}), core::PreconditionError);
}

}  // namespace
}  // namespace helixnav::localization
