// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/runs/run_folder.hpp"

#include <sys/wait.h>
#include <unistd.h>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "helixnav/core/random.hpp"
#include "helixnav/files/file.hpp"
#include "input_error.hpp"
#include "run_example.hpp"
#include "tables/put_association.hpp"
#include "temporary_folder.hpp"

namespace helixnav::runs {
namespace {

namespace fs = std::filesystem;
using helixnav::testing::input_error_of;
using helixnav::testing::TemporaryFolder;

void expect_same(const core::AssociationReport& a, const core::AssociationReport& b) {
  EXPECT_EQ(a.observation, b.observation);
  EXPECT_EQ(a.outcome, b.outcome);
  EXPECT_EQ(a.landmark, b.landmark);
  EXPECT_EQ(a.nis, b.nis);
  EXPECT_EQ(a.dof, b.dof);
  EXPECT_EQ(a.margin_nats, b.margin_nats);
}

void expect_same(const core::StepReport& a, const core::StepReport& b) {
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.t_ns, b.t_ns);
  EXPECT_EQ(a.mode, b.mode);
  EXPECT_EQ(a.pose.mean.x_m, b.pose.mean.x_m);
  EXPECT_EQ(a.pose.mean.y_m, b.pose.mean.y_m);
  EXPECT_NEAR(a.pose.mean.heading_rad, b.pose.mean.heading_rad, 1e-15);
  EXPECT_EQ(a.pose.covariance, b.pose.covariance);
  EXPECT_EQ(a.joint_nis, b.joint_nis);
  EXPECT_EQ(a.joint_dof, b.joint_dof);
  EXPECT_EQ(a.numerics.least_pivot, b.numerics.least_pivot);
  EXPECT_EQ(a.numerics.asymmetry, b.numerics.asymmetry);
  EXPECT_EQ(a.numerics.repaired, b.numerics.repaired);
  EXPECT_EQ(a.numerics.refused, b.numerics.refused);
  EXPECT_EQ(a.active_landmarks, b.active_landmarks);
  EXPECT_EQ(a.mapped_landmarks, b.mapped_landmarks);
  EXPECT_EQ(a.switched_region, b.switched_region);
  ASSERT_EQ(a.associations.size(), b.associations.size());
  for (std::size_t i = 0; i < a.associations.size(); ++i) expect_same(a.associations[i], b.associations[i]);
  ASSERT_EQ(a.decisions.size(), b.decisions.size());
  for (std::size_t i = 0; i < a.decisions.size(); ++i) {
    const core::DecisionRow one = core::row_of(a.decisions[i]), other = core::row_of(b.decisions[i]);
    EXPECT_EQ(one.kind, other.kind);
    EXPECT_EQ(one.verdict, other.verdict);
    EXPECT_EQ(one.numbers, other.numbers);
  }
  ASSERT_EQ(a.merged.size(), b.merged.size());
  for (std::size_t i = 0; i < a.merged.size(); ++i) {
    EXPECT_EQ(a.merged[i].kept, b.merged[i].kept);
    EXPECT_EQ(a.merged[i].removed, b.merged[i].removed);
  }
  const bool keeps_cloud = std::set<std::int64_t>{11, 12, 14, 17}.count(b.step % 40) > 0;
  const std::vector<core::Pose2>& kept = b.drawn.empty() ? b.cloud : b.drawn;
  ASSERT_EQ(a.cloud.size(), keeps_cloud ? kept.size() : 0u) << b.step;
  for (std::size_t i = 0; i < a.cloud.size(); ++i) EXPECT_EQ(a.cloud[i].vector(), kept[i].vector());
}

void write_without_end(const std::string& folder, std::int64_t steps) {
  RunWriter writer(folder, example_manifest(), {});
  for (std::int64_t k = 0; k < steps; ++k) writer.write(example_step(k), 10.0);
}

TEST(RunFolder, ReadsBackExactlyWhatWasWritten) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "run").string();
  write_example(path, 100);
  const runs::Run run = read_run(path);
  EXPECT_TRUE(run.finished);
  ASSERT_EQ(run.steps.size(), 100u);
  for (std::int64_t k = 0; k < 100; ++k) expect_same(run.steps[static_cast<std::size_t>(k)], example_step(k));
  EXPECT_EQ(run.microseconds, std::vector<double>(100, 12.3));
  ASSERT_EQ(run.map.size(), 3u);
  EXPECT_EQ(run.map[1].point.mean_m, example_map()[1].point.mean_m);
  EXPECT_EQ(run.map[2].state, core::LandmarkState::tentative);
  EXPECT_EQ(run.manifest.seed, example_manifest().seed);
  EXPECT_EQ(run.manifest.command, example_manifest().command);
  EXPECT_EQ(run.truth.labels[7], std::vector<core::Label>(7, 4));
  EXPECT_EQ(run.truth.poses[99].t_ns, example_step(99).t_ns);
}

