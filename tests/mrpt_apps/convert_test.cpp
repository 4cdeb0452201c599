// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <variant>

#include <gtest/gtest.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>

#include "helixnav/core/odometry.hpp"
#include "helixnav/logs/acfr_log.hpp"
#include "helixnav/logs/dlr.hpp"
#include "helixnav/logs/vehicle.hpp"
#include "helixnav/mrpt_adapter/run_access.hpp"
#include "helixnav/supervisor/navigator.hpp"
#include "input_error.hpp"
#include "program.hpp"
#include "rawlog/observations_only.hpp"
#include "rawlog/rawlog_sink.hpp"
#include "rawlog/write_acfr.hpp"
#include "rawlog/write_recording.hpp"
#include "reading/rawlog_movement.hpp"
#include "reading/read_rawlog.hpp"
#include "real_data.hpp"
#include "slam/rawlog_source.hpp"
#include "slam/slam_feed.hpp"
#include "small_rawlogs.hpp"
#include "temporary_folder.hpp"

namespace helixnav::apps {
namespace {

using testing::input_error_of;

template <class Kind>
std::vector<Kind> all(const core::Recording& recording) {
  std::vector<Kind> found;
  for (const core::Event& event : recording.events) {
    if (const auto* one = std::get_if<Kind>(&event)) found.push_back(*one);
  }
  return found;
}

/// The increments before each scan, chained; a scan without any has a single one of no motion in a rawlog.
std::vector<core::Odometry> motions_of(const core::Recording& recording) {
  std::vector<core::Odometry> motions;
  core::Odometry motion = core::no_motion(0);
  for (const core::Event& event : recording.events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) motion = core::chain(motion, *odometry);
    if (!std::holds_alternative<core::Scan>(event)) continue;
    motions.push_back(motion);
    motion = core::no_motion(0);
  }
  return motions;
}

void expect_same_motions(const core::Recording& got, const core::Recording& expected, double tolerance) {
  const auto a = motions_of(got);
  const auto b = motions_of(expected);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_LT((a[i].T_before_after.vector() - b[i].T_before_after.vector()).norm(), tolerance) << i;
    EXPECT_LT((a[i].covariance - b[i].covariance).norm(), tolerance * b[i].covariance.norm() + 1e-18) << i;
  }
}

/// Floats carry range and bearing, doubles the covariances.
void expect_same_scans(const core::Recording& got, const core::Recording& expected) {
  const auto a = all<core::Scan>(got);
  const auto b = all<core::Scan>(expected);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].t_ns, b[i].t_ns);
    EXPECT_LT((a[i].T_robot_sensor.vector() - b[i].T_robot_sensor.vector()).norm(), 1e-12);
    EXPECT_NEAR(a[i].field_of_view.max_range_m, b[i].field_of_view.max_range_m, 1e-5);
    EXPECT_NEAR(a[i].field_of_view.max_bearing_rad, b[i].field_of_view.max_bearing_rad, 1e-6);
    ASSERT_EQ(a[i].observations.size(), b[i].observations.size());
    for (std::size_t k = 0; k < a[i].observations.size(); ++k) {
      EXPECT_LT((a[i].observations[k].z - b[i].observations[k].z).norm(), 1e-6);
      EXPECT_LT((a[i].observations[k].R - b[i].observations[k].R).norm(), 1e-15);
    }
  }
}

class Rawlogs : public testing::RealDataTest {
 protected:
  std::string file(const std::string& name) const { return folder_.path() / name; }

  testing::TemporaryFolder folder_;
};

TEST_F(Rawlogs, KeepAllButDigitsBeyondFloatOfARecording) {
  const core::Recording recording = testing::past_posts();
  const RawlogCounts counts = write_recording(recording, file("a.rawlog"), LandmarkIds::labels);
  EXPECT_EQ(counts.scans, 21U);
  const core::Recording got = read_rawlog(file("a.rawlog"), {});
  expect_same_motions(got, recording, 1e-12);
  expect_same_scans(got, recording);
  EXPECT_EQ(got.labels, recording.labels);

  write_recording(recording, file("b.rawlog"), LandmarkIds::none);
  EXPECT_TRUE(read_rawlog(file("b.rawlog"), {}).labels.empty());
}

