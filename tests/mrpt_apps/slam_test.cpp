// SPDX-License-Identifier: BSD-3-Clause
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>
#include <memory>
#include <sstream>
#include <thread>

#include <gtest/gtest.h>
#include <mrpt/img/CImage.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/opengl/COpenGLScene.h>

#include "helixnav/runs/run_folder.hpp"
#include "input_error.hpp"
#include "kf_slam.hpp"
#include "program.hpp"
#include "rawlog/observations_only.hpp"
#include "rawlog/rawlog_sink.hpp"
#include "rawlog/write_recording.hpp"
#include "reading/rawlog_movement.hpp"
#include "slam/live_window.hpp"
#include "slam/rawlog_source.hpp"
#include "slam/slam_feed.hpp"
#include "slam/slam_run.hpp"
#include "slam/slam_scene.hpp"
#include "small_rawlogs.hpp"
#include "temporary_folder.hpp"
#include "virtual_screen.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;
using testing::input_error_of;

const std::string application = "[MappingApplication]\nSAVE_LOG_FREQUENCY=0\n";

class Slam : public ::testing::Test {
 protected:
  std::string file(const std::string& name) const { return folder_.path() / name; }

  std::string posts() const {
    write_recording(testing::past_posts(), file("posts.rawlog"), LandmarkIds::labels);
    return file("posts.rawlog");
  }

  SlamJob job(const std::string& ini, const std::string& rawlog) const {
    SlamJob made;
    made.config = folder_.write("a.ini", ini);
    made.rawlog = rawlog;
    made.out = file("out");
    made.quiet = true;
    made.command_line = {"helixnav-slam"};
    return made;
  }

  testing::TemporaryFolder folder_;
};

/// Blue as MapBuilder draws landmarks, well apart from grey grid, red path and white ground.
int blue_pixels(const mrpt::img::CImage& image) {
  int count = 0;
  for (std::size_t y = 0; y < image.getHeight(); ++y) {
    for (std::size_t x = 0; x < image.getWidth(); ++x) {
      const std::uint8_t* bgr = image.ptr<std::uint8_t>(static_cast<unsigned>(x), static_cast<unsigned>(y));
      if (bgr[0] > bgr[2] + 60 && bgr[0] > 120) ++count;
    }
  }
  return count;
}

TEST_F(Slam, WritesTheRunFolderAndTheFilesOfKfSlam) {
  EXPECT_EQ(run_slam(job("[MappingApplication]\nSAVE_LOG_FREQUENCY=10\n", posts())), ExitCode::ok);
  const std::set<std::string> names = names_in(file("out"));
  for (const char* name :
       {"manifest.json", "trajectory.tum", "map.csv", "report.html", "data_association.log", "robot_pose_00000.txt",
        "robot_pose_00010.txt", "full_cov_00020.txt", "kf_state_00010.3Dscene", "robot_pose.txt", "full_cov.txt",
        "landmarks.txt", "kf_state.3Dscene", "map.simplemap", "map.png"}) {
    EXPECT_EQ(names.count(name), 1U) << name;
  }
  const runs::Run read = runs::read_run(file("out"));
  EXPECT_EQ(read.steps.size(), 21U);  // the first frame, too
  mrpt::maps::CSimpleMap map;
  ASSERT_TRUE(map.loadFromFile(file("out/map.simplemap")));
  EXPECT_EQ(map.size(), 21U);
  mrpt::opengl::COpenGLScene scene;
  EXPECT_TRUE(scene.loadFromFile(file("out/kf_state.3Dscene")));
  mrpt::img::CImage picture;
  ASSERT_TRUE(picture.loadFromFile(file("out/map.png")));
  EXPECT_GT(blue_pixels(picture), 12 * 5);  // a few per post
}