TEST(RunFolder, ReadsToTheLastCompleteStepWhereverAnyTableIsCut) {
  constexpr std::int64_t written = 60;
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "run").string();
  write_without_end(path, written);
  core::RandomStream random(3, "cuts");
  for (const char* table :
       {"trajectory.tum", "associations.csv", "decisions.csv", "merges.csv", "clouds.csv", "health.csv"}) {
    const std::string file = path + '/' + table;
    const std::string whole = files::read_whole_file(file);
    for (int trial = 0; trial < 60; ++trial) {
      const std::size_t cut = trial < 5 ? static_cast<std::size_t>(trial) : random.below(whole.size());
      std::ofstream(file, std::ios::binary) << whole.substr(0, cut);
      const runs::Run run = read_run(path);
      ASSERT_LE(run.steps.size(), static_cast<std::size_t>(written));
      for (const core::StepReport& step : run.steps) expect_same(step, example_step(step.step));
      if (std::string(table) == "trajectory.tum") {
        const auto lines = std::count(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(cut), '\n');
        EXPECT_EQ(static_cast<std::ptrdiff_t>(run.steps.size()), std::max<std::ptrdiff_t>(lines - 1, 0));
      }
    }
    std::ofstream(file, std::ios::binary) << whole;
  }
  EXPECT_EQ(read_run(path).steps.size(), static_cast<std::size_t>(written));
}

TEST(RunFolder, NamesAFolderThatIsThereInPlaceOfAFile) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "run").string();
  write_example(path, 20);
  for (const char* name : {"manifest.json", "health.csv", "trajectory.tum", "associations.csv", "decisions.csv",
                           "merges.csv", "clouds.csv", "map.csv", "truth_poses.csv", "summary.json"}) {
    const std::string file = path + '/' + name;
    const std::string whole = files::read_whole_file(file);
    fs::remove(file);
    fs::create_directory(file);
    EXPECT_EQ(input_error_of([&] { read_run(path); }), file + ": expected a file, found a folder");
    fs::remove(file);
    std::ofstream(file, std::ios::binary) << whole;
  }
  EXPECT_EQ(read_run(path).steps.size(), 20u);
}