TEST_F(Rawlogs, NameAnObjectOnceInAScanAsMrptDemands) {
  core::Recording recording = testing::past_posts(0);
  for (core::Label& label : recording.labels.front()) label = 4;
  const RawlogCounts counts = write_recording(recording, file("a.rawlog"), LandmarkIds::labels);
  EXPECT_EQ(counts.repeated_labels, recording.labels.front().size() - 1);
}

TEST_F(Rawlogs, RefuseRangesAlone) {
  core::Recording recording = testing::past_posts(0);
  std::get<core::Scan>(recording.events.front()).observations.front() = core::make_range(3.0, 0.1);
  const std::string why = input_error_of([&] { write_recording(recording, file("a.rawlog"), LandmarkIds::none); });
  EXPECT_NE(why.find("one of them alone"), std::string::npos) << why;
  EXPECT_FALSE(std::filesystem::exists(file("a.rawlog")));
}

// MRPT's own importer keeps neither the correlations of a STEP nor the axes of a landmark's covariance.
TEST_F(Rawlogs, OfDlrKeepCorrelationsAndTurnEveryCovariance) {
  const std::string circles = folder_.write("map.circles",
                                            "STEP a.jpg 0.1 -1 0.05 0.0004 0.0001 0.0009 0.00002 -0.00003 0.0001\n"
                                            "LANDMARK_C 1 -2 0.5 0.001 0.0003 0.004 7\n");
  const core::Recording original = logs::read_dlr(circles);
  write_recording(original, file("a.rawlog"), LandmarkIds::labels);
  const core::Recording got = read_rawlog(file("a.rawlog"), {});
  expect_same_motions(got, original, 1e-12);
  const core::Observation polar = all<core::Scan>(got).at(0).observations.at(0);
  // X left 1, Y backward −2: ahead 2, left 1. Back from range and bearing to the plane:
  EXPECT_NEAR(polar.z[0] * std::cos(polar.z[1]), 2.0, 1e-6);
  EXPECT_NEAR(polar.z[0] * std::sin(polar.z[1]), 1.0, 1e-6);
  Eigen::Matrix2d J;
  J << std::cos(polar.z[1]), -polar.z[0] * std::sin(polar.z[1]), std::sin(polar.z[1]),
      polar.z[0] * std::cos(polar.z[1]);
  const Eigen::Matrix2d plane = J * polar.R * J.transpose();
  EXPECT_NEAR(plane(0, 0), 0.004, 1e-9);
  EXPECT_NEAR(plane(1, 1), 0.001, 1e-9);
  EXPECT_NEAR(plane(0, 1), -0.0003, 1e-9);
  EXPECT_EQ(got.labels.at(0).at(0), 7);
}

/// Poses of the navigator on the log itself.
std::vector<core::Pose2> navigated(const logs::AcfrLog& log, const logs::AcfrSettings& settings,
                                   const supervisor::NavigatorOptions& options = {}) {
  supervisor::Navigator navigator(core::PoseGaussian{}, options);
  std::vector<core::Pose2> poses;
  for (const core::Event& event : logs::make_recording(log, settings).events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) navigator.move(*odometry);
    if (const auto* scan = std::get_if<core::Scan>(&event)) poses.push_back(navigator.observe(*scan).pose.mean);
  }
  return poses;
}

/// Poses of the component on a rawlog.
std::vector<core::Pose2> built(const std::string& rawlog, const mrpt_adapter::MapBuilderOptions& options) {
  mrpt_adapter::MapBuilder builder(options);
  std::vector<core::Pose2> poses;
  SlamFeed feed(builder, [&](const auto&) { poses.push_back(mrpt_adapter::RunAccess::pose(builder).mean); });
  RawlogSource source(rawlog, 0, vehicle_for(options.detector));
  while (const auto turn = source.next()) feed.take(*turn);
  return poses;
}

void expect_same_drive(const std::vector<core::Pose2>& got, const std::vector<core::Pose2>& expected) {
  ASSERT_EQ(got.size(), expected.size());
  const auto is_away = [](const core::Pose2& pose) { return pose.position_m().norm() > 10.0; };
  EXPECT_TRUE(std::any_of(expected.begin(), expected.end(), is_away));  // it drove
  for (std::size_t i = 0; i < got.size(); ++i) {
    EXPECT_LT((got[i].position_m() - expected[i].position_m()).norm(), 1e-6) << i;
    EXPECT_LT(std::abs(core::wrap_to_pi(got[i].heading_rad - expected[i].heading_rad)), 1e-6) << i;
  }
}

