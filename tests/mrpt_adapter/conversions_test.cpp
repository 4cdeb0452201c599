// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/mrpt_adapter/conversions.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationOdometry.h>

#include "frames.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/logs/detect_reflectors.hpp"
#include "helixnav/logs/detect_trees.hpp"

namespace helixnav::mrpt_adapter {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

using mrpt::obs::CObservationBearingRange;

CObservationBearingRange::TMeasurement measurement(float range, float yaw, float pitch = 0.0F, int name = -1) {
  CObservationBearingRange::TMeasurement measured;
  measured.range = range;
  measured.yaw = yaw;
  measured.pitch = pitch;
  measured.landmarkID = name;
  measured.covariance.setIdentity();
  return measured;
}

TEST(BearingRange, CovarianceOfEachMeasurementAndPoseOfTheSensorAreHonoured) {
  CObservationBearingRange observation;
  observation.timestamp = testing::stamp(1'500'000'000'123'456'700);
  observation.sensorLocationOnRobot = mrpt::poses::CPose3D(1.5, -0.5, 0.8, 0.3, 0.0, 0.0);
  observation.validCovariances = true;
  observation.sensor_std_range = observation.sensor_std_yaw = 9.0F;
  observation.minSensorDistance = 0.5F;
  observation.maxSensorDistance = 20.0F;
  observation.fieldOfView_yaw = 2.0F;
  observation.sensedData = {measurement(4.0F, 0.25F, 0.0F, 7), measurement(5.0F, 4.0F)};
  observation.sensedData[0].covariance(0, 0) = 0.04;
  observation.sensedData[0].covariance(1, 1) = 0.01;
  observation.sensedData[0].covariance(0, 1) = observation.sensedData[0].covariance(1, 0) = -0.005;
  MapBuilderOptions options;
  options.std_sensor_range = 3.0;  // ignored
  const NamedScan seen = scan_of(observation, options);
  EXPECT_EQ(seen.scan.t_ns, 1'500'000'000'123'456'700);
  EXPECT_DOUBLE_EQ(seen.scan.T_robot_sensor.y_m, -0.5);
  EXPECT_NEAR(seen.scan.T_robot_sensor.heading_rad, 0.3, 1e-12);
  EXPECT_DOUBLE_EQ(seen.scan.field_of_view.max_bearing_rad, 1.0);
  EXPECT_DOUBLE_EQ(seen.scan.field_of_view.max_range_m, 20.0);
  ASSERT_EQ(seen.scan.observations.size(), 2u);
  EXPECT_DOUBLE_EQ(seen.scan.observations[0].R(0, 1), -0.005);
  EXPECT_DOUBLE_EQ(seen.scan.observations[0].R(1, 1), 0.01);
  EXPECT_DOUBLE_EQ(seen.scan.observations[1].z(1), 4.0 - 2.0 * core::pi);
  EXPECT_EQ(seen.identities, (std::vector<std::int64_t>{7, -1}));
}

TEST(BearingRange, NoiseComesFromTheOptionsBeforeTheObservationAndIsNeverZero) {
  CObservationBearingRange observation;
  observation.sensedData = {measurement(4.0F, 0.0F)};
  MapBuilderOptions options;
  EXPECT_THROW(scan_of(observation, options), core::InputError);
  observation.sensor_std_range = 0.5F;
  observation.sensor_std_yaw = 0.25F;
  EXPECT_DOUBLE_EQ(scan_of(observation, options).scan.observations[0].R(0, 0), 0.25);
  options.std_sensor_range = 0.125;
  EXPECT_DOUBLE_EQ(scan_of(observation, options).scan.observations[0].R(0, 0), 0.125 * 0.125);
  EXPECT_DOUBLE_EQ(scan_of(observation, options).scan.observations[0].R(1, 1), 0.0625);
}

TEST(BearingRange, FullCircleHasNoEdge) {
  CObservationBearingRange observation;
  observation.fieldOfView_yaw = static_cast<float>(2.0 * core::pi);
  const core::FieldOfView view = scan_of(observation, {}).scan.field_of_view;
  EXPECT_EQ(view.max_bearing_rad, core::pi);
  EXPECT_EQ(view.min_bearing_rad, -core::pi);
  EXPECT_TRUE(std::isinf(view.max_range_m));
}

TEST(BearingRange, PitchIsProjectedWithItsUncertainty) {
  CObservationBearingRange observation;
  observation.validCovariances = true;
  observation.sensedData = {measurement(10.0F, 0.5F, 0.4F)};
  const double r = 10.0, pitch = 0.4F;
  observation.sensedData[0].covariance = testing::matrix(Eigen::Vector3d(0.01, 0.02, 0.0025).asDiagonal());
  const core::Observation seen = scan_of(observation, {}).scan.observations.at(0);
  EXPECT_NEAR(seen.z(0), r * std::cos(pitch), 1e-12);
  EXPECT_NEAR(seen.R(0, 0), 0.01 * std::pow(std::cos(pitch), 2) + 0.0025 * std::pow(r * std::sin(pitch), 2), 1e-12);
  EXPECT_NEAR(seen.R(1, 1), 0.02, 1e-12);
}

TEST(BearingRange, MeasurementsThatAreNoneAreLeftOutAndSaid) {
  CObservationBearingRange observation;
  observation.validCovariances = true;
  const auto not_a_number = std::numeric_limits<float>::quiet_NaN();
  observation.sensedData = {measurement(not_a_number, 0.0F), measurement(3.0F, not_a_number), measurement(0.0F, 0.0F),
                            measurement(-1.0F, 0.0F),        measurement(2.0F, 0.1F),         measurement(2.0F, 0.1F)};
  observation.sensedData[5].covariance(1, 1) = -1.0;
  const NamedScan seen = scan_of(observation, {});
  EXPECT_EQ(seen.measurements, (std::vector<std::size_t>{4}));
  ASSERT_EQ(seen.dropped.size(), 5u);
  EXPECT_NE(seen.dropped[4].find("measurement 5 left out: its covariance"), std::string::npos);
}

TEST(BearingRange, TiltedSensorIsRefused) {
  CObservationBearingRange observation;
  observation.sensorLocationOnRobot = mrpt::poses::CPose3D(0.0, 0.0, 1.0, 0.0, 0.2, 0.0);
  EXPECT_THROW(scan_of(observation, {}), core::InputError);
}

TEST(Movement, KeepsItsCorrelations) {
  core::Odometry odometry;
  odometry.T_before_after = core::Pose2(1.0, 0.1, 0.2);
  odometry.covariance << 0.04, 0.01, -0.002, 0.01, 0.03, 0.004, -0.002, 0.004, 0.001;
  const auto back = odometry_of(testing::action_of(odometry));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->covariance, odometry.covariance);
  EXPECT_NEAR(back->T_before_after.heading_rad, 0.2, 1e-15);
}