TEST_F(Slam, FastSlamByTheConfigurationAlone) {
  const std::string particles = application + "[HelixNav]\nsave_png=0\nfilter=fastslam\nfastslam_particles=50\n";
  ASSERT_EQ(run_slam(job(particles + "use_landmark_ids=false\n", posts())), ExitCode::ok);
  const runs::Run run = runs::read_run(file("out"));
  ASSERT_EQ(run.steps.size(), 21U);
  EXPECT_TRUE(fs::exists(file("out/particles.csv"))) << "effective size and ancestors";
  EXPECT_FALSE(fs::exists(file("out/map.bin"))) << "there is no joint estimate";
  EXPECT_TRUE(fs::exists(file("out/full_cov.txt")));
  SlamJob again = job(particles + "gps_use=true\n", posts());
  again.overwrite = true;
  EXPECT_NE(input_error_of([&] { run_slam(again); }).find("takes no fixes"), std::string::npos);
}

TEST_F(Slam, GoesOnInTheMapOfAnEarlierRun) {
  const std::string by_place = application + "[HelixNav]\nsave_png=0\nuse_landmark_ids=false\n";
  ASSERT_EQ(run_slam(job(by_place, posts())), ExitCode::ok);
  ASSERT_TRUE(fs::exists(file("out/map.bin")));
  SlamJob later = job(by_place + "map=" + file("out") + "\n", posts());
  later.out = file("later");
  ASSERT_EQ(run_slam(later), ExitCode::ok);
  const runs::Run run = runs::read_run(file("later"));
  EXPECT_EQ(run.manifest.inputs.back().name, file("out") + "/map.bin");
  EXPECT_NE(text_of(file("later/decisions.csv")).find("placed,sought"), std::string::npos);
  SlamJob nowhere = job(by_place + "map=" + file("nowhere") + "\n", posts());
  nowhere.out = file("none");
  EXPECT_NE(input_error_of([&] { run_slam(nowhere); }).find("nowhere"), std::string::npos);
  EXPECT_FALSE(fs::exists(file("none")));
}

TEST_F(Slam, NeverTouchesWhatAUserHasInTheFolder) {
  folder_.write("out/thesis.tex", "years of work");
  const std::string why = input_error_of([&] { run_slam(job(application, posts())); });
  EXPECT_NE(why.find("out"), std::string::npos) << why;
  SlamJob again = job(application, posts());
  again.overwrite = true;
  EXPECT_EQ(run_slam(again), ExitCode::ok);
  EXPECT_EQ(run_slam(again), ExitCode::ok);
  EXPECT_EQ(text_of(file("out/thesis.tex")), "years of work");
}

TEST_F(Slam, LeavesNoNumbersOfALongerRunWhenToldToOverwrite) {
  const std::string every_step = "[HelixNav]\nsave_png=0\n[MappingApplication]\nSAVE_LOG_FREQUENCY=1\n";
  ASSERT_EQ(run_slam(job(every_step, posts())), ExitCode::ok);
  ASSERT_TRUE(fs::exists(file("out/kf_state_00020.3Dscene")));
  for (const char* name : {"out/robot_pose_07.txt", "out/robot_pose_00020.txt.bak", "out/my_full_cov_00020.txt"}) {
    folder_.write(name, "mine");
  }
  SlamJob shorter = job(every_step + "rawlog_offset=20\n", posts());
  shorter.overwrite = true;
  ASSERT_EQ(run_slam(shorter), ExitCode::ok);
  EXPECT_TRUE(fs::exists(file("out/robot_pose_00005.txt")));
  for (const char* name : {"out/robot_pose_00020.txt", "out/full_cov_00020.txt", "out/kf_state_00020.3Dscene"}) {
    EXPECT_FALSE(fs::exists(file(name))) << name;
  }
  for (const char* name : {"out/robot_pose_07.txt", "out/robot_pose_00020.txt.bak", "out/my_full_cov_00020.txt"}) {
    EXPECT_EQ(text_of(file(name)), "mine") << name;
  }
}