// The whole drive among reflectors, whose detector brings its own noise and reach.
TEST_F(Rawlogs, OfTheCarParkNavigateAsTheLogItself) {
  find_real_data("carpark/raw/data_set.mat");
  if (IsSkipped()) return;
  const logs::AcfrLog log = logs::read_car_park_mat(path_);
  write_acfr(log, logs::car_park_settings(), file("park.rawlog"));
  mrpt_adapter::MapBuilderOptions options;
  options.detector = "reflectors";
  const std::vector<core::Pose2> got = built(file("park.rawlog"), options);
  EXPECT_EQ(got.size(), 586U);
  supervisor::NavigatorOptions as_replayed;
  as_replayed.search.extraneous_per_scan = 0.5;
  expect_same_drive(got, navigated(log, logs::car_park_settings(), as_replayed));
}

// Victoria Park's first minutes: log -> rawlog -> component, beside the navigator on the log.
TEST_F(Rawlogs, OfVictoriaParkNavigateAsTheLogItself) {
  find_real_data("victoria_park/raw/victoria_park_ascii.zip");
  if (IsSkipped()) return;
  logs::AcfrLog log = logs::read_acfr_ascii(path_);
  std::size_t scans = 0;
  std::size_t keep = 0;
  while (scans < 700) scans += log.order[keep++].sensor == logs::AcfrLog::Sensor::laser ? 1 : 0;
  log.order.resize(keep);
  write_acfr(log, {}, file("park.rawlog"));
  const std::vector<core::Pose2> got = built(file("park.rawlog"), {});
  EXPECT_EQ(got.size(), 700U);
  expect_same_drive(got, navigated(log, {}));
  const core::Recording read = read_rawlog(file("park.rawlog"), {});
  const core::Recording of_log = logs::make_recording(log, {});
  ASSERT_EQ(read.true_positions.size(), of_log.true_positions.size());
  const Eigen::Vector2d origin_m = of_log.true_positions.front().position_m;
  for (std::size_t i = 0; i < read.true_positions.size(); ++i) {
    const Eigen::Vector2d east_north_m = of_log.true_positions[i].position_m - origin_m;
    EXPECT_LT((read.true_positions[i].position_m - east_north_m).norm(), 0.01);  // a plane on the ellipsoid
  }
}

TEST_F(Rawlogs, MadeOfObservationsOnlyHoldTheSumOfTheMovements) {
  const core::Recording recording = testing::past_posts();
  write_recording(recording, file("a.rawlog"), LandmarkIds::labels);
  EXPECT_EQ(write_observations_only(file("a.rawlog"), file("b.rawlog")), 42U);
  core::Pose2 sum;
  for (const core::Odometry& odometry : all<core::Odometry>(recording))
    sum = core::compose(sum, odometry.T_before_after);
  const RawlogEntries entries = read_entries(file("b.rawlog"));
  const auto last = std::dynamic_pointer_cast<mrpt::obs::CObservationOdometry>(entries.at(40));
  ASSERT_TRUE(last);
  EXPECT_NEAR(last->odometry.x(), sum.x_m, 1e-12);
  EXPECT_NEAR(last->odometry.phi(), sum.heading_rad, 1e-12);
  expect_same_scans(read_rawlog(file("b.rawlog"), {}), recording);
}

TEST_F(Rawlogs, WithAnObservationWithoutTimeNameTheEntry) {
  RawlogSink sink(file("a.rawlog"));
  sink.write(movement_of(core::no_motion(0)));
  mrpt::obs::CObservationBearingRange timeless;
  timeless.timestamp = mrpt::Clock::time_point();
  timeless.sensor_std_range = timeless.sensor_std_yaw = 0.1F;
  sink.write(timeless);
  sink.finish();
  const std::string why = input_error_of([&] { read_rawlog(file("a.rawlog"), {}); });
  EXPECT_NE(why.find("entry 1: a mrpt::obs::CObservationBearingRange without time"), std::string::npos) << why;
}

