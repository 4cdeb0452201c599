// SPDX-License-Identifier: BSD-3-Clause
#include "player/report_player.hpp"

#include <gtest/gtest.h>

#include "helixnav/core/decision_row.hpp"
#include "helixnav/reports/report.hpp"
#include "player/report_clouds.hpp"
#include "run_example.hpp"
#include "unpacked.hpp"

namespace helixnav::reports {
namespace {

Json player_of(const runs::Run& run) { return player_data(run, evaluation::evaluate(run)); }

/// A drive along x, 1 m a scan, past two posts. The first is seen as landmark 3, from scan 5 on as 8, and 8 is merged
/// into 3 in scan 6; the second is 4, seen once and lost.
runs::Run short_drive() {
  core::Recording recording;
  for (int k = 0; k < 8; ++k) {
    core::Scan scan;
    scan.t_ns = k * 100'000'000;
    scan.observations = {core::make_cartesian({2.0 - k, 3.0}, Eigen::Matrix2d::Identity())};
    if (k == 2) scan.observations.push_back(core::make_bearing(0.5, 0.1));
    recording.events.emplace_back(scan);
  }
  runs::RunRecorder recorder("run", {}, recording);
  for (int k = 0; k < 8; ++k) {
    core::StepReport step;
    step.step = k;
    step.t_ns = k * 100'000'000;
    step.mode = k == 5 ? core::Mode::searching : core::Mode::mapping;
    step.pose.mean = {1.0 * k, 0.0, 0.0};
    const bool begins = k == 0 || k == 5;
    step.associations = {{0, begins ? core::Outcome::augmented : core::Outcome::matched, k < 5 ? 3 : 8, 1.0, 2, 1.0}};
    if (k == 2) step.associations.push_back({1, core::Outcome::augmented, 4, 1.0, 1, 1.0});
    if (k == 6) step.merged = {{3, 8}};
    if (k == 6) step.solved = {{0, {0.0, 0.5, 0.0}}, {600'000'000, {6.0, 0.5, 0.0}}};
    recorder.add(step, 1.0);
    core::MapLandmark post;
    post.id = 3;
    post.point = {{2.0, 3.0}, Eigen::Matrix2d::Identity() * 0.01};
    if (recorder.wants_map()) recorder.add_map({post});
  }
  core::MapLandmark post;
  post.id = 3;
  post.point = {{2.5, 3.0}, Eigen::Matrix2d::Identity() * 0.01};
  return recorder.finish({post});
}

TEST(Player, HoldsEveryPoseAndModeOfTheDrive) {
  const Json player = player_of(short_drive());
  EXPECT_EQ(player["steps"], 8);
  EXPECT_EQ(unpacked(player["path"]["x"], 1), (std::vector<std::int64_t>{0, 100, 200, 300, 400, 500, 600, 700}));
  EXPECT_EQ(unpacked(player["path"]["t"], 2).back(), 700);
  EXPECT_EQ(player["modes"], Json({{0, 0}, {5, 1}, {6, 0}}));
}

TEST(Player, HoldsScansAsPointsOfTheRobotWithTheirLandmarks) {
  const Json scans = player_of(short_drive())["scans"];
  EXPECT_EQ(unpacked(scans["count"], 0), (std::vector<std::int64_t>{1, 1, 2, 1, 1, 1, 1, 1}));
  const std::vector<std::int64_t> who = unpacked(scans["who"], 0);
  EXPECT_EQ(who[0], 3 * 8 + 4 + 1) << "landmark 3, a point, augmented";
  EXPECT_EQ(who[1], 0 * 8 + 4 + 0) << "the same landmark, matched";
  EXPECT_EQ(who[3], 1 * 8 + 0 + 1) << "landmark 4, a bearing alone is no point";
  EXPECT_EQ(unpacked(scans["x"], 0), (std::vector<std::int64_t>{200, 100, 0, -100, -200, -300, -400, -500}));
}

TEST(Player, KnowsWhenLandmarksWereBornMovedAndMerged) {
  const Json player = player_of(short_drive());
  const Json& landmarks = player["landmarks"];
  EXPECT_EQ(unpacked(landmarks["id"], 1), (std::vector<std::int64_t>{3, 8}));
  EXPECT_EQ(unpacked(landmarks["until"], 1), (std::vector<std::int64_t>{-1, 6}));
  EXPECT_EQ(unpacked(landmarks["step"], 1).front(), 2 * 0 + 0) << "begun in scan 0, tentative";
  const std::vector<std::int64_t> x = unpacked(landmarks["x"], 1);
  EXPECT_EQ(x.front(), 200);
  EXPECT_EQ(x[static_cast<std::size_t>(unpacked(landmarks["count"], 0)[0]) - 1], 250) << "where it was at the end";
  EXPECT_EQ(unpacked(player["merges"]["removed"], 1), std::vector<std::int64_t>{8});
}

TEST(Player, HoldsTheCorrectedPathWhereOneIsKnown) {
  const Json player = player_of(short_drive());
  EXPECT_EQ(unpacked(player["final"]["y"], 1), (std::vector<std::int64_t>{50, 50, 50, 50, 50, 50, 50, 0}));
  runs::Run run = short_drive();
  run.final_path.clear();
  EXPECT_TRUE(player_of(run)["final"].is_null());
}

TEST(Player, OfARunFromItsFolderShowsTheMapOfTheEnd) {
  runs::Run run = short_drive();
  run.map_changes.clear();
  run.scans.clear();
  const Json player = player_of(run);
  EXPECT_EQ(unpacked(player["landmarks"]["id"], 1), std::vector<std::int64_t>{3});
  EXPECT_EQ(unpacked(player["landmarks"]["x"], 1), std::vector<std::int64_t>{250});
  EXPECT_EQ(player["scans"]["x"], "");
}

TEST(Player, OfAHundredRefusedSearchesStaysUnderThreeMegabytes) {
  runs::Run run;
  core::RandomStream random(1, "clouds");
  for (int k = 0; k < 2000; ++k) {
    core::StepReport& step = run.steps.emplace_back();
    step.step = k;
    step.t_ns = k * 100'000'000LL;
    step.pose.mean = {0.5 * k, 0.0, 0.0};
    if (k % 20 >= 5) continue;
    for (int i = 0; i < 500; ++i) {
      step.cloud.emplace_back(random.uniform(-200.0, 200.0), random.uniform(-200.0, 200.0), random.uniform(-3.0, 3.0));
    }
    if (k % 20 == 0) step.decisions.push_back(core::decision_of({"search", "started", {{"attempt", 1.0}}}));
    if (k % 20 == 4) step.decisions.push_back(core::decision_of({"closure", "refused", {}}));
  }
  const Json clouds = clouds_data(run);
  std::int64_t particles = 0;
  for (const std::int64_t count : unpacked(clouds["count"], 1)) particles += count;
  EXPECT_LE(particles, static_cast<std::int64_t>(most_particles + 500));
  EXPECT_GE(particles, static_cast<std::int64_t>(most_particles) / 3);
  EXPECT_LT(render_report(run, evaluation::evaluate(run)).size(), 3'000'000u);
}

/// A drive along x of 100 000 scans with 10 observations each.
runs::Run long_drive() {
  runs::Run run;
  core::RandomStream random(1, "long");
  constexpr int scans = 100'000;
  for (int k = 0; k < scans; ++k) {
    core::StepReport& step = run.steps.emplace_back();
    step.step = k;
    step.t_ns = k * 100'000'000LL;
    step.pose.mean = {0.5 * k + random.uniform(), random.uniform(), 0.001 * k};
    step.pose.covariance = Eigen::Vector3d(0.01 + 1e-6 * k, 0.02, 1e-4).asDiagonal();
    std::vector<Eigen::Vector2f>& points_m = run.scans.emplace_back();
    for (int i = 0; i < 10; ++i) {
      const int landmark = static_cast<int>(k / 20 + random.uniform(0.0, 40.0));
      step.associations.push_back({i, core::Outcome::matched, landmark, 1.0, 2, 1.0});
      points_m.emplace_back(static_cast<float>(random.uniform(-40.0, 40.0)),
                            static_cast<float>(random.uniform(-40.0, 40.0)));
    }
  }
  return run;
}

/// A new landmark every scan, each reported three times: when it began, as mature, and in its final position.
void put_wide_map(runs::Run& run) {
  core::RandomStream random(1, "wide");
  constexpr std::int64_t between = 250;
  const auto steps = static_cast<std::int64_t>(run.steps.size());
  for (std::int64_t end = between; end <= steps; end += between) {
    runs::MapChange& change = run.map_changes.emplace_back();
    change.step = end - 1;
    for (std::int64_t id = std::max<std::int64_t>(0, end - 3 * between); id < end; ++id) {
      core::MapLandmark landmark;
      landmark.id = id;
      landmark.state = id < end - between ? core::LandmarkState::mature : core::LandmarkState::tentative;
      landmark.point.mean_m = {0.5 * static_cast<double>(id) + random.uniform(), random.uniform(-40.0, 40.0)};
      landmark.point.covariance_m2 = Eigen::Vector2d(random.uniform(), random.uniform()).asDiagonal();
      change.changed.push_back(landmark);
      if (id < end - 2 * between) run.map.push_back(landmark);
    }
  }
}

TEST(Player, OfAHundredThousandScansStaysUnderFifteenMegabytes) {
  const runs::Run run = long_drive();
  const evaluation::Evaluation evaluation = evaluation::evaluate(run);
  EXPECT_EQ(player_data(run, evaluation)["scans"]["stride"], 1);
  EXPECT_LT(render_report(run, evaluation).size(), 15'000'000u);
}

TEST(Player, OfAHundredThousandScansAndLandmarksShowsFewerScansToStayUnderFifteenMegabytes) {
  runs::Run run = long_drive();
  put_wide_map(run);
  const evaluation::Evaluation evaluation = evaluation::evaluate(run);
  const Json player = player_data(run, evaluation);
  EXPECT_EQ(unpacked(player["landmarks"]["id"], 1).size(), run.steps.size());
  EXPECT_EQ(player["scans"]["stride"], 2);
  const std::size_t size = render_report(run, evaluation).size();
  EXPECT_LT(size, 15'000'000u);
  EXPECT_GT(size, 8'000'000u);
}

}  // namespace
}  // namespace helixnav::reports
