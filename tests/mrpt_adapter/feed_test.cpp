// SPDX-License-Identifier: BSD-3-Clause
//
// Which motion goes with which scan, however they arrive; and input that cannot be used.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationOdometry.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/mrpt_adapter/conversions.hpp"
#include "quiet_builder.hpp"

namespace helixnav::mrpt_adapter {
namespace {

using mrpt::obs::CObservationOdometry;
using testing::action_of;
using testing::CActionCollection;
using testing::CSensoryFrame;
using testing::frame_of;
using testing::observation_of;
using testing::QuietBuilder;

core::Scan scan_at(core::Nanoseconds t_ns, const core::Pose2& truth) {
  core::Scan scan;
  scan.t_ns = t_ns;
  scan.field_of_view = {0.0, 20.0, -core::pi, core::pi};
  for (const Eigen::Vector2d& landmark_m : {Eigen::Vector2d(5.0, 2.0), Eigen::Vector2d(8.0, -3.0)}) {
    const Eigen::Vector2d p = core::transform(core::inverse(truth), landmark_m);
    scan.observations.push_back(core::make_range_bearing(p.norm(), std::atan2(p.y(), p.x()), 0.1, 0.01));
  }
  return scan;
}

core::Odometry forward(double x_m) {
  core::Odometry odometry;
  odometry.T_before_after = core::Pose2(x_m, 0.0, 0.0);
  odometry.covariance = Eigen::Vector3d(0.01, 0.01, 0.001).asDiagonal();
  return odometry;
}

std::shared_ptr<CObservationOdometry> reading(core::Nanoseconds t_ns, double x_m) {
  auto observation = std::make_shared<CObservationOdometry>();
  observation->timestamp = testing::stamp(t_ns);
  observation->odometry = mrpt::poses::CPose2D(x_m, 0.0, 0.0);
  return observation;
}

void process(MapBuilder& builder, const CActionCollection& actions, const CSensoryFrame& frame) {
  CActionCollection its_actions = actions;
  CSensoryFrame its_frame = frame;
  builder.processActionObservation(its_actions, its_frame);
}

void expect_same(const MapBuilder& a, const MapBuilder& b) {
  EXPECT_EQ(RunAccess::pose(a).mean.vector(), RunAccess::pose(b).mean.vector());
  EXPECT_EQ(RunAccess::pose(a).covariance, RunAccess::pose(b).covariance);
  EXPECT_EQ(RunAccess::map(a).size(), RunAccess::map(b).size());
}

TEST(Feed, ReadingsOfOdometryInAStreamAreTheIncrementsBetweenThem) {
  QuietBuilder by_actions, by_readings, by_frames;
  CSensoryFrame first = frame_of(scan_at(0, {}));
  process(by_actions, {}, first);
  by_readings.processObservation(reading(0, 7.0));
  by_readings.processObservation(first.getObservationByIndex(0));
  first.insert(reading(0, 7.0));
  process(by_frames, {}, first);
  for (int k = 1; k <= 5; ++k) {
    const auto increment = increment_between({7.0 + k - 1.0, 0.0, 0.0}, {7.0 + k, 0.0, 0.0}, {});
    CSensoryFrame frame = frame_of(scan_at(k * 1000, {1.0 * k, 0.0, 0.0}));
    process(by_actions, action_of(increment), frame);
    by_readings.processObservation(reading(k * 1000, 7.0 + k));
    by_readings.processObservation(frame.getObservationByIndex(0));
    frame.insert(reading(k * 1000 - 100, 7.0 + k));  // comes after the scan, was read before it
    process(by_frames, {}, frame);
  }
  EXPECT_NEAR(RunAccess::pose(by_actions).mean.x_m, 5.0, 1e-3);
  expect_same(by_actions, by_readings);
  expect_same(by_actions, by_frames);
}

TEST(Feed, MotionStatedByActionsIsNotCountedAgainFromReadings) {
  QuietBuilder plain, both;
  for (int k = 0; k <= 3; ++k) {
    CSensoryFrame frame = frame_of(scan_at(k * 1000, {1.0 * k, 0.0, 0.0}));
    const CActionCollection actions = k == 0 ? CActionCollection() : action_of(forward(1.0));
    process(plain, actions, frame);
    frame.insert(reading(k * 1000, k));
    process(both, actions, frame);
  }
  expect_same(plain, both);
}

TEST(Feed, WithoutAnyWordOnMotionItIsUnknownButNotBeforeTheFirstScan) {
  MapBuilderOptions options;
  options.stdXY_no_odo = 0.5;
  QuietBuilder frames(options), stream(options);
  for (int k = 0; k < 2; ++k) {
    core::Scan nothing = scan_at(k * 1000, {});
    nothing.observations.clear();
    process(frames, {}, frame_of(nothing));
    stream.processObservation(observation_of(nothing));
    EXPECT_DOUBLE_EQ(RunAccess::pose(frames).covariance(0, 0), 0.25 * k);
    expect_same(frames, stream);
  }
}

TEST(Feed, ActionsAreNotBelievedWhenOdometryIsToBeIgnored) {
  MapBuilderOptions options;
  options.force_ignore_odometry = true;
  QuietBuilder given(options), not_given(options);
  for (int k = 0; k < 3; ++k) {
    CSensoryFrame frame = frame_of(scan_at(k * 1000, {0.02 * k, 0.0, 0.0}));
    process(not_given, {}, frame);
    frame.insert(reading(k * 1000, k));
    process(given, action_of(forward(5.0)), frame);
  }
  expect_same(given, not_given);
}

TEST(Feed, AReadingThatComesTooLateIsPassedOver) {
  QuietBuilder builder;
  builder.processObservation(reading(2000, 1.0));
  builder.processObservation(reading(1000, 0.5));
  builder.processObservation(reading(3000, 2.0));
  builder.processObservation(observation_of(scan_at(3000, {1.0, 0.0, 0.0})));
  EXPECT_DOUBLE_EQ(RunAccess::pose(builder).mean.x_m, 1.0);
  EXPECT_NE(builder.said().find("passed over"), std::string::npos);
}

TEST(Feed, NamesOfLandmarksAreTheirNumbersOutside) {
  QuietBuilder builder;
  process(builder, {}, frame_of(scan_at(0, {}), {40, 30}));
  process(builder, action_of(forward(1.0)), frame_of(scan_at(1000, {1.0, 0.0, 0.0}), {40, -1}));
  const DataAssociation last = builder.getLastDataAssociation();
  ASSERT_EQ(last.pairings.size(), 2u);
  EXPECT_EQ(last.pairings[0].outcome, DataAssociation::Outcome::matched);
  EXPECT_EQ(last.pairings[0].landmark, 40);
  EXPECT_EQ(last.pairings[1].outcome, DataAssociation::Outcome::rejected);
  EXPECT_EQ(RunAccess::map(builder).size(), 2u);
  EXPECT_NE(builder.said().find("without one are passed over"), std::string::npos);
}

TEST(Feed, NamesMayBeIgnoredAndDoNotComeInLater) {
  MapBuilderOptions options;
  options.use_landmark_ids = false;
  QuietBuilder ignoring(options), unnamed, late;
  for (int k = 0; k < 4; ++k) {
    const core::Scan scan = scan_at(k * 1000, {1.0 * k, 0.0, 0.0});
    const CActionCollection actions = k == 0 ? CActionCollection() : action_of(forward(1.0));
    process(ignoring, actions, frame_of(scan, {1, 2}));
    process(unnamed, actions, frame_of(scan));
    process(late, actions, k == 0 ? frame_of(scan) : frame_of(scan, {1, 2}));
  }
  expect_same(ignoring, unnamed);
  expect_same(late, unnamed);
  EXPECT_NE(late.said().find("later IDs are passed over"), std::string::npos);
}

TEST(Feed, GpsPullsThePoseToTheFixWhenItIsToBeUsed) {
  MapBuilderOptions options;
  options.gps_use = true;
  options.gps_latitude_deg = 36.0;
  options.gps_longitude_deg = -4.0;
  options.gps_std_xy = 0.1;
  for (const bool use : {true, false}) {
    options.gps_use = use;
    QuietBuilder builder(options);
    process(builder, {}, frame_of(scan_at(0, {})));
    auto gps = std::make_shared<mrpt::obs::CObservationGPS>();
    mrpt::obs::gnss::Message_NMEA_GGA gga;
    gga.fields.fix_quality = 4;
    gga.fields.latitude_degrees = 36.0 + 0.000009;  // 1.0 m to the north
    gga.fields.longitude_degrees = -4.0;
    gps->setMsg(gga);
    core::Odometry move = forward(0.0);
    move.covariance = Eigen::Matrix3d::Identity();
    CSensoryFrame frame;
    frame.insert(gps);
    process(builder, action_of(move), frame);
    EXPECT_NEAR(RunAccess::pose(builder).mean.y_m, use ? 0.989 : 0.0, 0.005);
    EXPECT_TRUE(RunAccess::last_steps(builder).empty());
  }
}

TEST(Feed, AFrameThatCannotBeUsedChangesNothing) {
  QuietBuilder builder, undisturbed;
  process(builder, {}, frame_of(scan_at(0, {})));
  process(undisturbed, {}, frame_of(scan_at(0, {})));
  CSensoryFrame tilted = frame_of(scan_at(1000, {1.0, 0.0, 0.0}));
  auto second = observation_of(scan_at(1000, {1.0, 0.0, 0.0}));
  second->sensorLocationOnRobot = mrpt::poses::CPose3D(0.0, 0.0, 0.0, 0.0, 0.5, 0.0);
  tilted.insert(second);
  tilted.insert(reading(500, 3.0));
  EXPECT_THROW(process(builder, action_of(forward(1.0)), tilted), core::InputError);
  core::Odometry broken = forward(std::numeric_limits<double>::infinity());
  EXPECT_THROW(process(builder, action_of(broken), frame_of(scan_at(1000, {}))), core::InputError);
  EXPECT_THROW(builder.processObservation(nullptr), core::PreconditionError);
  builder.enableMapUpdating(false);
  EXPECT_THROW(process(builder, {}, frame_of(scan_at(0, {}))), core::PreconditionError);
  builder.enableMapUpdating(true);
  for (MapBuilder* one : {static_cast<MapBuilder*>(&builder), static_cast<MapBuilder*>(&undisturbed)}) {
    process(*one, action_of(forward(1.0)), frame_of(scan_at(1000, {1.0, 0.0, 0.0})));
  }
  expect_same(builder, undisturbed);
}

TEST(Feed, FramesWithNothingToSeeAndObservationsWithoutATimeAreFine) {
  QuietBuilder builder;
  process(builder, action_of(forward(1.0)), {});
  EXPECT_TRUE(RunAccess::last_steps(builder).empty());
  EXPECT_EQ(builder.getLastDataAssociation().step, -1);
  auto timeless = observation_of(scan_at(0, {1.0, 0.0, 0.0}));
  timeless->timestamp = INVALID_TIMESTAMP;
  builder.processObservation(timeless);
  EXPECT_EQ(RunAccess::map(builder).size(), 2u);
  EXPECT_DOUBLE_EQ(RunAccess::pose(builder).mean.x_m, 1.0);
}

TEST(Feed, WithoutTimesEveryObservationOfAStreamIsAnInstantOfItsOwn) {
  QuietBuilder builder;
  for (int k = 0; k < 3; ++k) {
    core::Scan nothing;
    nothing.t_ns = 5000;
    auto observation = observation_of(nothing);
    if (k > 0) observation->timestamp = INVALID_TIMESTAMP;
    builder.processObservation(observation);
    EXPECT_EQ(RunAccess::last_steps(builder).back().report.t_ns, 5000);
    EXPECT_NEAR(RunAccess::pose(builder).covariance(0, 0), 0.01 * k, 1e-4);
  }
  EXPECT_NE(builder.said().find("no time stamp"), std::string::npos);
}

TEST(Feed, TwoSensorsAtOneInstantAreNoMotion) {
  QuietBuilder builder;
  for (int k = 0; k < 3; ++k) builder.processObservation(observation_of(scan_at(1000, {})));
  core::Scan late = scan_at(500, {});
  EXPECT_EQ(RunAccess::pose(builder).covariance.trace(), 0.0);
  builder.processObservation(observation_of(late));
  EXPECT_NE(builder.said().find("older than the last one"), std::string::npos);
}

TEST(Initialize, StartsAfreshAtThePoseGiven) {
  QuietBuilder builder;
  process(builder, {}, frame_of(scan_at(0, {})));
  mrpt::math::CMatrixDouble33 covariance = testing::matrix(Eigen::Vector3d(0.5, 0.25, 0.125).asDiagonal());
  const mrpt::poses::CPosePDFGaussian x0(mrpt::poses::CPose2D(3.0, 4.0, 0.5), covariance);
  builder.initialize({}, &x0);
  EXPECT_EQ(RunAccess::pose(builder).mean.x_m, 3.0);
  EXPECT_EQ(RunAccess::pose(builder).covariance(1, 1), 0.25);
  EXPECT_TRUE(RunAccess::map(builder).empty());
  EXPECT_EQ(builder.getCurrentlyBuiltMapSize(), 0u);
  builder.clear();
  EXPECT_EQ(RunAccess::pose(builder).mean.x_m, 0.0);
  covariance(0, 0) = -1.0;
  const mrpt::poses::CPosePDFGaussian none(mrpt::poses::CPose2D(), covariance);
  EXPECT_THROW(builder.initialize({}, &none), core::InputError);
}

TEST(Initialize, RefusesAPastMap) {
  QuietBuilder builder;
  process(builder, {}, frame_of(scan_at(0, {})));
  mrpt::maps::CSimpleMap past;
  builder.getCurrentlyBuiltMap(past);
  ASSERT_EQ(past.size(), 1u);
  EXPECT_THROW(builder.initialize(past), core::InputError);
  EXPECT_EQ(builder.getCurrentlyBuiltMapSize(), 1u);
}

}  // namespace
}  // namespace helixnav::mrpt_adapter