TEST_F(Slam, KeepsWhatCameBeforeADamagedPlace) {
  const std::string packed = text_of(posts());
  const std::string cut = folder_.write("cut.rawlog", packed.substr(0, packed.size() * 2 / 3));
  const std::string why = input_error_of([&] { run_slam(job(application, cut)); });
  EXPECT_NE(why.find("cut.rawlog: entry"), std::string::npos) << why;
  EXPECT_NE(why.find("steps before that were navigated and written to"), std::string::npos) << why;
  EXPECT_GT(runs::read_run(file("out")).steps.size(), 5U);
  EXPECT_TRUE(fs::exists(file("out/map.simplemap")));
}

TEST_F(Slam, StopsAtAnObservationWithoutTimeAndKeepsWhatCameBefore) {
  RawlogSink sink(file("a.rawlog"));
  mrpt::obs::CObservationBearingRange seen;
  seen.timestamp = mrpt::Clock::fromDouble(100.0);
  seen.sensor_std_range = seen.sensor_std_yaw = 0.1F;
  seen.sensedData.resize(1);
  seen.sensedData[0].range = 2.0F;
  seen.sensedData[0].yaw = seen.sensedData[0].pitch = 0.0F;
  seen.sensedData[0].landmarkID = mrpt::obs::INVALID_LANDMARK_ID;
  sink.write(seen);
  seen.timestamp = mrpt::Clock::time_point();
  seen.sensorLabel = "TURRET";
  sink.write(seen);
  sink.finish();
  const std::string why = input_error_of([&] { run_slam(job(application, file("a.rawlog"))); });
  EXPECT_NE(why.find("entry 1: "), std::string::npos) << why;
  EXPECT_NE(why.find("\"TURRET\" has no time"), std::string::npos) << why;
  EXPECT_EQ(runs::read_run(file("out")).steps.size(), 1U);
}

TEST_F(Slam, RefusesARawlogWithNothingToNavigateBy) {
  RawlogSink sink(file("a.rawlog"));
  mrpt::obs::CObservationComment comment;
  comment.text = "nothing happened";
  sink.write(comment);
  sink.finish();
  const std::string why = input_error_of([&] { run_slam(job(application, file("a.rawlog"))); });
  EXPECT_NE(why.find("nothing to navigate by"), std::string::npos) << why;
  EXPECT_FALSE(fs::exists(file("out")));
  const std::string beyond = input_error_of([&] { run_slam(job(application + "rawlog_offset=1000\n", posts())); });
  EXPECT_NE(beyond.find("in 0 entries behind rawlog_offset = 1000"), std::string::npos) << beyond;
  const std::string unnamed = input_error_of([&] { run_slam(job(application, "")); });
  EXPECT_NE(unnamed.find("[MappingApplication] rawlog_file is missing"), std::string::npos) << unnamed;
}

