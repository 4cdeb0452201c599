// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>
#include <set>
#include <thread>

#include <gtest/gtest.h>
#include <mrpt/img/CImage.h>
#include <mrpt/maps/CLandmarksMap.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/math/CMatrixDynamic.h>
#include <mrpt/math/CVectorDynamic.h>
#include <mrpt/opengl/CEllipsoid2D.h>
#include <mrpt/opengl/CPointCloud.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/CText.h>
#include <mrpt/system/CTimeLogger.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/sim/simulate.hpp"
#include "quiet_builder.hpp"
#include "temporary_folder.hpp"

namespace helixnav::mrpt_adapter {
namespace {

using testing::QuietBuilder;

MapBuilderOptions profiled() {
  MapBuilderOptions options;
  options.enable_profiler = true;
  return options;
}

/// The first `scans` scans of a simulated drive.
struct Driven {
  explicit Driven(std::size_t scans, const MapBuilderOptions& options = {}, bool by_name = false) : builder(options) {
    const core::Recording recording = sim::simulate(sim::named_scenario("large-loop"), 21);
    testing::drive(builder, recording, by_name, [&](const core::Scan&, std::size_t i) { return i + 1 < scans; });
  }
  QuietBuilder builder;
};

const mrpt::maps::CLandmarksMap& landmarks_of(const MapBuilder& builder) {
  return *builder.getCurrentlyBuiltMetricMap()->mapByClass<mrpt::maps::CLandmarksMap>();
}

TEST(Outputs, StateAndDenseCovarianceAreTheFilters) {
  const Driven driven(60);
  mrpt::poses::CPosePDFGaussian pose;
  std::vector<mrpt::math::TPoint2D> points;
  std::map<unsigned int, MapBuilder::LandmarkNumber> numbers;
  mrpt::math::CVectorDouble state;
  mrpt::math::CMatrixDouble covariance;
  driven.builder.getCurrentState(pose, points, numbers, state, &covariance);
  const std::vector<core::MapLandmark> map = RunAccess::map(driven.builder);
  ASSERT_GT(map.size(), 10u);
  ASSERT_EQ(points.size(), map.size());
  ASSERT_EQ(static_cast<std::size_t>(state.size()), 3 + 2 * map.size());
  ASSERT_EQ(static_cast<std::size_t>(covariance.rows()), 3 + 2 * map.size());
  EXPECT_EQ(pose.cov(0, 2), covariance(0, 2));
  EXPECT_EQ(pose.mean.x(), state[0]);
  for (std::size_t i = 0; i < map.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(3 + 2 * i);
    EXPECT_EQ(numbers.at(static_cast<unsigned int>(i)), map[i].id);
    EXPECT_EQ(points[i].x, map[i].point.mean_m.x());
    EXPECT_EQ(state[row + 1], map[i].point.mean_m.y());
    EXPECT_NEAR(covariance(row, row + 1), map[i].point.covariance_m2(0, 1), 1e-12);
  }
}

TEST(Outputs, MetricMapHoldsTheMatureLandmarksAndIsMadeAnewAfterAStep) {
  Driven driven(60);
  std::set<std::int64_t> mature;
  for (const core::MapLandmark& landmark : RunAccess::map(driven.builder)) {
    if (landmark.state == core::LandmarkState::mature) mature.insert(landmark.id);
  }
  ASSERT_GT(mature.size(), 5u);
  ASSERT_LT(mature.size(), RunAccess::map(driven.builder).size());
  std::set<std::int64_t> shown;
  for (const mrpt::maps::CLandmark& landmark : landmarks_of(driven.builder).landmarks) {
    shown.insert(landmark.ID);
    EXPECT_GT(landmark.seenTimesCount, 2u);
    EXPECT_GT(landmark.pose_cov_11, 0.0F);
    EXPECT_NE(landmark.timestampLastSeen, INVALID_TIMESTAMP);
  }
  EXPECT_EQ(shown, mature);
  const mrpt::maps::CLandmarksMap* before = &landmarks_of(driven.builder);
  EXPECT_EQ(&landmarks_of(driven.builder), before);
  driven.builder.initialize();
  EXPECT_EQ(landmarks_of(driven.builder).landmarks.size(), 0u);
}

TEST(Outputs, SimpleMapHoldsEveryFrameWithLandmarksUnlessItIsNotWanted) {
  Driven driven(30);
  mrpt::maps::CSimpleMap frames;
  driven.builder.getCurrentlyBuiltMap(frames);
  ASSERT_EQ(frames.size(), 30u);
  EXPECT_EQ(driven.builder.getCurrentlyBuiltMapSize(), 30u);
  mrpt::poses::CPose3DPDF::Ptr pose;
  mrpt::obs::CSensoryFrame::Ptr frame;
  frames.get(29, pose, frame);
  EXPECT_EQ(pose->getMeanVal().x(), RunAccess::pose(driven.builder).mean.x_m);
  EXPECT_EQ(frame->size(), 1u);
  MapBuilderOptions options;
  options.create_simplemap = false;
  EXPECT_EQ(Driven(30, options).builder.getCurrentlyBuiltMapSize(), 0u);
}

TEST(Outputs, SceneShowsLandmarksPathAndMode) {
  const Driven driven(60, {}, true);
  std::shared_ptr<mrpt::opengl::CSetOfObjects> scene;
  driven.builder.getAs3DObject(scene);
  ASSERT_TRUE(scene);
  std::size_t ellipses = 0;
  bool says_mapping = false;
  for (const auto& object : *scene) {
    if (dynamic_cast<const mrpt::opengl::CEllipsoid2D*>(object.get()) != nullptr) ++ellipses;
    const auto* text = dynamic_cast<const mrpt::opengl::CText*>(object.get());
    if (text != nullptr && text->getString() == "mapping") says_mapping = true;
  }
  EXPECT_EQ(ellipses, RunAccess::map(driven.builder).size() + 1);  // and the vehicle's
  EXPECT_TRUE(says_mapping);
  const auto path = std::dynamic_pointer_cast<mrpt::opengl::CSetOfLines>(scene->getByName("path"));
  ASSERT_TRUE(path);
  EXPECT_EQ(path->getLineCount(), 59u);
  EXPECT_FALSE(scene->getByName("particles"));
}

TEST(Outputs, SceneShowsParticlesWhileRelocalising) {
  const core::Recording recording = sim::simulate(sim::named_scenario("large-loop"), 21);
  QuietBuilder builder;
  std::size_t shown = 0;
  testing::drive(builder, recording, false, [&](const core::Scan&, std::size_t) {
    const auto& cloud = RunAccess::last_steps(builder).back().report.cloud;
    if (cloud.empty()) return true;
    std::shared_ptr<mrpt::opengl::CSetOfObjects> scene;
    builder.getAs3DObject(scene);
    const auto points = std::dynamic_pointer_cast<mrpt::opengl::CPointCloud>(scene->getByName("particles"));
    EXPECT_TRUE(points && points->size() == cloud.size());
    return ++shown < 2;
  });
  EXPECT_EQ(shown, 2u);
}

/// Pixels of the colour of mature landmarks, blue, green, red.
std::size_t blue_pixels(const mrpt::img::CImage& image) {
  std::size_t count = 0;
  for (unsigned y = 0; y < image.getHeight(); ++y) {
    for (unsigned x = 0; x < image.getWidth(); ++x) {
      const auto* pixel = image.ptr<std::uint8_t>(x, y);
      if (pixel[0] > 180 && pixel[1] < 120 && pixel[2] < 80) ++count;
    }
  }
  return count;
}

TEST(Outputs, PictureShowsTheLandmarks) {
  const helixnav::testing::TemporaryFolder folder;
  Driven driven(60);
  const std::string name = (folder.path() / "map").string();
  driven.builder.saveCurrentEstimationToImage(name);
  mrpt::img::CImage image;
  ASSERT_TRUE(image.loadFromFile(name + ".png"));
  EXPECT_EQ(std::max(image.getWidth(), image.getHeight()), 1000u);
  EXPECT_GT(blue_pixels(image), 10 * landmarks_of(driven.builder).landmarks.size());
  EXPECT_THROW(driven.builder.saveCurrentEstimationToImage((folder.path() / "no/such/folder.png").string()),
               core::InputError);
  QuietBuilder empty;
  empty.saveCurrentEstimationToImage((folder.path() / "empty.bmp").string());
  empty.saveCurrentEstimationToImage((folder.path() / "empty.GIF").string());
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "empty.GIF.png")) << "of a format that MRPT does not write";
  EXPECT_TRUE(image.loadFromFile((folder.path() / "empty.bmp").string()));
}

