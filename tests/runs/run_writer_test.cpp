// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/runs/run_writer.hpp"

#include <filesystem>
#include <fstream>
#include <regex>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "helixnav/files/file.hpp"
#include "helixnav/runs/run_folder.hpp"
#include "input_error.hpp"
#include "run_example.hpp"
#include "temporary_folder.hpp"

namespace helixnav::runs {
namespace {

namespace fs = std::filesystem;
using helixnav::testing::input_error_of;
using helixnav::testing::TemporaryFolder;

// The file without what docs/run-folder.md describes as wall clock.
std::string without_wall_clock(const fs::path& file) {
  std::string text = files::read_whole_file(file.string());
  if (file.filename() == "health.csv") text = std::regex_replace(text, std::regex(",[^,\n]*\n"), "\n");
  if (file.filename() == "summary.json") {
    nlohmann::ordered_json json = nlohmann::ordered_json::parse(text);
    json.erase("timing");
    text = json.dump();
  }
  if (file.filename() == "report.html") {
    const std::size_t begin = text.find("<script id=\"wall-clock\"");
    const std::size_t end = text.find("</script>", begin);
    EXPECT_NE(begin, std::string::npos);
    text.erase(begin, end - begin);
  }
  return text;
}

TEST(RunWriter, WritesEveryFileOfTheContract) {
  const TemporaryFolder folder;
  write_example((folder.path() / "run").string(), 20);
  for (const char* name :
       {"manifest.json", "trajectory.tum", "map.csv", "associations.csv", "decisions.csv", "merges.csv", "clouds.csv",
        "health.csv", "summary.json", "report.html", "truth_poses.csv", "truth_landmarks.csv", "truth_labels.csv"}) {
    EXPECT_TRUE(fs::exists(folder.path() / "run" / name)) << name;
  }
  EXPECT_FALSE(fs::exists(folder.path() / "run/truth_positions.csv")) << "the recording has none";
}

TEST(RunWriter, WritesTheSameBytesForTheSameInputExceptWallClockFigures) {
  const TemporaryFolder folder;
  write_example((folder.path() / "a").string(), 120, 12.3);
  write_example((folder.path() / "b").string(), 120, 45.6);
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder.path() / "a")) {
    const fs::path twin = folder.path() / "b" / entry.path().filename();
    EXPECT_EQ(without_wall_clock(entry.path()), without_wall_clock(twin)) << entry.path().filename();
    ++files;
  }
  EXPECT_EQ(files, 13);
}

TEST(RunWriter, HasManifestAndHeadersOnDiskBeforeTheFirstStep) {
  const TemporaryFolder folder;
  const std::string run = (folder.path() / "deep/run").string();
  const RunWriter writer(run, example_manifest(), {});
  EXPECT_EQ(files::read_whole_file(run + "/trajectory.tum"), "# t x y z qx qy qz qw\n");
  EXPECT_EQ(read_run(run).steps.size(), 0u);
  EXPECT_FALSE(read_run(run).finished);
}

TEST(RunWriter, RefusesANonEmptyFolderAndLeavesItAlone) {
  const TemporaryFolder folder;
  folder.write("notes.txt", "mine");
  const std::string message =
      input_error_of([&] { RunWriter(folder.path().string(), example_manifest(), core::Recording{}); });
  EXPECT_NE(message.find("not empty"), std::string::npos) << message;
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator{}), 1);
}

TEST(RunWriter, OverwritesTheFilesOfARunAndNoOthers) {
  const TemporaryFolder folder;
  const std::string run = folder.path().string();
  write_example(run, 20);
  folder.write("notes.txt", "mine");
  RunWriter(run, example_manifest(), core::Recording{}, RunWriter::IfNotEmpty::overwrite);
  EXPECT_TRUE(read_run(run).steps.empty());
  EXPECT_FALSE(fs::exists(run + "/summary.json"));
  EXPECT_FALSE(fs::exists(run + "/truth_poses.csv"));
  EXPECT_EQ(files::read_whole_file(run + "/notes.txt"), "mine");
}

TEST(RunWriter, KeepsItsFolderToItselfAsLongAsItLives) {
  const TemporaryFolder folder;
  const std::string run = (folder.path() / "run").string();
  const auto write_over = [&] { RunWriter(run, example_manifest(), {}, RunWriter::IfNotEmpty::overwrite); };
  {
    const RunWriter first(run, example_manifest(), {});
    EXPECT_NE(input_error_of(write_over).find("another process writes into this folder"), std::string::npos);
    EXPECT_TRUE(fs::exists(run + "/health.csv"));
  }
  write_over();
}