TEST_F(Slam, TellsTheShellWhatHappened) {
  const Outcome help = run({HELIXNAV_SLAM, "--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_NE(help.out.find("Exit codes"), std::string::npos);
  const Outcome version = run({HELIXNAV_SLAM, "--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_EQ(version.out.rfind("helixnav-slam ", 0), 0U) << version.out;
  EXPECT_EQ(run({HELIXNAV_SLAM}).exit_code, 2);
  const Outcome missing = run({HELIXNAV_SLAM, folder_.write("a.ini", application), file("none.rawlog")});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_NE(missing.err.find("none.rawlog: expected a rawlog, found nothing there"), std::string::npos) << missing.err;
  const std::string class_of_nine_bytes = "\x89\x1b[2Jbell\a" + std::string(20, 'z');
  const Outcome damaged = run({HELIXNAV_SLAM, file("a.ini"), folder_.write("b.rawlog", class_of_nine_bytes)});
  EXPECT_EQ(damaged.exit_code, 3);
  EXPECT_NE(damaged.err.find("entry 0 cannot be read"), std::string::npos) << damaged.err;
  EXPECT_EQ(damaged.err.find_first_of("\x1b\a"), std::string::npos) << damaged.err;
}

/// MRPT's shipped demo; kf-slam 2.5.8 has a mean error of 0.0037 m there, from the second frame on.
class Demo : public Slam {
 protected:
  const std::string datasets_ = HELIXNAV_MRPT_DATASETS;
  const std::string ini_ = "[MappingApplication]\nground_truth_file=" + datasets_ +
                           "/kf-slam_demo_ground_truth.txt\n[RangeBearingKFSLAM]\nstd_sensor_range=0.03\n"
                           "std_sensor_yaw_deg=0.1\n[HelixNav]\nsave_png=0\n"
                           "odo_a1=0\nodo_a2=0\nodo_a3=0\nodo_a4=0\nodo_min_std_xy=0.04\nodo_min_std_phi_deg=0.01\n";

  void SetUp() override {
    if (!fs::exists(datasets_ + "/kf-slam_demo.rawlog")) GTEST_SKIP() << datasets_ << " is not there: mrpt-common";
  }
};

TEST_F(Demo, IsMappedAsWellAsByKfSlamAndTheSameFromObservationsOnly) {
  const std::string rawlog = datasets_ + "/kf-slam_demo.rawlog";
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(run_slam(job(ini_, rawlog)), ExitCode::ok);
  const std::string out = ::testing::internal::GetCapturedStdout();
  const std::size_t mean = out.find("landmarks to truth   mean ");
  ASSERT_NE(mean, std::string::npos) << out;
  EXPECT_LT(std::stod(out.substr(mean + 26)), 0.006) << out;
  EXPECT_NE(out.find("of 70 (0 without truth)"), std::string::npos) << out;

  write_observations_only(rawlog, file("observations.rawlog"));
  SlamJob again = job(ini_, file("observations.rawlog"));
  again.out = file("again");
  EXPECT_EQ(run_slam(again), ExitCode::ok);
  const runs::Run frames = runs::read_run(file("out"));
  const runs::Run single = runs::read_run(file("again"));
  ASSERT_EQ(frames.steps.size(), 250U);
  ASSERT_EQ(single.steps.size(), 250U);
  for (std::size_t i = 0; i < frames.steps.size(); ++i) {
    const core::Pose2 apart = core::between(frames.steps[i].pose.mean, single.steps[i].pose.mean);
    EXPECT_LT(apart.vector().norm(), 1e-6) << i;
  }
}

using testing::KfSlam;

KfSlam::Landmarks landmarks_of_kf_slam(mrpt::obs::CRawlog& demo) {
  KfSlam filter(0.03, 0.1 * core::pi / 180.0);
  auto action = mrpt::obs::CActionCollection::Create();
  for (std::size_t i = 0; i < demo.size(); ++i) {
    if (demo.getType(i) == mrpt::obs::CRawlog::etActionCollection) action = demo.getAsAction(i);
    if (demo.getType(i) != mrpt::obs::CRawlog::etSensoryFrame) continue;
    auto frame = demo.getAsObservations(i);
    filter.take(action, frame);
  }
  return filter.landmarks_m();
}

KfSlam::Landmarks read_landmarks(const std::string& path) {
  KfSlam::Landmarks landmarks_m;
  std::istringstream lines(text_of(path));
  lines.ignore(1000, '\n');
  Eigen::Vector2d point_m;
  for (std::int64_t id = 0; lines >> point_m.x() >> point_m.y() >> id;) landmarks_m[id] = point_m;
  return landmarks_m;
}

/// Largest distance of equally named landmarks; infinity when the names differ.
double farthest_m(const KfSlam::Landmarks& a, const KfSlam::Landmarks& b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double farthest = 0.0;
  for (const auto& [id, point] : a) {
    if (b.count(id) == 0) return std::numeric_limits<double>::infinity();
    farthest = std::max(farthest, (b.at(id) - point).norm());
  }
  return farthest;
}

TEST_F(Demo, IsKfSlamsMapWithTheFileShippedForItAndWithinItsLinearisationWithOurRetraction) {
  mrpt::obs::CRawlog demo;
  ASSERT_TRUE(demo.loadFromRawLogFile(datasets_ + "/kf-slam_demo.rawlog"));
  const KfSlam::Landmarks of_kf_slam = landmarks_of_kf_slam(demo);
  ASSERT_EQ(of_kf_slam.size(), 70U);
  const std::string shipped = datasets_ + "/../config_files/kf-slam/EKF-SLAM_test_2d.ini";  // method = 0: plain EKF
  const std::string rawlog = datasets_ + "/kf-slam_demo.rawlog";
  const Outcome unchanged = run({"-u", "DISPLAY", HELIXNAV_SLAM, shipped, rawlog, "--out", file("out")});
  EXPECT_EQ(unchanged.exit_code, 0) << unchanged.err;
  EXPECT_EQ(unchanged.err.find("without effect here: [RangeBearingKFSLAM_KalmanFilter] method"), std::string::npos);
  EXPECT_LT(farthest_m(read_landmarks(file("out/landmarks.txt")), of_kf_slam), 1e-7);
  SlamJob ours = job(ini_, rawlog);
  ours.overwrite = true;
  EXPECT_EQ(run_slam(ours), ExitCode::ok);
  const double apart_m = farthest_m(read_landmarks(file("out/landmarks.txt")), of_kf_slam);
  EXPECT_GT(apart_m, 1e-6);
  EXPECT_LT(apart_m, 1e-3);
}

/// Reports on stderr why there is no window.
bool shows_landmarks(const std::string& rawlog, const VirtualScreen& screen) {
  std::string why_not;
  const std::unique_ptr<LiveWindow> window = open_live_window(why_not);
  if (!window) std::fprintf(stderr, "%s\n", why_not.c_str());
  if (!window) return false;
  mrpt_adapter::MapBuilder builder;
  SlamFeed feed(builder, [](const auto&) {});
  RawlogSource source(rawlog, 0, {});
  while (const auto turn = source.next()) feed.take(*turn);
  window->show(scene_of(builder, {}), "21 steps");
  window->look_at(8.0, 0.0);
  constexpr int enough = 12 * 5;
  int blue = 0;
  for (int tries = 0; tries < 1000 && blue < enough; ++tries) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    blue = screen.blue_pixels();
  }
  return blue >= enough;
}

TEST_F(Slam, ShowsTheLandmarksInALiveWindow) {
  fs::create_directory(file("screen"));
  const VirtualScreen screen(file("screen"));
  ASSERT_NE(screen.display(), ":") << "no Xvfb";
  const std::string ini = folder_.write("live.ini", "[MappingApplication]\nSHOW_3D_LIVE=1\nlogOutput_dir=\n");
  const Outcome outcome = run({"DISPLAY=" + screen.display(), HELIXNAV_SLAM, ini, posts(), "--quiet"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");

  // The same window again, for as long as the picture takes to appear, in a process that ends without MRPT's and the
  // renderer's own shutdown: on a busy machine they now and then read what is gone by then.
  const std::string rawlog = posts();
  const pid_t looks = fork();
  if (looks == 0) {
    setenv("DISPLAY", screen.display().c_str(), 1);
    _exit(shows_landmarks(rawlog, screen) ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(waitpid(looks, &status, 0), looks);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "status " << status;
}

TEST_F(Slam, GoesOnWithoutADisplay) {
  const std::string ini = folder_.write("live.ini", "[MappingApplication]\nSHOW_3D_LIVE=1\nlogOutput_dir=\n");
  const Outcome outcome = run({"-u", "DISPLAY", HELIXNAV_SLAM, ini, posts(), "--quiet"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("no live view: there is no display"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace helixnav::apps
