// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/keep_scans.hpp"

#include <gtest/gtest.h>

namespace helixnav::apps {
namespace {

core::Recording three_scans() {
  core::Recording recording;
  for (int i = 0; i < 3; ++i) {
    core::Odometry odometry;
    odometry.t_ns = i;
    core::Scan scan;
    scan.t_ns = i;
    recording.events.emplace_back(odometry);
    recording.events.emplace_back(scan);
    recording.labels.emplace_back();
  }
  recording.events.emplace_back(core::Odometry());
  return recording;
}

TEST(KeepScans, EndsWithTheLastThatIsKept) {
  core::Recording recording = three_scans();
  keep_scans(recording, 2);
  EXPECT_EQ(recording.events.size(), 4u);
  EXPECT_EQ(recording.labels.size(), 2u);
  EXPECT_EQ(scans_of(recording), 2u);
}

TEST(KeepScans, LeavesAShorterLogAsItIs) {
  core::Recording recording = three_scans();
  keep_scans(recording, 4);
  EXPECT_EQ(recording.events.size(), 7u);
  keep_scans(recording, 3);
  EXPECT_EQ(recording.events.size(), 6u) << "what comes after the last scan says nothing";
  keep_scans(recording, 0);
  EXPECT_TRUE(recording.events.empty());
}

}  // namespace
}  // namespace helixnav::apps
