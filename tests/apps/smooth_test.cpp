// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "helixnav/evaluation/alignment.hpp"
#include "helixnav/runs/run_folder.hpp"
#include "program.hpp"
#include "real_data.hpp"
#include "sanitized.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class Smooth : public testing::RealDataTest {
 protected:
  fs::path folder(const char* name) const { return folder_.path() / name; }
  json summary(const char* name) const { return json::parse(text_of(folder(name) / "summary.json")); }
  void must(const std::vector<std::string>& words) const {
    const Outcome outcome = run(words);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }

  testing::TemporaryFolder folder_;
};

/// Landmarks of two runs over the same log, paired by the observations that both matched.
struct Pairs {
  std::vector<Eigen::Vector2d> a;
  std::vector<Eigen::Vector2d> b;
};

std::map<core::LandmarkId, Eigen::Vector2d> points(const runs::Run& run) {
  std::map<core::LandmarkId, Eigen::Vector2d> points;
  for (const core::MapLandmark& landmark : run.map) points[landmark.id] = landmark.point.mean_m;
  return points;
}

Pairs pair_landmarks(const runs::Run& a, const runs::Run& b) {
  std::map<core::LandmarkId, core::LandmarkId> partner;
  for (std::size_t k = 0; k < std::min(a.steps.size(), b.steps.size()); ++k) {
    const auto& of_b = b.steps[k].associations;
    for (const core::AssociationReport& x : a.steps[k].associations) {
      for (const core::AssociationReport& y : of_b) {
        if (x.observation == y.observation && x.landmark >= 0 && y.landmark >= 0) partner[x.landmark] = y.landmark;
      }
    }
  }
  const auto points_a = points(a);
  const auto points_b = points(b);
  Pairs pairs;
  for (const auto& [id_a, id_b] : partner) {
    pairs.a.push_back(points_a.at(id_a));
    pairs.b.push_back(points_b.at(id_b));
  }
  return pairs;
}

double rms_m(const Pairs& pairs, const core::Pose2& T_a_b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < pairs.a.size(); ++i) {
    sum += (pairs.a[i] - core::transform(T_a_b, pairs.b[i])).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(pairs.a.size()));
}

TEST_F(Smooth, TakesDlrRunEToThePublishedChi2) {
  find_real_data("dlr/raw/map.circles");
  if (IsSkipped()) return;
  must({"smooth", path_, "--out", folder("optimum")});
  EXPECT_NEAR(summary("optimum").at("chi2"), 56871.4, 0.1);
  EXPECT_EQ(summary("optimum").at("dof"), 27466);
  EXPECT_EQ(complete_lines(folder("optimum") / "trajectory_final.tum"), 3297u + 1u) << "steps and a header";
}

// The filter linearises once, a batch as often as needed: its map is near enough to the same optimum for ten steps.
TEST_F(Smooth, TakesTheFiltersDlrRunEToTheSameOptimumInTenIterations) {
  find_real_data("dlr/raw/map.circles");
  if (IsSkipped()) return;
  must({"replay", path_, "--association", "known", "--smooth", "--quiet", "--out", folder("run")});
  EXPECT_NEAR(summary("run").at("chi2_start"), 14.70e6, 0.01e6)
      << "of the map at the end and the path as estimated then";
  EXPECT_NEAR(summary("run").at("chi2"), 56871.4, 0.1);
  EXPECT_EQ(summary("run").at("dof"), 27466);
  EXPECT_LE(summary("run").at("iterations"), 10);
  EXPECT_EQ(summary("run").at("converged"), 1.0);
}

// From odometry the same log ends in a local minimum above 10^6: smoothing/victoria_park_test.cpp.
TEST_F(Smooth, TakesTheFiltersVictoriaParkToTheReferenceOptimum) {
  if (support::sanitized) return;  // the same code as FollowsAReplayWithTheFiltersOwnAssociations, three times as long
  find_real_data("victoria_park_graph/raw/VicPark_clean_data.mat");
  if (IsSkipped()) return;
  must({"replay", path_, "--association", "known", "--smooth", "--filter.cell_side_m", "15", "--filter.hysteresis_m",
        "5", "--quiet", "--out", folder("run")});
  EXPECT_NEAR(summary("run").at("chi2"), 9012.72, 0.01);
  EXPECT_EQ(summary("run").at("dof"), 90182);
  EXPECT_LE(summary("run").at("iterations"), 10);
}

