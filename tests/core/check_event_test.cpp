// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/check_event.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"

namespace helixnav::core {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

Odometry good_odometry() {
  Odometry odometry;
  odometry.t_ns = 42;
  odometry.T_before_after = Pose2(0.3, 0.0, 0.01);
  odometry.covariance = Eigen::Vector3d(1e-3, 0.0, 1e-5).asDiagonal();
  return odometry;
}

Scan good_scan() {
  Scan scan;
  scan.t_ns = 42;
  scan.field_of_view = {0.1, 30.0, -1.0, 1.0};
  scan.observations = {make_range_bearing(5.0, 0.2, 0.1, 0.01),
                       make_cartesian({3.0, 1.0}, Eigen::Matrix2d::Identity())};
  return scan;
}

void expect_refused(const Event& event, const std::string& named) {
  try {
    check(event);
    ADD_FAILURE() << "accepted: " << named;
  } catch (const PreconditionError& error) {
    EXPECT_NE(std::string(error.what()).find(named), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("t_ns = 42"), std::string::npos) << error.what();
  }
}

TEST(CheckEvent, AcceptsWhatSensorsSay) {
  EXPECT_NO_THROW(check(Event(good_odometry())));
  EXPECT_NO_THROW(check(Event(good_scan())));
  EXPECT_NO_THROW(check(Event(AbsoluteFix{})));
  Scan blank = good_scan();
  blank.observations.clear();
  blank.field_of_view = FieldOfView{};
  EXPECT_NO_THROW(check(blank)) << "a view without bound";
  blank.field_of_view.max_range_m = 0.0;
  EXPECT_NO_THROW(check(blank)) << "a view that nobody knows";
}

TEST(CheckEvent, AcceptsACovarianceOfRankOneToThree) {
  Odometry odometry = good_odometry();
  odometry.covariance.setZero();
  EXPECT_NO_THROW(check(odometry));
  for (int rank = 1; rank <= 3; ++rank) {
    Eigen::Matrix3d L = Eigen::Matrix3d::Zero();
    for (int k = 0; k < rank; ++k) L.col(k) = Eigen::Vector3d(0.1 + k, 0.37 * k * k - 0.2, 0.01 * (k + 1));
    odometry.covariance = L * L.transpose();
    EXPECT_NO_THROW(check(odometry)) << rank;
  }
}

TEST(CheckEvent, RefusesWhatIsBeyondAnyVehicle) {
  for (const double wrong : {1.1e8, 1e100, 1e160, 1e300}) {
    SCOPED_TRACE(wrong);
    Odometry odometry = good_odometry();
    odometry.T_before_after.x_m = -wrong;
    expect_refused(odometry, "increment");
    odometry = good_odometry();
    odometry.covariance(0, 0) = wrong * wrong;
    expect_refused(odometry, "covariance");
    Scan scan = good_scan();
    scan.T_robot_sensor.x_m = wrong;
    expect_refused(scan, "T_robot_sensor");
    scan = good_scan();
    scan.observations[1].z[0] = wrong;
    expect_refused(scan, "observation 1");
    scan = good_scan();
    scan.observations[0].R(0, 0) = wrong * wrong;
    expect_refused(scan, "observation 0");
    AbsoluteFix fix;
    fix.t_ns = 42;
    fix.position_world_m.y() = wrong;
    expect_refused(fix, "position");
  }
  Odometry odometry = good_odometry();
  odometry.T_before_after.heading_rad = 1e7;
  expect_refused(odometry, "increment");
}

TEST(CheckEvent, AcceptsCoordinatesOfAGridAndWhatNobodyKnows) {
  AbsoluteFix fix;
  fix.position_world_m = {5e5, 9.9e6};
  EXPECT_NO_THROW(check(fix));
  Odometry odometry = good_odometry();
  odometry.covariance = Eigen::Vector3d(1e12, 1e12, 10.0).asDiagonal();
  EXPECT_NO_THROW(check(odometry));
}

TEST(CheckEvent, RefusesOdometryThatIsNotFiniteOrHasNoCovariance) {
  for (const double wrong : {not_a_number, infinite, -infinite}) {
    Odometry odometry = good_odometry();
    odometry.T_before_after.y_m = wrong;
    expect_refused(odometry, "increment");
    odometry = good_odometry();
    odometry.T_before_after.heading_rad = wrong;
    expect_refused(odometry, "increment");
    odometry = good_odometry();
    odometry.covariance(1, 2) = wrong;
    expect_refused(odometry, "covariance");
  }
  Odometry odometry = good_odometry();
  odometry.covariance(2, 2) = -1e-5;
  expect_refused(odometry, "covariance");
  odometry = good_odometry();
  odometry.covariance(0, 2) = odometry.covariance(2, 0) = 1e-3;  // correlation of 10
  expect_refused(odometry, "covariance");
  odometry = good_odometry();
  odometry.covariance(0, 2) = 1e-6;
  expect_refused(odometry, "covariance");
}

TEST(CheckEvent, RefusesAScanByTheFirstObservationThatIsNone) {
  Scan scan = good_scan();
  scan.observations.push_back(make_range_bearing(-0.5, 0.0, 0.1, 0.01));
  expect_refused(scan, "observation 2");
  scan = good_scan();
  scan.observations[1].z[0] = not_a_number;
  expect_refused(scan, "observation 1");
  scan = good_scan();
  scan.observations[0].z[1] = 6.4;
  expect_refused(scan, "2π");
  scan.observations[0] = make_bearing(-6.4, 0.1);
  expect_refused(scan, "2π");
  scan.observations[0] = make_bearing(-6.2, 0.1);
  EXPECT_NO_THROW(check(scan));
  scan.observations[0].R(0, 0) = 0.0;
  expect_refused(scan, "positive definite");
}

TEST(CheckEvent, RefusesAMountingOrAViewThatIsNotFiniteOrNotInOrder) {
  Scan scan = good_scan();
  scan.T_robot_sensor.x_m = not_a_number;
  expect_refused(scan, "T_robot_sensor");
  const std::vector<FieldOfView> wrong = {
      {not_a_number, 30.0, -1.0, 1.0}, {-1.0, 30.0, -1.0, 1.0},     {0.0, not_a_number, -1.0, 1.0},
      {5.0, 4.0, -1.0, 1.0},           {0.0, 30.0, 1.0, -1.0},      {0.0, 30.0, not_a_number, 1.0},
      {0.0, -1.0, -1.0, 1.0},          {infinite, 30.0, -1.0, 1.0}, {0.0, 30.0, -1.0, infinite}};
  for (const FieldOfView& view : wrong) {
    scan = good_scan();
    scan.field_of_view = view;
    expect_refused(scan, "field of view");
  }
}

TEST(CheckEvent, RefusesAFixThatIsNotFiniteOrExactlyKnown) {
  AbsoluteFix fix;
  fix.t_ns = 42;
  fix.position_world_m.x() = infinite;
  expect_refused(fix, "position");
  fix = {};
  fix.t_ns = 42;
  fix.antenna_robot_m.y() = not_a_number;
  expect_refused(fix, "antenna");
  fix = {};
  fix.t_ns = 42;
  fix.covariance_m2.setZero();
  expect_refused(fix, "covariance");
  fix.covariance_m2 << 1.0, 2.0, 2.0, 1.0;
  expect_refused(fix, "covariance");
}

TEST(CheckStart, HoldsAPoseToTheLimitsOfEvents) {
  PoseGaussian start;
  start.mean = {1e8, -1e8, 1e6};
  start.covariance = Eigen::Vector3d(1e16, 1e16, 0.0).asDiagonal();
  EXPECT_NO_THROW(check_start(start));
  const auto expect_no_start = [](const PoseGaussian& given) { EXPECT_THROW(check_start(given), PreconditionError); };
  for (const double garbage : {1.1e8, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
    PoseGaussian far;
    far.mean.x_m = garbage;
    expect_no_start(far);
    far = {};
    far.covariance(1, 1) = garbage * garbage;
    expect_no_start(far);
  }
  start.covariance(0, 1) = 1e15;
  expect_no_start(start);
}

TEST(CheckOrder, RefusesToGoBackAndAcceptsTheSameInstant) {
  EXPECT_NO_THROW(check_order(5, 5));
  EXPECT_NO_THROW(check_order(std::numeric_limits<Nanoseconds>::min(), 5));
  EXPECT_THROW(check_order(5, 4), PreconditionError);
}

}  // namespace
}  // namespace helixnav::core