testing::CActionRobotMovement2D movement(double x_m, double variance) {
  testing::CActionRobotMovement2D result;
  result.poseChange = mrpt::poses::CPosePDFGaussian::Create(mrpt::poses::CPose2D(x_m, 0.0, 0.0),
                                                            testing::matrix(Eigen::Matrix3d::Identity() * variance));
  return result;
}

TEST(Movement, TheLeastUncertainCountsHoweverUncertainAndAScanMatchBeforeAll) {
  testing::CActionCollection actions;
  EXPECT_FALSE(odometry_of(actions));
  auto huge = movement(1.0, 1e3);
  actions.insert(huge);
  EXPECT_EQ(odometry_of(actions)->T_before_after.x_m, 1.0);
  auto good = movement(2.0, 0.1);
  actions.insert(good);
  EXPECT_EQ(odometry_of(actions)->T_before_after.x_m, 2.0);
  auto match = movement(3.0, 1.0);
  match.estimationMethod = testing::CActionRobotMovement2D::emScan2DMatching;
  actions.insert(match);
  EXPECT_EQ(odometry_of(actions)->T_before_after.x_m, 3.0);
}

TEST(Movement, In3DGivesItsPlanarPart) {
  mrpt::obs::CActionRobotMovement3D movement;
  movement.poseChange.mean = mrpt::poses::CPose3D(1.0, 2.0, 3.0, 0.5, 0.0, 0.0);
  for (int i = 0; i < 6; ++i) movement.poseChange.cov(i, i) = 0.1 * (i + 1);
  movement.poseChange.cov(0, 3) = movement.poseChange.cov(3, 0) = 0.05;
  testing::CActionCollection actions;
  actions.insert(movement);
  const auto planar = odometry_of(actions);
  ASSERT_TRUE(planar);
  EXPECT_EQ(planar->covariance(0, 2), 0.05);
  EXPECT_DOUBLE_EQ(planar->covariance(2, 2), 0.4);
  EXPECT_EQ(planar->T_before_after.y_m, 2.0);
}

TEST(Movement, BrokenIsRefused) {
  testing::CActionCollection actions, other;
  auto broken = movement(nan, 0.1);
  actions.insert(broken);
  EXPECT_THROW(odometry_of(actions), core::InputError);
  auto negative = movement(1.0, -0.1);
  other.insert(negative);
  EXPECT_THROW(odometry_of(other), core::InputError);
}

TEST(OdometryReadings, BecomeIncrementsInTheFrameBefore) {
  MapBuilderOptions options;
  options.odo_a1 = 0.1;
  options.odo_min_std_xy = 0.02;
  const core::Odometry moved = increment_between({1.0, 2.0, core::pi / 2.0}, {1.0, 5.0, core::pi / 2.0}, options);
  EXPECT_NEAR(moved.T_before_after.x_m, 3.0, 1e-12);
  EXPECT_NEAR(moved.T_before_after.y_m, 0.0, 1e-12);
  EXPECT_NEAR(moved.covariance(0, 0), std::pow(0.02 + 0.1 * 3.0, 2), 1e-9);
}