TEST(RunFolder, HasTheCloudReportsOfTheStepsThatHaveThem) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "run").string();
  const auto cloud_of = [](std::int64_t k) {
    return core::CloudReport{100, 99.0 / static_cast<double>(k), k % 2 == 1, -1.0 / 3.0, static_cast<std::size_t>(k)};
  };
  {
    RunWriter writer(path, example_manifest(), {});
    for (std::int64_t k = 0; k < 20; ++k) {
      core::StepReport step = example_step(k);
      if (k % 5 != 0) step.particles = cloud_of(k);
      writer.write(step, 10.0);
    }
  }
  const runs::Run run = read_run(path);
  ASSERT_EQ(run.steps.size(), 20u);
  for (const core::StepReport& step : run.steps) {
    expect_same(step, example_step(step.step));
    ASSERT_EQ(step.particles.has_value(), step.step % 5 != 0) << step.step;
    if (!step.particles) continue;
    const core::CloudReport expected = cloud_of(step.step);
    EXPECT_EQ(step.particles->hypotheses, expected.hypotheses);
    EXPECT_EQ(step.particles->effective_size, expected.effective_size);
    EXPECT_EQ(step.particles->resampled, expected.resampled);
    EXPECT_EQ(step.particles->log_evidence, expected.log_evidence);
    EXPECT_EQ(step.particles->distinct_ancestors, expected.distinct_ancestors);
  }
  write_without_end((folder.path() / "without").string(), 20);
  EXPECT_FALSE(fs::exists(folder.path() / "without" / "particles.csv"));
}

TEST(RunFolder, IsReadableAfterTheWriterWasKilled) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "run").string();
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    RunWriter writer(path, example_manifest(), {});
    for (std::int64_t k = 0;; ++k) writer.write(example_step(k), 10.0);
  }
  while (!fs::exists(path + "/manifest.json") || fs::file_size(path + "/health.csv") < 5000) usleep(1000);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  const runs::Run run = read_run(path);
  EXPECT_GT(run.steps.size(), 20u);
  EXPECT_FALSE(run.finished);
  for (const core::StepReport& step : run.steps) expect_same(step, example_step(step.step));
}

TEST(RunFolder, TakesTheLastRevisionOfAnAssociation) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "run").string();
  RunWriter writer(path, example_manifest(), {});
  for (std::int64_t k = 0; k < 10; ++k) writer.write(example_step(k), 10.0);
  core::AssociationReport changed = example_step(5).associations[2];
  changed.landmark = 77;
  core::StepReport after = example_step(10);
  after.revised.push_back({5, {changed}});
  writer.write(after, 10.0);
  const runs::Run run = read_run(path);
  ASSERT_EQ(run.steps.size(), 11u);
  EXPECT_EQ(run.steps[5].associations[2].landmark, 77);
  EXPECT_EQ(run.steps[5].associations.size(), 5u);
  expect_same(run.steps[10], example_step(10));
}

TEST(RunFolder, RefusesAFolderWithoutManifest) {
  const TemporaryFolder folder;
  EXPECT_NE(input_error_of([&] { read_run(folder.path().string()); }).find("manifest.json"), std::string::npos);
}

struct Damage {
  const char* file;
  int line;
  const char* content;
  const char* expected;
};

class DamagedRun : public ::testing::TestWithParam<Damage> {};

TEST_P(DamagedRun, IsRefusedWithFileLineAndWhatWasExpected) {
  const Damage& damage = GetParam();
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "run").string();
  write_example(path, 20);
  const std::string file = path + '/' + damage.file;
  std::string text = files::read_whole_file(file);
  std::size_t begin = 0;
  for (int line = 1; line < damage.line; ++line) begin = text.find('\n', begin) + 1;
  text.replace(begin, text.find('\n', begin) - begin, damage.content);
  std::ofstream(file, std::ios::binary) << text;
  const std::string message = input_error_of([&] { read_run(path); });
  EXPECT_EQ(message.find(file + ':' + std::to_string(damage.line)), 0u) << message;
  EXPECT_NE(message.find(damage.expected), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, DamagedRun,
    ::testing::Values(Damage{"trajectory.tum", 3, "1 2 3", "expected 8"},
                      Damage{"trajectory.tum", 4, "1 2 x 0 0 0 0 1", "y is \"x\", expected a number"},
                      Damage{"health.csv", 1, "step,time", "expected \"step,t_s,mode"},
                      Damage{"health.csv", 5, "\x01\xff\x7f", "expected 23"},
                      Damage{"health.csv", 6, "1,1,mapping,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,1,0,0,0,0", "more than 3"},
                      Damage{"associations.csv", 4, "2,0,0,guessed,1,2,1,0", "one of matched"},
                      Damage{"decisions.csv", 2, "11,1,trigger,raised,sigma", "name=number"},
                      Damage{"merges.csv", 3, "11,5,-1", "from 0"}, Damage{"clouds.csv", 3, "11,0,inf,0", "finite"},
                      Damage{"map.csv", 2, "0,1,2,0,0,0,-5,mature", "from 0"},
                      Damage{"truth_poses.csv", 2, "1,nan,0,0", "finite"},
                      Damage{"truth_labels.csv", 2, "-1,0,4", "from 0"}));

