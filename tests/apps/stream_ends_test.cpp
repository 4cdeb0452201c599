// SPDX-License-Identifier: BSD-3-Clause
// How `helixnav stream` starts and ends if something outside of it is wrong.
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "program.hpp"
#include "stream_lines.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

class StreamEnds : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(run({"new-vehicle", log_}).exit_code, 0); }

  /// A stream of three lines, one of them a scan.
  Outcome streamed(Words words, const char* output = nullptr) {
    const fs::path file = folder_.write("lines.jsonl",
                                        "{\"odometry\": {\"t\": 0, \"dx\": 0.1, \"dheading\": 0}}\n"
                                        "{\"odometry\": {\"t\": 1, \"dx\": 0.1, \"dheading\": 0}}\n"
                                        "{\"detections\": [{\"t\": 0.5, \"range\": 5, \"bearing\": 0.1}]}\n");
    words.insert(words.begin(), "stream");
    return run(words, [&] {
      ::dup2(::open(file.c_str(), O_RDONLY), STDIN_FILENO);
      if (output != nullptr) ::dup2(::open(output, O_WRONLY), STDOUT_FILENO);
    });
  }

  /// The whole log of new-vehicle, with these words of its vehicle.toml replaced.
  Outcome streamed_with(const std::string& words, const std::string& by) {
    std::string text;
    for (const std::string& line : lines_of(log_, 1e9)) text += line + "\n";
    const fs::path lines = folder_.write("all.jsonl", text);
    std::stringstream vehicle;
    vehicle << std::ifstream(vehicle_).rdbuf();
    std::string changed = vehicle.str();
    changed.replace(changed.find(words), words.size(), by);
    const fs::path file = folder_.write("vehicle.toml", changed);
    return run({"stream", "--vehicle", file, "--out", out_, "--overwrite"},
               [&] { ::dup2(::open(lines.c_str(), O_RDONLY), STDIN_FILENO); });
  }

  testing::TemporaryFolder folder_;
  const std::string log_ = (folder_.path() / "robot").string();
  const std::string vehicle_ = log_ + "/vehicle.toml";
  const std::string out_ = (folder_.path() / "run").string();
};

TEST_F(StreamEnds, SaysWhatAVehicleThatShipsLeavesToTheLog) {
  const Outcome outcome = streamed({"--vehicle", "plaza", "--out", out_});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.err.find("plaza.toml (ships with helixnav): a stream needs reach_m"), std::string::npos)
      << outcome.err;
}

TEST_F(StreamEnds, TellsTheClientWhyWhenItsFolderCannotBeWritten) {
  const Outcome outcome = streamed({"--vehicle", vehicle_, "--out", vehicle_ + "/run"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.out.find("{\"end\":{\"why\":\"" + vehicle_ + "/run: cannot make the folder: Not a directory\""),
            std::string::npos)
      << outcome.out;
}

TEST_F(StreamEnds, SaysWhatIsWrongWithTheStandardOutput) {
  const Outcome outcome = streamed({"--vehicle", vehicle_}, "/dev/full");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.err.find("the standard output cannot be written: No space left on device"), std::string::npos)
      << outcome.err;
}

TEST_F(StreamEnds, LeavesAFolderAloneThatAnotherProcessWritesAsReplayDoes) {
  fs::create_directory(out_);
  const int other = ::open(out_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  ASSERT_EQ(::flock(other, LOCK_EX), 0);
  const Outcome live = streamed({"--vehicle", vehicle_, "--out", out_, "--overwrite"});
  const Outcome replayed = run({"replay", log_, "--out", out_, "--overwrite", "--quiet"});
  for (const Outcome& outcome : {live, replayed}) {
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_NE(outcome.err.find("another process writes into this folder"), std::string::npos) << outcome.err;
  }
  EXPECT_TRUE(fs::is_empty(out_));
  ::close(other);
  EXPECT_EQ(streamed({"--vehicle", vehicle_, "--out", out_, "--overwrite"}).exit_code, 0);
}

TEST_F(StreamEnds, WarnsAsReplayDoes) {
  const Outcome right = streamed_with("heading_deg = 0.0", "heading_deg = 0.00");
  EXPECT_EQ(right.err.find("warning"), std::string::npos) << right.err;
  const Outcome aside = streamed_with("heading_deg = 0.0", "heading_deg = 3.0");
  EXPECT_EQ(aside.exit_code, 0);
  EXPECT_NE(aside.err.find("helixnav: warning: odometry and detections contradict each other"), std::string::npos)
      << aside.err;
}

}  // namespace
}  // namespace helixnav::apps
