// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/runs/drive_digest.hpp"

#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/files/file.hpp"
#include "helixnav/runs/joint_map_file.hpp"
#include "helixnav/runs/map_folder.hpp"
#include "temporary_folder.hpp"

namespace helixnav::runs {
namespace {

core::Scan scan_of(int number, int observations, double sigma_m = 0.1) {
  core::Scan scan;
  scan.t_ns = number * 100'000'000LL;
  for (int i = 0; i < observations; ++i)
    scan.observations.push_back(core::make_range_bearing(5.0 + 0.1 * number + i, 0.1 * i, sigma_m, 0.01));
  return scan;
}

std::vector<core::Event> drive(int scans, double sigma_m = 0.1) {
  std::vector<core::Event> events;
  for (int k = 0; k < scans; ++k) events.emplace_back(scan_of(k, 5, sigma_m));
  return events;
}

TEST(DriveDigest, StaysHoweverFarTheDriveGoesAndHoweverItsNoiseIsTold) {
  const std::vector<std::string> one = drives_of(drive(4));
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one.front().size(), 64u);
  EXPECT_EQ(drives_of(drive(50)), one);
  EXPECT_EQ(drives_of(drive(50, 0.3)), one);
}

TEST(DriveDigest, IsAnotherOneOfAnotherDrive) {
  std::vector<core::Event> other = drive(4);
  std::get<core::Scan>(other[2]).observations[1].z[0] += 1e-9;
  EXPECT_NE(drives_of(other), drives_of(drive(4)));
  std::vector<core::Event> later = drive(4);
  std::get<core::Scan>(later[0]).t_ns -= 1;
  EXPECT_NE(drives_of(later), drives_of(drive(4)));
}

TEST(DriveDigest, IsNoneOfADriveThatSawNearlyNothing) { EXPECT_TRUE(drives_of(drive(3)).empty()); }

TEST(DriveDigest, GoesWithTheMapIntoItsFolder) {
  const testing::TemporaryFolder folder;
  core::JointMap map;
  map.joint.covariance = Eigen::Matrix3d::Zero();
  map.drives = united_drives(drives_of(drive(4)), {std::string(64, 'a')});
  write_map(folder.path().string(), map);
  EXPECT_EQ(read_drives(folder.path().string()), map.drives);
  map.drives.clear();
  write_map(folder.path().string(), map);
  EXPECT_TRUE(read_drives(folder.path().string()).empty()) << "nothing is left of the map before";
  files::write_whole_file((folder.path() / "drives.csv").string(), "sha256\nabc\n");
  EXPECT_THROW(read_drives(folder.path().string()), core::InputError);
}

}  // namespace
}  // namespace helixnav::runs
