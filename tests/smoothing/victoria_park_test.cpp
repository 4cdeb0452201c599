// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "helixnav/logs/graph_files.hpp"
#include "helixnav/logs/pose_landmark_text.hpp"
#include "helixnav/smoothing/smooth.hpp"
#include "real_data.hpp"

namespace helixnav::smoothing {
namespace {

class VictoriaParkGraph : public helixnav::testing::RealDataTest {
 protected:
  static Report smoothed(const core::Recording& recording, Start start, int max_iterations = 200) {
    Problem problem = build_problem(recording.events, recording.labels);
    SmoothOptions options;
    options.start = start;
    options.solver.max_iterations = max_iterations;
    return smooth(problem, options);
  }
};

TEST_F(VictoriaParkGraph, OfISamReachesItsOptimumFromOdometryWhenGrown) {
  ASSERT_NO_FATAL_FAILURE(find_real_data("victoria_park_graph/raw/isam_victoriaPark.txt"));
  if (IsSkipped()) return;
  const Report report = smoothed(logs::read_pose_landmark_text(path_), Start::grown);
  EXPECT_EQ(report.reason, Reason::converged);
  EXPECT_EQ(report.dof, 6978);
  EXPECT_GT(report.chi2.total(), 6183.9);
  EXPECT_LT(report.chi2.total(), 6184.2);
}

TEST_F(VictoriaParkGraph, WithLabelsEndsInALocalMinimumFromOdometryAndInTheReferenceFromBetterStarts) {
  ASSERT_NO_FATAL_FAILURE(find_real_data("victoria_park_graph/raw/VicPark_clean_data.mat"));
  if (IsSkipped()) return;
  const core::Recording recording = logs::read_vicpark_clean(path_);
  const Report from_odometry = smoothed(recording, Start::as_given, 60);
  EXPECT_GT(from_odometry.chi2.total(), 1e6);
  const Report from_softened = smoothed(recording, Start::softened);
  EXPECT_EQ(from_softened.reason, Reason::converged);
  EXPECT_EQ(from_softened.dof, 90182);
  EXPECT_NEAR(from_softened.chi2.total(), 9012.72, 0.01);
}

}  // namespace
}  // namespace helixnav::smoothing