TEST(TimeStamps, CountFrom1970AndMayBeMissing) {
  mrpt::obs::CObservationOdometry observation;
  observation.timestamp = testing::stamp(-100);
  EXPECT_EQ(time_of(observation), -100);
  observation.timestamp = INVALID_TIMESTAMP;
  EXPECT_FALSE(time_of(observation));
  observation.timestamp = mrpt::system::TTimeStamp(mrpt::Clock::duration(std::numeric_limits<std::int64_t>::max()));
  EXPECT_FALSE(time_of(observation));
}

/// A trunk, and a reflector at another place.
logs::SickScan scene() {
  logs::SickScan scan;
  scan.range_cm.fill(8191);
  for (std::size_t beam = 100; beam < 104; ++beam) scan.range_cm[beam] = 812;
  for (std::size_t beam = 250; beam < 254; ++beam) {
    scan.range_cm[beam] = 945;
    scan.reflectivity[beam] = 2;
  }
  return scan;
}

mrpt::obs::CObservation2DRangeScan laser_of(const logs::SickScan& sick, bool counter_clockwise) {
  mrpt::obs::CObservation2DRangeScan scan;
  scan.aperture = static_cast<float>(core::pi);
  scan.rightToLeft = counter_clockwise;
  scan.setScanHasIntensity(true);
  scan.resizeScanAndAssign(361, 0.0F, false, 0);
  for (std::size_t beam = 0; beam < 361; ++beam) {
    const std::size_t ray = counter_clockwise ? beam : 360 - beam;
    scan.setScanRange(ray, static_cast<float>(sick.range_cm[beam]) / 100.0F);
    scan.setScanRangeValidity(ray, sick.range_cm[beam] < 8000);
    scan.setScanIntensity(ray, sick.reflectivity[beam]);
  }
  return scan;
}

TEST(RangeScan, GivesWhatTheDetectorsFindInTheSameScanOfASick) {
  MapBuilderOptions options;
  for (const bool counter_clockwise : {true, false}) {
    for (const bool trees : {true, false}) {
      options.detector = trees ? "trees" : "reflectors";
      const auto expected = trees ? logs::detect_trees(scene()) : logs::detect_reflectors(scene());
      ASSERT_FALSE(expected.empty());
      const NamedScan seen = scan_of(laser_of(scene(), counter_clockwise), options);
      ASSERT_EQ(seen.scan.observations.size(), expected.size());
      for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(seen.scan.observations[i].z(0), expected[i].range_m);
        EXPECT_EQ(seen.scan.observations[i].z(1), expected[i].bearing_rad);
      }
    }
  }
}

TEST(RangeScan, OfAnotherGeometryIsResampled) {
  // 270° in steps of 0.25°: ray j looks at j·0.25° − 135°.
  mrpt::obs::CObservation2DRangeScan scan;
  scan.aperture = static_cast<float>(1.5 * core::pi);
  scan.resizeScanAndAssign(1081, 0.0F, false, 0);
  for (std::size_t ray = 600; ray < 612; ++ray) {
    scan.setScanRange(ray, 6.0F);
    scan.setScanRangeValidity(ray, true);
  }
  const NamedScan seen = scan_of(scan, {});
  ASSERT_EQ(seen.scan.observations.size(), 1u);
  EXPECT_NEAR(seen.scan.observations[0].z(1), (605.5 * 0.25 - 135.0) * core::pi / 180.0, 0.006);
  scan.aperture = 0.0F;
  EXPECT_THROW(scan_of(scan, {}), core::InputError);
}

TEST(Gps, IsEastAndNorthOfItsReferenceAtTheAntenna) {
  mrpt::obs::CObservationGPS observation;
  EXPECT_FALSE(position_of(observation));
  mrpt::obs::gnss::Message_NMEA_GGA gga;
  gga.fields.latitude_degrees = 36.001;
  gga.fields.longitude_degrees = -4.0;
  gga.fields.fix_quality = 0;
  observation.setMsg(gga);
  EXPECT_FALSE(position_of(observation));
  gga.fields.fix_quality = 1;
  observation.setMsg(gga);
  observation.sensorPose = mrpt::poses::CPose3D(1.0, 0.5, 2.0, 0.0, 0.0, 0.0);
  MapBuilderOptions options;
  options.gps_std_xy = 2.0;
  const auto position = position_of(observation);
  ASSERT_TRUE(position);
  const core::AbsoluteFix fix = fix_of(observation, *position, {36.0, -4.0, 0.0}, options);
  EXPECT_NEAR(fix.position_world_m.x(), 0.0, 1e-6);
  EXPECT_NEAR(fix.position_world_m.y(), 110.97, 0.02);  // a thousandth of a degree of the meridian at 36°
  EXPECT_EQ(fix.covariance_m2(1, 1), 4.0);
  EXPECT_EQ(fix.antenna_robot_m, Eigen::Vector2d(1.0, 0.5));
}

}  // namespace
}  // namespace helixnav::mrpt_adapter