TEST_F(Rawlogs, AreConvertedByHelixnavConvertToo) {
  const std::string circles = folder_.write("map.circles",
                                            "STEP a.jpg 0.1 -1 0.05 0.0004 0.0001 0.0009 0.00002 -0.00003 0.0001\n"
                                            "LANDMARK_C 1 -2 0.5 0.001 0.0003 0.004 7\n");
  const Outcome there = run({HELIXNAV_CLI, "convert", circles, file("a.rawlog")});
  EXPECT_EQ(there.exit_code, 0) << there.err;
  const Outcome back = run({HELIXNAV_CLI, "convert", file("a.rawlog"), file("back.circles")});
  EXPECT_EQ(back.exit_code, 0) << back.err;
  EXPECT_EQ(motions_of(logs::read_dlr(file("back.circles"))).size(), 1U);
  const Outcome again = run({HELIXNAV_CLI, "convert", circles, file("a.rawlog")});
  EXPECT_EQ(again.exit_code, 3);
  EXPECT_NE(again.err.find("--overwrite"), std::string::npos) << again.err;
}

std::size_t scans_answered(const std::string& answers) {
  std::size_t scans = 0;
  for (std::size_t at = 0; (at = answers.find("{\"scan\"", at)) != std::string::npos; ++at) ++scans;
  return scans;
}

TEST_F(Rawlogs, FeedAStreamThatAnswersEachScan) {
  write_recording(testing::past_posts(), file("a.rawlog"), LandmarkIds::none);
  const std::string programs = std::filesystem::path(HELIXNAV_CLI).parent_path().string();
  const Outcome fed = run({"PATH=" + programs + ":/usr/bin:/bin", "sh", HELIXNAV_EXAMPLES "/live/feed_rawlog.sh",
                           file("a.rawlog"), "--detector", "none"});
  EXPECT_EQ(fed.exit_code, 0) << fed.err;
  EXPECT_EQ(scans_answered(fed.out), 21U) << fed.out << fed.err;
  EXPECT_NE(fed.out.find("\"scans\":21"), std::string::npos) << fed.out;
}

/// As in MRPT's own kf-slam_demo.rawlog, whose 250 frames have three time stamps.
TEST_F(Rawlogs, WhoseFramesShareStampsFeedAStreamFrameByFrame) {
  core::Recording recording = testing::past_posts();
  for (core::Event& event : recording.events) {
    std::visit([](auto& e) { e.t_ns = core::nanoseconds_from_seconds(e.t_ns < 8'000'000'000 ? 1.0 : 1.000002); },
               event);
  }
  write_recording(recording, file("a.rawlog"), LandmarkIds::labels);
  const Outcome converted = run({HELIXNAV_CLI, "convert", file("a.rawlog"), file("a.jsonl")});
  EXPECT_EQ(converted.exit_code, 0) << converted.err;
  EXPECT_NE(converted.out.find("times told apart: 38 rows"), std::string::npos) << converted.out;
  const Outcome fed = run(
      {"sh", "-c", std::string(HELIXNAV_CLI) + " stream --vehicle " + file("vehicle.toml") + " < " + file("a.jsonl")});
  EXPECT_EQ(scans_answered(fed.out), 21U) << fed.out << fed.err;
  EXPECT_NE(fed.out.find("\"refused\":0"), std::string::npos) << fed.out;
  const Outcome driven = run({HELIXNAV_CLI, "replay", file("a.jsonl"), "--out", file("r"), "--quiet"});
  EXPECT_NE(driven.out.find("steps                21"), std::string::npos) << driven.out << driven.err;
}

TEST_F(Rawlogs, WriteNoLinesBesideTheVehicleOfAnotherSensor) {
  write_recording(testing::past_posts(), file("a.rawlog"), LandmarkIds::none);
  folder_.write("vehicle.toml", "[[sensor]]\nreach_m = 99\n");
  const std::vector<std::string> words{HELIXNAV_CLI, "convert", file("a.rawlog"), file("a.jsonl")};
  const Outcome refused = run(words);
  EXPECT_EQ(refused.exit_code, 3) << refused.out;
  EXPECT_NE(refused.err.find("vehicle.toml: the file is there already"), std::string::npos) << refused.err;
  EXPECT_FALSE(std::filesystem::exists(file("a.jsonl")));
  std::vector<std::string> replacing = words;
  replacing.emplace_back("--overwrite");
  EXPECT_EQ(run(replacing).exit_code, 0);
  EXPECT_NE(logs::read_vehicle(file("vehicle.toml")).sensors.at(0).reach_m, 99.0);
  std::filesystem::remove(file("a.jsonl"));
  EXPECT_EQ(run(words).exit_code, 0) << "the same vehicle.toml is no other one";
}

}  // namespace
}  // namespace helixnav::apps