TEST_F(Smooth, TellsTheRetractionsApartOnTheISamGraph) {
  find_real_data("victoria_park_graph/raw/isam_victoriaPark.txt");
  if (IsSkipped()) return;
  for (const char* retraction : {"right-invariant", "standard"}) {
    must({"replay", path_, "--association", "known", "--filter.retraction", retraction, "--quiet", "--out",
          folder(retraction)});
  }
  must({"smooth", path_, "--start", folder("right-invariant"), "--out", folder("optimum")});
  EXPECT_GT(summary("optimum").at("chi2"), 6183.9);
  EXPECT_LT(summary("optimum").at("chi2"), 6184.2);

  const runs::Run optimum = runs::read_run(folder("optimum"));
  std::map<std::string, std::pair<double, double>> aligned_and_raw_m;
  for (const char* retraction : {"right-invariant", "standard"}) {
    const Pairs pairs = pair_landmarks(optimum, runs::read_run(folder(retraction)));
    ASSERT_EQ(pairs.a.size(), 151u);
    const core::Pose2 T = evaluation::align_rigidly(pairs.a, pairs.b, 1e9).T_a_b;
    aligned_and_raw_m[retraction] = {rms_m(pairs, T), rms_m(pairs, core::Pose2())};
    std::printf("%s: landmark RMS %.3f m aligned, %.3f m raw\n", retraction, rms_m(pairs, T),
                rms_m(pairs, core::Pose2()));
  }
  EXPECT_GT(aligned_and_raw_m["right-invariant"].first, 0.5);
  EXPECT_LT(aligned_and_raw_m["right-invariant"].first, 0.65);
  EXPECT_GT(aligned_and_raw_m["right-invariant"].second, 1.0);
  EXPECT_LT(aligned_and_raw_m["right-invariant"].second, 1.3);
  EXPECT_GT(aligned_and_raw_m["standard"].first, 3.0);
  EXPECT_LT(aligned_and_raw_m["standard"].first, 3.6);
  EXPECT_GT(aligned_and_raw_m["standard"].second, 15.5);
  EXPECT_LT(aligned_and_raw_m["standard"].second, 18.5);
}

TEST_F(Smooth, FollowsAReplayWithTheFiltersOwnAssociations) {
  find_real_data("victoria_park_graph/raw/isam_victoriaPark.txt");
  if (IsSkipped()) return;
  must({"replay", path_, "--association", "known", "--smooth", "--quiet", "--out", folder("run")});
  EXPECT_GT(summary("run").at("chi2"), 6183.9);
  EXPECT_LT(summary("run").at("chi2"), 6184.2);
  EXPECT_EQ(summary("run").at("dof"), 6978);
  EXPECT_EQ(complete_lines(folder("run") / "trajectory_final.tum"), complete_lines(folder("run") / "trajectory.tum"));
}

TEST_F(Smooth, TakesALogOfSeveralFilesAndJudgesTheOptimum) {
  find_real_data("plaza/plaza1_odometry.csv");
  if (IsSkipped()) return;
  must({"smooth", path_.parent_path(), "--out", folder("optimum")});
  EXPECT_LT(summary("optimum").at("error").at("rmse_m"), 0.35) << "dead reckoning, the start, is off by metres";
  EXPECT_GE(json::parse(text_of(folder("optimum") / "manifest.json")).at("inputs").size(), 2u);
}

TEST_F(Smooth, TakesQuietLikeEveryCommandThatWritesARun) {
  std::ofstream(folder("graph.g2o")) << "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nVERTEX_XY 42 3 1\n"
                                        "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2_XY 1 42 2 1 1 0 1\n";
  must({"smooth", folder("graph.g2o"), "--quiet", "--out", folder("run")});
}

TEST_F(Smooth, NamesTheVariableThatNothingFixes) {
  std::ofstream(folder("graph.g2o")) << "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nVERTEX_SE2 7 2 0 0\nVERTEX_XY 42 3 1\n"
                                        "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2_XY 1 42 2 1 1 0 1\n";
  const Outcome outcome = run({"smooth", folder("graph.g2o"), "--out", folder("none")});
  EXPECT_TRUE(outcome.exit_code == 3 || outcome.exit_code == 4) << outcome.exit_code;
  EXPECT_NE(outcome.err.find("pose 7"), std::string::npos) << outcome.err;
}

TEST_F(Smooth, RefusesALogWithoutLabels) {
  find_real_data("victoria_park/raw/victoria_park_ascii.zip");
  if (IsSkipped()) return;
  const Outcome outcome = run({"smooth", path_, "--out", folder("none")});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.err.find("no labels"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace helixnav::apps
