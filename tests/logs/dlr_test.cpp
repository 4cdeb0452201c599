// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/dlr.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <variant>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/random.hpp"
#include "input_error.hpp"
#include "real_data.hpp"
#include "temporary_folder.hpp"

namespace helixnav::logs {
namespace {

// The formats' fields with our own numbers.
constexpr const char* circles =
    "# a comment\n"
    "\n"
    "STEP run.0000 0.01 -0.25 0.03 4e-5 1e-6 9e-5 2e-6 -3e-6 2e-4\n"
    "LANDMARK_C -0.5 -2.0 0.9 0.002 0.0003 0.004 6\n"
    "LANDMARK 0.25 -1.5 0.7 0.001 -0.0001 0.003 -1\n"
    "STEP run.0001 0.0 -0.2 -0.01 4e-5 0 9e-5 0 0 2e-4\n"
    "STEP run.0002 0.0 -0.2 -0.01 4e-5 0 9e-5 \\\n"
    " 0 0 2e-4\n"
    "LANDMARK_C -0.1 -1.0 1 0.002 0 0.004 6\n";

constexpr const char* lines =
    "STEP run.0000 0.01 -0.25 0.03 4e-5 1e-6 9e-5 2e-6 -3e-6 2e-4\n"
    "LANDMARK_L -0.8 -0.6 -0.7 -0.3 0.6 0.02 0 0.003 1\n"
    "LANDMARK_L -0.2 -0.6 -0.1 -0.3 0.15 0.01 0 0.0029 14 681\n"
    "STEP run.0001 0.0 -0.2 -0.01 4e-5 0 9e-5 0 0 2e-4\n"
    "LANDMARK_L 0.1 -0.6 0.1 -0.1 -0.12 0.004 0 0.01 17 18 19\n";

constexpr const char* camera =
    "{ SmRadialDistortedCamera\n"
    "sensor2World: [ -1, 0, 0, 0.02 ]\n[ 0, 0.5, -0.8660254, -0.08 ]\n[ 0, -0.8660254, -0.5, 1.5 ]\n"
    "width: 768 height: 288 scaleX: 460 scaleY: 230 offsetX: 384 offsetY: 144\n"
    "coef: { -0.06 -0.3 0.3 1.5 -0.5 }\n}\n";

core::Recording read(const std::string& text, const DlrOptions& options = {}) {
  const helixnav::testing::TemporaryFolder folder;
  return read_dlr(folder.write("map.txt", text), options);
}

const core::Odometry& odometry(const core::Recording& recording, std::size_t step) {
  return std::get<core::Odometry>(recording.events.at(2 * step));
}
const core::Scan& scan(const core::Recording& recording, std::size_t step) {
  return std::get<core::Scan>(recording.events.at(2 * step + 1));
}

TEST(ReadDlr, TurnsTheAxesSoThatXIsAhead) {
  const core::Recording recording = read(circles);
  ASSERT_EQ(recording.events.size(), 6u);
  EXPECT_EQ(odometry(recording, 0).T_before_after.vector(), Eigen::Vector3d(0.25, 0.01, 0.03));
  EXPECT_EQ(Eigen::Vector2d(scan(recording, 0).observations[0].z), Eigen::Vector2d(2.0, -0.5));
}

TEST(ReadDlr, TurnsCovariancesAsSamplesTurn) {
  const core::Recording recording = read(circles);
  Eigen::Matrix3d C;
  C << 4e-5, 1e-6, 2e-6, 1e-6, 9e-5, -3e-6, 2e-6, -3e-6, 2e-4;
  Eigen::Matrix3d R;
  R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  EXPECT_LE((odometry(recording, 0).covariance - R * C * R.transpose()).norm(), 1e-20);
  Eigen::Matrix2d circle;
  circle << 0.002, 0.0003, 0.0003, 0.004;
  const Eigen::Matrix2d R2 = R.topLeftCorner<2, 2>();
  EXPECT_LE((Eigen::Matrix2d(scan(recording, 0).observations[0].R) - R2 * circle * R2.transpose()).norm(), 1e-18);
}

TEST(ReadDlr, GivesEveryStepAScanAtItsIndexInSeconds) {
  const core::Recording recording = read(circles);
  EXPECT_EQ(scan(recording, 1).t_ns, 1'000'000'000);
  EXPECT_TRUE(scan(recording, 1).observations.empty());
  EXPECT_EQ(odometry(recording, 2).t_ns, 2'000'000'000);
  EXPECT_EQ(recording.labels, (std::vector<std::vector<core::Label>>{{6, core::no_label}, {}, {6}}));
  EXPECT_TRUE(recording.shared_observations.empty());
}

TEST(ReadDlr, KeepsAllIdentifiersOfAJoinedLine) {
  const core::Recording recording = read(lines);
  EXPECT_EQ(recording.labels, (std::vector<std::vector<core::Label>>{{1, 14}, {17}}));
  ASSERT_EQ(recording.shared_observations.size(), 2u);
  EXPECT_EQ(recording.shared_observations[0].scan, 0u);
  EXPECT_EQ(recording.shared_observations[0].observation, 1u);
  EXPECT_EQ(recording.shared_observations[0].labels, (std::vector<core::Label>{14, 681}));
  EXPECT_EQ(recording.shared_observations[1].labels, (std::vector<core::Label>{17, 18, 19}));
}

TEST(ReadDlr, MeasuresBearingsFromTheCamera) {
  const core::Recording recording = read(lines);
  const core::Scan& first = scan(recording, 0);
  EXPECT_EQ(first.T_robot_sensor.vector(), Eigen::Vector3d(0.0808609, 0.0179777, 0.0));
  EXPECT_EQ(first.observations[0].kind, core::ObservationKind::bearing);
  EXPECT_NEAR(first.observations[0].z[0], 0.6, 1e-15);
  EXPECT_NEAR(first.observations[0].R(0, 0), 9e-6, 1e-15);
}

TEST(ReadDlr, TakesTheCameraBesideTheLogAndEvenRatherTheOneGiven) {
  const helixnav::testing::TemporaryFolder folder;
  folder.write("run.cam", camera);
  const std::filesystem::path log = folder.write("map.lines", lines);
  EXPECT_EQ(scan(read_dlr(log), 0).T_robot_sensor.vector(), Eigen::Vector3d(0.08, 0.02, 0.0));
  DlrOptions options;
  options.camera = DlrCamera();
  options.camera->T_robot_camera(0, 3) = 1.0;
  EXPECT_EQ(scan(read_dlr(log, options), 0).T_robot_sensor.vector(), Eigen::Vector3d(0.0, 1.0, 0.0));
}

TEST(ReadDlr, RecognisesBearingsByThePapersEquationInTheFilesAxes) {
  // eq (13) with X left and Y backward: a line straight ahead has bearing −π/2. Made for lines seen from moving poses, and
  // compared with our own model in our own axes.
  core::RandomStream random(1, "lines");
  std::ostringstream text;
  text.precision(17);
  std::vector<double> expected;
  for (int step = 0; step < 20; ++step) {
    text << "STEP s 0 -0.2 0 1e-4 0 1e-4 0 0 1e-4\n";
    const Eigen::Vector2d m(random.uniform(-1.5, 1.5),
                            random.uniform(-5.0, -2.5));  // of the line's foot, X left, Y back
    const Eigen::Vector2d c(0.0179777, -0.0808609);
    text << "LANDMARK_L 0 0 0 0 " << std::atan2(m.y() - c.y(), m.x() - c.x()) << " 0 0 0.003 " << step << "\n";
    const core::Pose2 T_robot_sensor(0.0808609, 0.0179777, 0.0);
    expected.push_back(
        core::predict_observation(core::ObservationKind::bearing, {}, T_robot_sensor, {-m.y(), m.x()}).z_hat[0]);
  }
  const core::Recording recording = read(text.str());
  for (std::size_t step = 0; step < expected.size(); ++step) {
    EXPECT_NEAR(scan(recording, step).observations[0].z[0], expected[step], 1e-12);
  }
  DlrOptions as_ahead;
  as_ahead.bearing_zero = DlrBearingZero::ahead;
  EXPECT_NEAR(scan(read(text.str(), as_ahead), 0).observations[0].z[0], expected[0] - core::pi / 2, 1e-12);
}

TEST(ReadDlr, NamesFileAndLineOfWhatIsWrong) {
  const std::string step = "STEP s 0 -0.2 0 1e-4 0 1e-4 0 0 1e-4\n";
  const auto error = [](const std::string& text) {
    const std::string message = helixnav::testing::input_error_of([&] { read(text); });
    return message.substr(message.find("map.txt"));
  };
  EXPECT_EQ(error(step + "LANDMARK_X 1\n"),
            "map.txt:2: unknown keyword 'LANDMARK_X'; expected STEP, LANDMARK_C, LANDMARK, LANDMARK_L or #");
  EXPECT_EQ(error("LANDMARK_C 1 1 1 1 0 1 5\n"), "map.txt:1: a landmark before the first STEP");
  EXPECT_EQ(error("# nothing\n").substr(8), "2: no STEP in this file");
  EXPECT_EQ(error("STEP s 0 -0.2 0 1e-4 0 1e-4 0 0\n").substr(0, 57),
            "map.txt:1: expected the covariance CPhiPhi of the step [r");
  EXPECT_EQ(error("STEP s 0 -0.2 0 1e-4 0 1e-4 0 0 1e-4 7\n"),
            "map.txt:1: more columns than a STEP has (10 after the keyword)");
  EXPECT_EQ(error("STEP s 0 -0.2 0 1e-4 0 -1e-4 0 0 1e-4\n"),
            "map.txt:1: the covariance of the step is not positive definite");
  EXPECT_EQ(error(step + "\nLANDMARK_C 1 1 1 1 2 1 5\n"),
            "map.txt:3: the covariance of the circle is not positive definite");
  EXPECT_NE(
      error(step + "LANDMARK_C 1 1 1 1 0 1\n").find("map.txt:2: expected an identifier of the landmark (-1: none)"),
      std::string::npos);
  EXPECT_EQ(error(step + "LANDMARK_C 1 1 1 1 0 1 -2\n"),
            "map.txt:2: identifiers are -1 (none) or not negative, found -2");
  EXPECT_NE(error(step + "LANDMARK_C 1 one 1 1 0 1 5\n").find("map.txt:2: expected pY of the circle [m], found 'one'"),
            std::string::npos);
  EXPECT_EQ(error(step + "LANDMARK_L 0 0 0 0 0.1 0 0 0 5\n"),
            "map.txt:2: the standard deviation of the line's bearing must be positive");
  EXPECT_EQ(error(step + "LANDMARK_C 1 1 1 1 0 1 5\nLANDMARK_L 0 0 0 0 0.1 0 0 0.1 5\n"),
            "map.txt:3: circles and lines in one file");
}

TEST(ReadDlr, CountsLinesOnBehindAContinuedOne) {
  const std::string message = helixnav::testing::input_error_of([&] { read(std::string(circles) + "STOP\n"); });
  EXPECT_NE(message.find("map.txt:10: unknown keyword 'STOP'"), std::string::npos) << message;
}

TEST(ReadDlr, JoinsAnyNumberOfLines) {
  std::string text = "STEP s 0 -0.2 0 1e-4 0 1e-4 0 0 1e-4\n";
  constexpr int lines_joined = 200'000;  // hours if each costs as much as the text after it
  text += "LANDMARK_C";
  for (int i = 0; i < lines_joined; ++i) text += " \\ \t\r\n";
  text += " 1 1 1 1 0 1 5\nSTOP\n";
  const std::string message = helixnav::testing::input_error_of([&] { read(text); });
  EXPECT_NE(message.find("map.txt:" + std::to_string(lines_joined + 3) + ": unknown keyword 'STOP'"), std::string::npos)
      << message;
}

void expect_same(const core::Recording& a, const core::Recording& b) {
  ASSERT_EQ(a.events.size(), b.events.size());
  EXPECT_EQ(a.labels, b.labels);
  ASSERT_EQ(a.shared_observations.size(), b.shared_observations.size());
  for (std::size_t k = 0; k < a.shared_observations.size(); ++k) {
    EXPECT_EQ(a.shared_observations[k].labels, b.shared_observations[k].labels);
  }
  for (std::size_t step = 0; step < a.labels.size(); ++step) {
    EXPECT_EQ(odometry(a, step).T_before_after.vector(), odometry(b, step).T_before_after.vector());
    EXPECT_EQ(odometry(a, step).covariance, odometry(b, step).covariance);
    for (std::size_t k = 0; k < a.labels[step].size(); ++k) {
      EXPECT_EQ(scan(a, step).observations[k].z, scan(b, step).observations[k].z);
      const Eigen::MatrixXd R = scan(a, step).observations[k].R;
      EXPECT_LE((R - scan(b, step).observations[k].R).norm(), 1e-15 * R.norm());
    }
  }
}

TEST(WriteDlr, ReadsBackTheSame) {
  for (const char* text : {circles, lines}) {
    const core::Recording recording = read(text);
    const helixnav::testing::TemporaryFolder folder;
    write_dlr(recording, folder.path() / "copy.txt");
    expect_same(recording, read_dlr(folder.path() / "copy.txt"));
  }
}

TEST(WriteDlr, RefusesWhatTheFormatCannotHold) {
  const helixnav::testing::TemporaryFolder folder;
  core::Recording recording = read(circles);
  std::get<core::Scan>(recording.events[1]).observations[0] = core::make_range(2.0, 0.1);
  EXPECT_THROW(write_dlr(recording, folder.path() / "copy.txt"), core::InputError);
  recording = read(circles);
  recording.events.emplace_back(core::AbsoluteFix());
  EXPECT_THROW(write_dlr(recording, folder.path() / "copy.txt"), core::InputError);
}

class DlrFile : public helixnav::testing::RealDataTest {};

TEST_F(DlrFile, OfRunEHasItsPublishedCountsAndSurvivesARoundTrip) {
  ASSERT_NO_FATAL_FAILURE(find_real_data("dlr/raw/map.circles"));
  if (IsSkipped()) return;
  const core::Recording recording = read_dlr(path_);
  ASSERT_EQ(recording.labels.size(), 3297u);
  std::size_t observations = 0;
  std::size_t unlabelled = 0;
  double length_m = 0.0;
  for (std::size_t step = 0; step < recording.labels.size(); ++step) {
    observations += recording.labels[step].size();
    for (const core::Label label : recording.labels[step]) unlabelled += label == core::no_label ? 1 : 0;
    length_m += odometry(recording, step).T_before_after.position_m().norm();
  }
  EXPECT_EQ(observations, 14745u);
  EXPECT_EQ(unlabelled, 436u);
  EXPECT_NEAR(length_m, 505.0, 2.0);
  const helixnav::testing::TemporaryFolder folder;
  write_dlr(recording, folder.path() / "copy.txt");
  expect_same(recording, read_dlr(folder.path() / "copy.txt"));
}

}  // namespace
}  // namespace helixnav::logs