TEST(RunTruth, IsReadFromOneFileOfAnyKind) {
  const TemporaryFolder folder;
  const auto positions = folder.write("gps.csv", "t_s,x,y,antenna_x,antenna_y\n1.5,2,3,3.78,0.5\n");
  const RunTruth truth = read_truth(positions.string());
  ASSERT_EQ(truth.positions.size(), 1u);
  EXPECT_EQ(truth.positions[0].t_ns, 1'500'000'000);
  EXPECT_EQ(truth.antenna_robot_m, Eigen::Vector2d(3.78, 0.5));
  const auto other = folder.write("other.csv", "a,b\n1,2\n");
  EXPECT_NE(input_error_of([&] { read_truth(other.string()); }).find("t_s,x,y,heading"), std::string::npos);
  EXPECT_NE(input_error_of([&] { read_truth(folder.path().string()); }).find("no truth"), std::string::npos);
}

TEST(HostileRunFolder, LabelsMakeRoomForWhatIsThereOnly) {
  const TemporaryFolder folder;
  const std::string header = "step,observation,label\n";
  const auto error = [&](const std::string& rows) {
    const auto file = folder.write("truth_labels.csv", header + rows);
    return input_error_of([&] { read_truth(file.string()); });
  };
  EXPECT_NE(error("99999999,0,1\n").find("truth_labels.csv:2: step is \"99999999\""), std::string::npos);
  EXPECT_NE(error("0,0,1\n0,99999999,1\n").find("truth_labels.csv:3: observation is \"99999999\""), std::string::npos);
  EXPECT_EQ(error("5,3,7\n100,0,1\n2,0,1\n"), "nothing thrown") << "steps and observations may be left out";
}

TEST(HostileRunFolder, ManifestsOfWhichAValueIsWrongAreRefusedByItsKey) {
  const TemporaryFolder folder;
  const std::string run = (folder.path() / "run").string();
  write_example(run, 3);
  const std::string file = run + "/manifest.json", whole = files::read_whole_file(file);
  const auto error = [&](const std::string& from, const std::string& to) {
    std::string text = whole;
    text.replace(text.find(from), from.size(), to);
    folder.write("run/manifest.json", text);
    return input_error_of([&] { read_run(run); });
  };
  const std::string begin = file + ": not a manifest of a run: ";
  EXPECT_EQ(error("\"seed\": ", "\"seed\": -1, \"was\": "),
            begin + "\"seed\" is -1, expected a whole number from 0 on");
  EXPECT_EQ(error("\"command\": ", "\"command\": [2], \"was\": "), begin + "\"command\" is [2], expected a text");
  EXPECT_EQ(error("\"recording\"", "\"other\""), begin + "\"recording\" is missing");
  EXPECT_EQ(error("\"inputs\": ", "\"inputs\": [7], \"was\": "), begin + "\"inputs\": \"name\" is missing");
  EXPECT_EQ(error("{", "{{"), begin + "no JSON");
}

TEST(RunFolder, OfATeamNamesThoseOfItsRobots) {
  const TemporaryFolder folder;
  const std::string path = folder.path().string();
  for (const char* robot : {"/robot_1", "/robot_3"}) write_example(path + robot, 3);
  EXPECT_EQ(input_error_of([&] { read_run(path); }),
            path + ": the folder of a team of robots; each has a run folder of its own: " + path + "/robot_1, " + path +
                "/robot_3");
}

TEST(HostileRunFolder, ManifestsThatNestDeeperThanOursAreRefused) {
  const TemporaryFolder folder;
  const std::string run = (folder.path() / "run").string();
  write_example(run, 3);
  const std::string deep = std::string(100'000, '[') + std::string(100'000, ']');
  for (const std::string& text : {deep, "{\"a\": \"]\",\n\"config\": " + deep + "}", std::string(100'000, '{')}) {
    folder.write("run/manifest.json", text);
    const std::string message = input_error_of([&] { read_run(run); });
    EXPECT_NE(message.find("JSON nested deeper than 64 levels"), std::string::npos) << message;
  }
  folder.write("run/manifest.json", "{\"config\": \"" + std::string(1000, '[') + "\\\"\"}");
  EXPECT_NE(input_error_of([&] { read_run(run); }).find("not a manifest"), std::string::npos) << "brackets in a string";
}

TEST(RunFolder, OfAnEarlierVersionHasNoNumericsAndIsRead) {
  const TemporaryFolder folder;
  const std::string run = (folder.path() / "run").string();
  write_example(run, 3);
  std::string earlier;
  std::istringstream rows(files::read_whole_file(run + "/health.csv"));
  for (std::string row; std::getline(rows, row);) {
    const std::size_t microseconds = row.rfind(',');
    std::size_t numerics = microseconds;
    for (int column = 0; column < 4; ++column) numerics = row.rfind(',', numerics - 1);
    earlier += row.erase(numerics, microseconds - numerics) + '\n';
  }
  folder.write("run/health.csv", earlier);
  const auto read = read_run(run);
  ASSERT_EQ(read.steps.size(), 3u);
  EXPECT_EQ(read.steps[2].joint_dof, example_step(2).joint_dof);
  EXPECT_EQ(read.steps[2].numerics.least_pivot, 1.0);
  EXPECT_EQ(read.microseconds.size(), 3u);
}

/// An Eigen comma initialiser left half full by an exception aborts in builds with assertions.
TEST(HostileRunFolder, NumbersThatAreNoneInACovarianceAreNamedByLine) {
  const TemporaryFolder folder;
  const std::string run = (folder.path() / "run").string();
  write_example(run, 3);
  std::string health = files::read_whole_file(run + "/health.csv");
  const std::size_t third_column = health.find("mapping,") + 8;
  health.replace(third_column, health.find(',', third_column) - third_column, "one");
  folder.write("run/health.csv", health);
  EXPECT_NE(input_error_of([&] { read_run(run); }).find("health.csv:2: sxx is \"one\""), std::string::npos);
  const auto map = folder.write("map.csv", "id,x,y,sxx,sxy,syy,observations,state\n1,0,0,1,x,1,5,mature\n");
  EXPECT_NE(input_error_of([&] { read_map(map.string()); }).find("map.csv:2: sxy is \"x\""), std::string::npos);
}

TEST(PutAssociation, KeepsTheObservationsOfAStepInOrder) {
  std::vector<core::StepReport> steps(1);
  for (const int observation : {3, 1, 2, 1, 0, 3}) {
    core::AssociationReport report;
    report.observation = observation;
    report.dof = static_cast<int>(steps[0].associations.size());
    put_association(0, report, steps);
  }
  ASSERT_EQ(steps[0].associations.size(), 4u);
  const int last_row_of[] = {3, 3, 2, 4};  // how many there were when the last row of each arrived
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(steps[0].associations[static_cast<std::size_t>(i)].observation, i);
    EXPECT_EQ(steps[0].associations[static_cast<std::size_t>(i)].dof, last_row_of[i]) << i;
  }
}

}  // namespace
}  // namespace helixnav::runs