TEST(Outputs, ProfilerCountsItsSections) {
  Driven driven(40, profiled());
  std::map<std::string, mrpt::system::CTimeLogger::TCallStats> stats;
  driven.builder.getCurrentlyBuiltMetricMap();
  driven.builder.getProfiler().getStats(stats);
  EXPECT_EQ(stats.at("complete_step").n_calls, 40u);
  EXPECT_EQ(stats.at("convert").n_calls, 40u);
  EXPECT_EQ(stats.at("navigate").n_calls, 40u);
  EXPECT_EQ(stats.at("refresh_map").n_calls, 1u);
}

TEST(Outputs, StepsAreToldToWhoWantsDebugOnly) {
  const core::Recording recording = sim::simulate(sim::named_scenario("large-loop"), 21);
  for (const bool debug : {true, false}) {
    QuietBuilder builder;
    builder.setMinLoggingLevel(debug ? mrpt::system::LVL_DEBUG : mrpt::system::LVL_INFO);
    testing::drive(builder, recording, false, [&](const core::Scan&, std::size_t i) { return i < 4; });
    EXPECT_EQ(builder.said().find("step 4:") != std::string::npos, debug);
  }
}

TEST(Outputs, MayBeReadWhileAnotherThreadFeeds) {
  const core::Recording recording = sim::simulate(sim::named_scenario("large-loop"), 21);
  QuietBuilder builder;
  std::atomic<bool> done{false};
  std::size_t reads = 0;
  std::thread reader([&] {
    do {
      EXPECT_TRUE(builder.getCurrentPoseEstimation());
      std::shared_ptr<mrpt::opengl::CSetOfObjects> scene;
      builder.getAs3DObject(scene);
      ++reads;
    } while (!done);
  });
  testing::drive(builder, recording, false, [&](const core::Scan&, std::size_t i) { return i < 40; });
  done = true;
  reader.join();
  EXPECT_GT(reads, 0u);
}

}  // namespace
}  // namespace helixnav::mrpt_adapter
