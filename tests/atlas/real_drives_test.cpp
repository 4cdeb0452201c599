// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "atlas_access.hpp"
#include "helixnav/logs/dlr.hpp"
#include "helixnav/logs/pose_landmark_text.hpp"
#include "helixnav/smoothing/grow_start.hpp"
#include "phases_of_graph.hpp"
#include "real_data.hpp"
#include "small_drive.hpp"

namespace helixnav::atlas {
namespace {

class RealDrive : public helixnav::testing::RealDataTest {
 protected:
  static double rms_m(const Atlas& atlas, const smoothing::Problem& optimum) {
    double sum = 0.0;
    for (std::size_t i = 0; i < optimum.graph.landmarks.size(); ++i) {
      sum += (atlas.landmark(static_cast<core::LandmarkId>(i)) - optimum.graph.landmarks[i].point_m).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(optimum.graph.landmarks.size()));
  }
};

TEST_F(RealDrive, ThroughVictoriaParkIsTheOptimumLiveToCentimetresAndExactlyOnceLinearisedThere) {
  ASSERT_NO_FATAL_FAILURE(find_real_data("victoria_park_graph/raw/isam_victoriaPark.txt"));
  if (IsSkipped()) return;
  const core::Recording recording = logs::read_pose_landmark_text(path_);
  smoothing::Problem problem = smoothing::build_problem(recording.events, recording.labels);
  Atlas atlas;
  for (const auto& log : testing::phases_of_graph(problem.graph, 20.0)) testing::add_phase(atlas, log);
  smoothing::grow_start(problem);
  testing::solve(problem);
  // The twin steps only if a step promises a gain: landmarks pushed to and fro make it take some more.
  double chi2 = 0.0;
  for (int more = 0; more < 6; ++more) {
    double push_m = 1e-5;
    for (auto& landmark : problem.graph.landmarks) landmark.point_m.x() += push_m *= -1.0;
    chi2 = testing::solve(problem);
  }
  EXPECT_NEAR(chi2, 6183.933, 1e-3);
  EXPECT_LT(rms_m(atlas, problem), 0.02);
  AtlasAccess::settle_with(atlas, testing::exact());
  EXPECT_NEAR(atlas.chi2(), chi2, 1e-5);
  EXPECT_LT(rms_m(atlas, problem), 1e-6);
}

TEST_F(RealDrive, OfDlrHasThePublishedChi2) {
  ASSERT_NO_FATAL_FAILURE(find_real_data("dlr/raw/map.circles"));
  if (IsSkipped()) return;
  const core::Recording recording = logs::read_dlr(path_);
  const smoothing::Problem problem = smoothing::build_problem(recording.events, recording.labels);
  Atlas atlas;
  for (const auto& log : testing::phases_of_graph(problem.graph, 5.0)) testing::add_phase(atlas, log);
  AtlasAccess::settle_with(atlas, testing::exact());
  EXPECT_NEAR(atlas.chi2(), 56871.45, 0.01);
}

}  // namespace
}  // namespace helixnav::atlas
