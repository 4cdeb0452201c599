// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/plaza.hpp"

#include <cmath>
#include <set>
#include <string>

#include "input_error.hpp"
#include "real_data.hpp"
#include "temporary_folder.hpp"

namespace helixnav::logs {
namespace {

using testing::input_error_of;
using testing::TemporaryFolder;

class Plaza1 : public testing::RealDataTest {
 protected:
  void SetUp() override { find_real_data("plaza"); }
};

TEST_F(Plaza1, HasEveryRangeLabelledAndSplitsTheOdometryWithoutLoss) {
  const core::Recording recording = read_plaza(path_);
  core::Pose2 pose;
  std::size_t scans = 0;
  core::Nanoseconds last = 0;
  double way_m = 0.0;
  for (const core::Event& event : recording.events) {
    EXPECT_GE(core::time_of(event), last);
    last = core::time_of(event);
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
      way_m += odometry->T_before_after.position_m().norm();
    } else {
      const auto& scan = std::get<core::Scan>(event);
      if (scan.observations.empty()) continue;
      ASSERT_EQ(scan.observations.size(), 1u);
      EXPECT_EQ(scan.observations[0].kind, core::ObservationKind::range);
      ++scans;
    }
  }
  EXPECT_EQ(scans, 3529u);
  EXPECT_NEAR(way_m, 1861.2, 0.1);
  std::set<core::Label> beacons;
  for (const auto& labels : recording.labels) {
    beacons.insert(labels.begin(), labels.end());
  }
  EXPECT_EQ(beacons, (std::set<core::Label>{0, 1, 5, 6}));
  EXPECT_EQ(recording.true_positions.size(), 9658u);
  EXPECT_EQ(recording.true_landmarks.size(), 4u);
}

TEST(Plaza, SplitsAnIncrementAtARangeSoThatTheWholeComesBack) {
  const TemporaryFolder folder;
  folder.write("a_odometry.csv", "# t,d,h\n1.0,0.0,0.0\n2.0,2.0,0.5\n");
  folder.write("a_ranges.csv", "1.25,2,7,10.0\n");
  PlazaSettings settings;
  settings.range_scale = 1.25;
  const core::Recording recording = read_plaza(folder.path(), settings);
  ASSERT_EQ(recording.events.size(), 4u);
  const auto& first = std::get<core::Odometry>(recording.events[1]);
  const auto& second = std::get<core::Odometry>(recording.events[3]);
  EXPECT_NEAR(first.T_before_after.heading_rad, 0.125, 1e-15);
  const core::Pose2 whole = core::compose(first.T_before_after, second.T_before_after);
  EXPECT_NEAR(whole.x_m, 2.0 * std::sin(0.5) / 0.5, 1e-12);
  EXPECT_NEAR(whole.y_m, 2.0 * (1.0 - std::cos(0.5)) / 0.5, 1e-12);
  EXPECT_NEAR(first.covariance(0, 0) + second.covariance(0, 0),
              2.0 * settings.sigma_distance_m_per_sqrt_m * settings.sigma_distance_m_per_sqrt_m, 1e-15);
  EXPECT_EQ(std::get<core::Scan>(recording.events[2]).observations[0].z[0], 8.0);
  EXPECT_EQ(recording.labels, (std::vector<std::vector<core::Label>>{{7}}));
}

TEST(Plaza, NamesFileAndLineOfWhatIsWrong) {
  const TemporaryFolder folder;
  const auto error_of = [&](const std::string& odometry, const std::string& ranges) {
    const auto path = folder.write("a_odometry.csv", odometry);
    folder.write("a_ranges.csv", ranges);
    const std::string message = input_error_of([&] { read_plaza(path); });
    return message.substr(std::min(message.size(), folder.path().string().size() + 1));
  };
  EXPECT_EQ(error_of("1,0,0\n2,x,0\n", ""), "a_odometry.csv:2: expected a distance [m], found 'x'");
  EXPECT_EQ(error_of("1,0,0\n2,,0\n", ""), "a_odometry.csv:2: expected a distance [m], found an empty field");
  EXPECT_EQ(error_of("2,0,0\n1,0,0\n", ""),
            "a_odometry.csv:2: expected a time [s] that does not go backwards (2 … 4e+09), found '1'");
  EXPECT_EQ(error_of("1,0,0\n", "1,2,7\n"), "a_ranges.csv:1: expected a range [m], found the end of the line");
  EXPECT_EQ(error_of("1,0,0\n", "1,2,7,-3\n"), "a_ranges.csv:1: expected a range [m] (0 … 1e+05), found '-3'");
  EXPECT_EQ(error_of("1,0,0\n", "1,2,7,3,4\n"), "a_ranges.csv:1: more columns than time, antenna, beacon, range");
  EXPECT_EQ(error_of("# only words\n", ""),
            "a_odometry.csv: expected at least one row of time, distance, turn, found none");
}

TEST(Plaza, PutsRangesInOrderOfTimeAndAnEmptyScanWhereNoneCameForASecond) {
  const TemporaryFolder folder;
  folder.write("a_odometry.csv", "1,0,0\n9,8,0\n");
  folder.write("a_ranges.csv", "5,2,1,10\n6,2,2,10\n3,2,3,10\n");
  EXPECT_EQ(read_plaza(folder.path()).labels, (std::vector<std::vector<core::Label>>{{3}, {1}, {2}, {}}));
}

TEST(Plaza, AsksForOneRunWhereAFolderHoldsSeveral) {
  const TemporaryFolder folder;
  folder.write("a_odometry.csv", "1,0,0\n");
  folder.write("b_odometry.csv", "1,0,0\n");
  EXPECT_NE(input_error_of([&] { read_plaza(folder.path()); }).find("found several"), std::string::npos);
}

}  // namespace
}  // namespace helixnav::logs