TEST(RunWriter, RefusesAFolderThatIsAFile) {
  const TemporaryFolder folder;
  const std::string file = folder.write("file", "x").string();
  EXPECT_NE(input_error_of([&] { RunWriter(file, example_manifest(), core::Recording{}); }).find(file),
            std::string::npos);
}

TEST(RunWriter, WritesThePathOfASmootherBesideThatOfTheSteps) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "run").string();
  runs::Run run = example_run(3);
  RunWriter writer(path, example_manifest(), {});
  for (std::int64_t k = 0; k < 3; ++k) writer.write(example_step(k), 0.0);
  SmoothedRun smoothed;
  smoothed.poses = {{1.0, 2.0, 0.0}, {3.0, 4.0, 0.0}, {5.0, 6.0, 0.0}};
  add_smoothed(run, smoothed);
  writer.finish(run, "page", "summary");
  const std::string text = files::read_whole_file(path + "/trajectory_final.tum");
  EXPECT_NE(text.find(" 3 4 0 0 0 0 1\n"), std::string::npos) << text;
  EXPECT_EQ(files::read_whole_file(path + "/report.html"), "page");
  EXPECT_EQ(files::read_whole_file(path + "/summary.json"), "summary");
  EXPECT_EQ(read_run(path).steps[1].pose.mean.x_m, example_step(1).pose.mean.x_m);
}

TEST(RunWriter, WritesPathsAndMixtureOfACloudOfParticles) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "run").string();
  RunWriter writer(path, example_manifest(), {});
  runs::Run run = example_run(0);
  run.particle_end = ParticleEnd{{{0, -1, {1.0, 2.0, 0.5}, 1.0}, {3, 0, {1.5, 2.0, 0.25}, 0.75}},
                                 {{7, {{1.0, -2.0}, Eigen::Matrix2d::Identity() * 0.5}, 0.75, 0.25}}};
  writer.finish(run, "page", "{}");
  EXPECT_EQ(files::read_whole_file(path + "/paths.csv"),
            "point,before,step,x,y,heading,share\n0,-1,0,1,2,0.5,1\n1,0,3,1.5,2,0.25,0.75\n");
  EXPECT_EQ(files::read_whole_file(path + "/mixture.csv"),
            "id,x,y,sxx,sxy,syy,share,mature_share\n7,1,-2,0.5,0,0.5,0.75,0.25\n");
  EXPECT_FALSE(fs::exists(path + "/particles.csv")) << "no step had a cloud";
}

TEST(RunWriter, LeavesNoTemporaryFileBehind) {
  const TemporaryFolder folder;
  write_example((folder.path() / "run").string(), 3);
  for (const auto& entry : fs::directory_iterator(folder.path() / "run")) {
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
  }
}

TEST(RunWriter, WritesThroughNoLinkThatSomebodyPlanted) {
  const TemporaryFolder folder;
  const fs::path victim = folder.write("victim", "precious");
  const fs::path run = folder.path() / "run";
  fs::create_directory(run);
  for (const char* name : {"trajectory.tum", "health.csv", "manifest.json", "manifest.json.part", "map.csv.part",
                           "summary.json.part", "report.html.part", "truth_labels.csv.part"}) {
    fs::create_symlink(victim, run / name);
  }
  {
    core::Recording recording;
    recording.labels = {{1}};
    RunWriter writer(run.string(), example_manifest(), recording, RunWriter::IfNotEmpty::overwrite);
    writer.write(example_step(0), 1.0);
    writer.finish({}, "page", "{}");
  }
  EXPECT_EQ(files::read_whole_file(victim.string()), "precious");
  EXPECT_EQ(read_run(run.string()).steps.size(), 1u);
}

TEST(WriteWholeFile, LeavesNothingBehindWhereItFails) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "file";
  fs::create_directory(file);  // cannot be replaced by a file
  EXPECT_NE(input_error_of([&] { files::write_whole_file(file.string(), "text"); }), "nothing thrown");
  EXPECT_FALSE(fs::exists(folder.path() / "file.part"));
}

}  // namespace
}  // namespace helixnav::runs
