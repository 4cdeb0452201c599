// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/pose_landmark_text.hpp"

#include <string>

#include "input_error.hpp"
#include "real_data.hpp"
#include "temporary_folder.hpp"

namespace helixnav::logs {
namespace {

using testing::input_error_of;
using testing::TemporaryFolder;

const core::Odometry& odometry_of(const core::Recording& recording, std::size_t event) {
  return std::get<core::Odometry>(recording.events.at(event));
}
const core::Scan& scan_of(const core::Recording& recording, std::size_t pose) {
  return std::get<core::Scan>(recording.events.at(2 * pose));
}

class VictoriaParkGraph : public testing::RealDataTest {
 protected:
  void SetUp() override { find_real_data("victoria_park_graph/raw"); }
};

TEST_F(VictoriaParkGraph, HasAScanForEveryPoseAndTheLabelsOfTheFile) {
  const core::Recording recording = read_pose_landmark_text(path_ / "isam_victoriaPark.txt");
  ASSERT_EQ(recording.labels.size(), 6969u);
  ASSERT_EQ(recording.events.size(), 6969u + 6968u);
  std::size_t observations = 0;
  for (const auto& labels : recording.labels) {
    observations += labels.size();
  }
  EXPECT_EQ(observations, 3640u);
  EXPECT_EQ(scan_of(recording, 4).observations.at(0).z[0], 11.5387);
  EXPECT_EQ(scan_of(recording, 4).observations.at(0).z[1], -3.2007);
  EXPECT_EQ(recording.labels.at(4), std::vector<core::Label>{5});
}

TEST_F(VictoriaParkGraph, IsTheSameFromSquareRootsAndFromVariances) {
  const core::Recording isam = read_pose_landmark_text(path_ / "isam_victoriaPark.txt");
  const core::Recording gtsam = read_pose_landmark_text(path_ / "gtsam_victoria_park.txt");
  ASSERT_EQ(isam.events.size(), gtsam.events.size());
  EXPECT_EQ(isam.labels, gtsam.labels);
  const Eigen::Matrix3d expected = Eigen::Vector3d(1e-4, 4e-6, 4e-6).asDiagonal();
  for (std::size_t pose = 0; pose < isam.labels.size(); ++pose) {
    if (pose > 0) {
      EXPECT_LT((odometry_of(isam, 2 * pose - 1).covariance - expected).norm(), 1e-12);
      EXPECT_LT((odometry_of(gtsam, 2 * pose - 1).covariance - expected).norm(), 1e-12);
    }
    for (const core::Observation& observation : scan_of(isam, pose).observations) {
      EXPECT_LT((observation.R - 0.4 * Eigen::Matrix2d::Identity()).norm(), 1e-6);
    }
  }
}

TEST(PoseLandmarkText, InvertsAFullSquareRoot) {
  const TemporaryFolder folder;
  const auto path = folder.write("graph.txt", "ODOMETRY 0 1 1 0 0 2 1 0.5 4 -1 5\nLANDMARK 1 7 3 4 2 1 4\n");
  const core::Recording recording = read_pose_landmark_text(path);
  Eigen::Matrix3d U;
  U << 2, 1, 0.5, 0, 4, -1, 0, 0, 5;
  EXPECT_LT((odometry_of(recording, 1).covariance * U.transpose() * U - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  const Eigen::Matrix2d U2 = U.topLeftCorner<2, 2>();
  EXPECT_LT((scan_of(recording, 1).observations[0].R * U2.transpose() * U2 - Eigen::Matrix2d::Identity()).norm(),
            1e-12);
}

TEST(PoseLandmarkText, TakesAnObservationThatComesLaterThanItsPose) {
  const TemporaryFolder folder;
  const auto path =
      folder.write("graph.txt", "# two poses\r\nODOMETRY 3 1 1 0 0 .1 0 0 .1 0 .1\r\nLANDMARK 3 7 3 4 .1 0 .1\r\n");
  const core::Recording recording = read_pose_landmark_text(path);
  EXPECT_EQ(recording.labels, (std::vector<std::vector<core::Label>>{{7}, {}}));
}

TEST(PoseLandmarkText, ObeysTheReaderAboutTheMeaningOfTheNoise) {
  const TemporaryFolder folder;
  const auto path = folder.write("graph.txt", "ODOMETRY 0 1 1 0 0 2 0 0 2 0 2\n");
  EXPECT_NEAR(odometry_of(read_pose_landmark_text(path, NoiseColumns::covariance), 1).covariance(0, 0), 2.0, 1e-15);
  EXPECT_NEAR(odometry_of(read_pose_landmark_text(path), 1).covariance(0, 0), 0.25, 1e-15);
}

TEST(PoseLandmarkText, NamesTheLineOfWhatIsWrong) {
  const TemporaryFolder folder;
  const std::string good = "ODOMETRY 0 1 1 0 0 .1 0 0 .1 0 .1\n";
  const auto error_of = [&](const std::string& text) {
    const auto path = folder.write("graph.txt", text);
    const std::string message = input_error_of([&] { read_pose_landmark_text(path); });
    EXPECT_EQ(message.rfind(path.string() + ":", 0), 0u) << message;
    return message.substr(std::min(message.size(), path.string().size() + 1));
  };
  EXPECT_EQ(error_of(good + "ODOMETRY 1 2 1 0 nan .1 0 0 .1 0 .1\n"), "2: expected dheading [rad], found 'nan'");
  EXPECT_EQ(error_of(good + "ODOMETRY 1 2 1 0 0 .1 0 0 .1 0\n"),
            "2: expected a noise column, found the end of the line");
  EXPECT_EQ(error_of(good + "ODOMETRY 1 2 1 0 0 .1 0 0 .1 0 .1 7\n"),
            "2: more columns than from, to, dx, dy, dheading and 6 of noise");
  EXPECT_EQ(error_of(good + "ODOMETRY 0 2 1 0 0 .1 0 0 .1 0 .1\n"),
            "2: expected odometry that goes on from the latest pose, found one from 0");
  EXPECT_EQ(error_of(good + "LANDMARK 9 4 1 0 .1 0 .1\n"),
            "2: expected the number of a pose that odometry reached before, found 9");
  EXPECT_EQ(error_of(good + "LANDMARK 1 4 1 0 .1 .2 .1\n"), "2: expected noise that is positive definite");
  EXPECT_EQ(error_of(good + "EDGE3 1 4\n"), "2: expected ODOMETRY or LANDMARK, found 'EDGE3'");
  EXPECT_EQ(error_of(""), "1: expected at least one ODOMETRY line, found none");
}

}  // namespace
}  // namespace helixnav::logs
