// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/reports/report.hpp"

#include <algorithm>
#include <regex>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "helixnav/core/decision_row.hpp"
#include "report/report_assets.hpp"
#include "run_example.hpp"
#include "unpacked.hpp"

namespace helixnav::reports {
namespace {

using runs::example_manifest;
using runs::example_map;
using runs::example_recording;
using runs::example_step;

runs::Run example_run(std::int64_t steps) {
  runs::Run run;
  run.manifest = example_manifest();
  for (std::int64_t k = 0; k < steps; ++k) run.steps.push_back(example_step(k));
  run.microseconds.assign(run.steps.size(), 12.3);
  run.map = example_map();
  const core::Recording recording = example_recording(steps);
  run.truth.poses = recording.true_poses;
  run.truth.landmarks = recording.true_landmarks;
  run.timing = {{"total_s", 3.25}};
  return run;
}

std::string render(const runs::Run& run) { return render_report(run, evaluation::evaluate(run)); }

nlohmann::json element(const std::string& page, const std::string& id) {
  const std::string opening = "<script id=\"" + id + "\" type=\"application/json\">";
  const std::size_t begin = page.find(opening) + opening.size();
  return nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

TEST(Report, HoldsTheRunInItsDataElement) {
  const nlohmann::json data = element(render(example_run(100)), "run-data");
  EXPECT_EQ(data["manifest"]["command"], example_manifest().command);
  EXPECT_EQ(data["seed"], "18446744073709551615");
  EXPECT_EQ(data["path"]["x"].size(), 100u);
  EXPECT_NEAR(data["path"]["x"][99].get<double>(), example_step(99).pose.mean.x_m, 1e-3);
  EXPECT_EQ(data["landmarks"].size(), 3u);
  EXPECT_EQ(data["true_landmarks"].size(), 2u);
  EXPECT_EQ(data["errors"]["x"].size(), 100u);
  EXPECT_EQ(data["heading"]["e"].size(), 100u);
  EXPECT_EQ(data["summary"]["closures"]["accepted"], 2);
  EXPECT_EQ(data["decisions"].size(), 9u);
  EXPECT_EQ(data["decisions"][0]["numbers"][1][0], "foreign_expected");
}

TEST(Report, HoldsCloudsConstellationAndRivalOfEachClosure) {
  runs::Run run = example_run(100);
  core::StepReport& closing = run.steps[17];  // six scans after the attempt that begins in step 11
  core::VerificationDecision test;
  test.verdict = core::VerificationDecision::Verdict::accepted;
  test.T_world_winner = {1.0, 2.0, 0.5};
  test.rival_matched = 3;
  test.T_world_rival = {7.0, 8.0, -0.5};
  closing.decisions = {test, core::decision_of({"closure", "accepted", {}})};
  closing.merged = {{2, 17}, {77, 18}};  // 77 has died since
  const nlohmann::json closure = element(render(run), "run-data")["closures"].at(1);
  EXPECT_EQ(closure["step"], 17);
  ASSERT_EQ(closure["views"].size(), 7u);
  EXPECT_EQ(closure["views"][3]["scans"], 3);
  EXPECT_EQ(closure["views"][3]["closing"], false);
  EXPECT_EQ(closure["views"][6]["closing"], true);
  const nlohmann::json clouds = element(render(run), "player-data")["clouds"];
  const std::vector<std::int64_t> at = unpacked(clouds["step"], 1);
  const auto cloud = std::find(at.begin(), at.end(), closure["views"][0]["step"]) - at.begin();
  ASSERT_LT(cloud, static_cast<std::ptrdiff_t>(at.size()));
  EXPECT_EQ(unpacked(clouds["count"], 1)[static_cast<std::size_t>(cloud)], 3);
  EXPECT_EQ(unpacked(clouds["y"], 1)[3 * static_cast<std::size_t>(cloud) + 2], -33);
  EXPECT_NEAR(closure["views"][6]["truth"][0].get<double>(), example_step(17).pose.mean.x_m, 5e-4);
  EXPECT_EQ(closure["winner"], nlohmann::json({1.0, 2.0, 0.5}));
  EXPECT_EQ(closure["rival"], nlohmann::json({7.0, 8.0, -0.5}));
  EXPECT_EQ(closure["matched"], nlohmann::json({{10.0, 0.333}}));
}

TEST(Report, HoldsHealthPathsAndMixtureOfACloudOfParticles) {
  runs::Run run = example_run(3);
  EXPECT_TRUE(element(render(run), "run-data")["particles"].is_null());
  for (core::StepReport& step : run.steps) step.particles = core::CloudReport{100, 40.0, false, 0.0, 9};
  // A stem of two points that splits into two ends.
  run.particle_end = runs::ParticleEnd{{{0, -1, {0.0, 0.0, 0.0}, 1.0},
                                        {1, 0, {1.0, 0.0, 0.0}, 1.0},
                                        {2, 1, {2.0, 0.0, 0.0}, 0.5},
                                        {2, 1, {2.0, 1.0, 0.0}, 0.5}},
                                       {{7, {{1.0, -2.0}, Eigen::Matrix2d::Identity()}, 0.9, 0.8},
                                        {8, {{1.0, -2.0}, Eigen::Matrix2d::Identity()}, 0.9, 0.4}}};
  const nlohmann::json data = element(render(run), "run-data"), particles = data["particles"];
  EXPECT_EQ(particles["health"]["effective"], nlohmann::json({40.0, 40.0, 40.0}));
  EXPECT_EQ(particles["health"]["ancestors"], nlohmann::json({9, 9, 9}));
  EXPECT_EQ(particles["paths"]["x"], nlohmann::json({2.0, 1.0, 0.0, nullptr, 2.0, 1.0, nullptr}));
  EXPECT_EQ(particles["paths"]["y"], nlohmann::json({0.0, 0.0, 0.0, nullptr, 1.0, 0.0, nullptr}));
  ASSERT_EQ(particles["mixture"].size(), 1u) << "only what most of the weight holds as mature";
  EXPECT_EQ(particles["mixture"][0]["id"], 7);
  EXPECT_EQ(data["summary"]["particles"]["ancestors_least"], 9);
}

TEST(Report, HoldsNamesTheAntennaOfFixesAndTheFrameOfAFusedMap) {
  runs::Run run = example_run(20);
  const nlohmann::json plain = element(render(run), "run-data");
  EXPECT_TRUE(plain["names"].is_null());
  EXPECT_TRUE(plain["antenna"].is_null());
  EXPECT_EQ(plain["frame"], "start");
  run.names[7] = "north pier";
  run.truth.positions = {{run.steps[3].t_ns, {1.0, 2.0}, 0.1}};
  run.truth.antenna_robot_m = {3.0, -0.5};
  run.steps[3].decisions = {core::FixDecision{}};
  const nlohmann::json data = element(render(run), "run-data");
  EXPECT_EQ(data["names"]["7"], "north pier");
  EXPECT_EQ(data["antenna"], nlohmann::json({3.0, -0.5}));
  EXPECT_EQ(data["frame"], "fixes");
}

TEST(Report, SaysOfASessionOnAnEarlierMapThatItsFrameIsThatOfThatMap) {
  runs::Run run = example_run(20);
  const auto frame = [&run] { return element(render(run), "run-data")["frame"].get<std::string>(); };
  run.manifest.command = "helixnav replay log --map.whole 100";
  EXPECT_EQ(frame(), "start");
  run.manifest.command = "helixnav replay log --map monday";
  EXPECT_EQ(frame(), "start") << "no place was found on it";
  core::PlacedDecision placed;
  placed.verdict = core::PlacedDecision::Verdict::accepted;
  run.steps[5].decisions = {placed};
  EXPECT_EQ(frame(), "earlier");
  run.steps[5].decisions.clear();
  run.manifest.command = "helixnav replay log --map monday --start 1,2,0.5";
  EXPECT_EQ(frame(), "earlier");
}

TEST(Report, EndsTheLineOfInnovationsWhereNothingIsUpdatedForLong) {
  runs::Run run = example_run(100);
  for (std::size_t k = 0; k < run.steps.size(); ++k) {
    run.steps[k].joint_dof = k >= 30 && k < 70 ? 0 : 2;
    run.steps[k].joint_nis = 2.0;
  }
  const nlohmann::json nis = element(render(run), "run-data")["nis"];
  ASSERT_EQ(nis["t"].size(), 61u);
  EXPECT_TRUE(nis["mean"][30].is_null());
  EXPECT_TRUE(nis["low"][30].is_null());
  EXPECT_EQ(std::count(nis["mean"].begin(), nis["mean"].end(), nullptr), 1);
}

TEST(Report, ShowsTentativeLandmarksWhereThereAreNoOthers) {
  runs::Run run = example_run(1);
  run.truth = {};
  run.map = {example_map().front()};
  run.map[0].state = core::LandmarkState::tentative;
  run.map[0].point.mean_m = {500.0, 0.0};
  EXPECT_GT(element(render(run), "run-data")["map_extent"][1].get<double>(), 500.0);
}

TEST(Report, LoadsNothingFromElsewhere) {
  std::string page = render(example_run(20));
  const std::size_t charts = page.find(report_charts);
  ASSERT_NE(charts, std::string::npos) << "the charting library is not inside";
  page.erase(charts, report_charts.size());
  EXPECT_EQ(page.find("http://"), std::string::npos);
  EXPECT_EQ(page.find("https://"), std::string::npos);
  EXPECT_FALSE(std::regex_search(page, std::regex(R"(<(script|img|iframe|link)[^>]*\s(src|href)=)")));
  EXPECT_EQ(page.find("@import"), std::string::npos);
  EXPECT_EQ(page.find("{{"), std::string::npos) << "a place of the template was left empty";
}

TEST(Report, KeepsWallClockFiguresInTheirElement) {
  runs::Run fast = example_run(50);
  runs::Run slow = fast;
  slow.microseconds.assign(50, 99999.9);
  std::string page = render(fast);
  slow.timing = {{"total_s", 77.0}};
  std::string other = render(slow);
  EXPECT_EQ(element(other, "wall-clock")["timing"]["total_s"], 77.0);
  EXPECT_EQ(element(other, "wall-clock")["steps"]["max_us"][0], 99999.9);
  for (std::string* text : {&page, &other}) {
    const std::size_t begin = text->find("<script id=\"wall-clock\"");
    text->erase(begin, text->find("</script>", begin) - begin);
  }
  EXPECT_TRUE(page == other);
}

TEST(Report, CannotBeBrokenByTextsOfTheUser) {
  runs::Run run = example_run(20);
  run.manifest.recording = "</script><b>\xff{{script}}";
  run.steps[3].decisions.push_back(core::decision_of({"<!--", "<script>", {{"</script>", 1.0}}}));
  const std::string page = render(run);
  EXPECT_EQ(element(page, "run-data")["manifest"]["recording"], "</script><b>\xef\xbf\xbd{{script}}");
  EXPECT_EQ(page.find("</script><b>"), std::string::npos);
}

TEST(Report, ThinsLongRunsAndStaysSmall) {
  const std::string page = render(example_run(7300));
  EXPECT_LT(page.size(), 3'000'000u);
  const nlohmann::json data = element(page, "run-data");
  EXPECT_LE(data["path"]["x"].size(), 3650u);
  EXPECT_LE(data["nis"]["t"].size(), 240u);
  EXPECT_LE(element(page, "wall-clock")["steps"]["t"].size(), 1200u);
}

TEST(Report, HoldsWhatASmootherMadeOfTheRun) {
  runs::Run run = example_run(20);
  EXPECT_TRUE(element(render(run), "run-data")["smoothing"].is_null());
  runs::SmoothedRun smoothed;
  smoothed.alone = true;
  smoothed.poses = {{1.0, 2.0, 0.1}, {3.0, 4.0, 0.2}};
  smoothed.poses_before = {{-1.0, 2.0, 0.1}, {-3.0, 4.0, 0.2}};
  smoothed.map_before = smoothed.map_after = example_map();
  smoothed.chi2 = {900.0, 20.5};
  smoothed.chi2_odometry = 8.25;
  smoothed.chi2_landmarks = 12.25;
  smoothed.dof = 10;
  smoothed.largest = {{7, "pose 7 sees landmark 4", 9.5, 2}};
  smoothed.normalised_residuals = {{3, 0.5}, {4, -2.5}};
  run.smoothed = smoothed;
  const nlohmann::json data = element(render(run), "run-data")["smoothing"];
  EXPECT_EQ(data["alone"], true);
  EXPECT_EQ(data["path"]["x"], (nlohmann::json{1.0, 3.0}));
  EXPECT_EQ(data["path_before"]["x"], (nlohmann::json{-1.0, -3.0}));
  EXPECT_EQ(data["chi2"], (nlohmann::json{900.0, 20.5}));
  EXPECT_EQ(data["chi2_odometry"], 8.25);
  EXPECT_EQ(data["dof"], 10);
  EXPECT_EQ(data["largest"][0]["name"], "pose 7 sees landmark 4");
  EXPECT_EQ(data["residuals"]["inside_2sigma"], 0.5);
}

TEST(Report, OfARunWithoutStepsIsAPageToo) {
  runs::Run run;
  run.manifest = example_manifest();
  const nlohmann::json data = element(render(run), "run-data");
  EXPECT_EQ(data["summary"]["steps"], 0);
  EXPECT_TRUE(data["errors"].is_null());
  EXPECT_FALSE(data["finished"]);
}

}  // namespace
}  // namespace helixnav::reports
