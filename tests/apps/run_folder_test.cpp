// SPDX-License-Identifier: BSD-3-Clause
#include <csignal>
#include <fstream>
#include <regex>
#include <string>

#include <unistd.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program.hpp"
#include "small_logs.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;

/// The file without what docs/run-folder.md lists under "The same command twice".
std::string without_wall_clock(const fs::path& file) {
  std::string text = text_of(file);
  if (file.filename() == "health.csv") return std::regex_replace(text, std::regex(",[^,\n]*\n"), "\n");
  const bool is_summary = file.filename() == "summary.json";
  const bool is_report = file.filename() == "report.html";
  if (!is_summary && !is_report) return text;
  const std::string begin_mark = is_summary ? "\"timing\": {" : "id=\"wall-clock\"";
  const std::size_t begin = text.find(begin_mark);
  const std::size_t end = text.find(is_summary ? "}" : "</script>", begin);
  EXPECT_NE(begin, std::string::npos) << file;
  EXPECT_NE(end, std::string::npos) << file;
  return begin == std::string::npos ? text : text.erase(begin, end - begin);
}

void expect_the_same_run(const fs::path& a, const fs::path& b) {
  EXPECT_EQ(names_in(a), names_in(b));
  for (const std::string& name : names_in(a)) {
    EXPECT_TRUE(without_wall_clock(a / name) == without_wall_clock(b / name)) << name << " differs";
  }
}

class RunFolder : public ::testing::Test {
 protected:
  fs::path out(const std::string& name) const { return folder_.path() / name; }
  testing::TemporaryFolder folder_;
};

TEST_F(RunFolder, OfTheSameSimulationTwiceHasTheSameBytes) {
  for (const char* name : {"first", "second"}) {
    const Outcome outcome = run({"simulate", "large-loop", "--seed", "3", "--out", out(name)});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("closings             1 accepted, 0 refused"), std::string::npos) << outcome.out;
  }
  EXPECT_GE(names_in(out("first")).size(), 9u);
  expect_the_same_run(out("first"), out("second"));
}

TEST_F(RunFolder, OfAnotherSeedIsAnother) {
  ASSERT_EQ(run({"simulate", "circuit", "--seed", "1", "--out", out("first")}).exit_code, 0);
  ASSERT_EQ(run({"simulate", "circuit", "--seed", "2", "--out", out("second")}).exit_code, 0);
  EXPECT_NE(text_of(out("first") / "trajectory.tum"), text_of(out("second") / "trajectory.tum"));
}

TEST_F(RunFolder, OfTheSameReplayTwiceHasTheSameBytes) {
  const fs::path log = folder_.write("circle.txt", circle_graph(500));
  for (const char* name : {"first", "second"}) {
    const Outcome outcome = run({"replay", log, "--association", "known", "--out", out(name)});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  expect_the_same_run(out("first"), out("second"));
}

TEST_F(RunFolder, ThatHoldsAnythingIsRefusedUnlessOverwritten) {
  const fs::path kept = folder_.write("run/notes.txt", "mine");
  const Outcome refused = run({"simulate", "circuit", "--out", out("run")});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("not empty"), std::string::npos) << refused.err;
  EXPECT_NE(refused.err.find("--overwrite"), std::string::npos) << refused.err;
  EXPECT_EQ(names_in(out("run")), std::set<std::string>{"notes.txt"});

  ASSERT_EQ(run({"simulate", "circuit", "--seed", "1", "--out", out("run"), "--overwrite"}).exit_code, 0);
  const std::string first = text_of(out("run") / "trajectory.tum");
  ASSERT_EQ(run({"simulate", "circuit", "--seed", "2", "--out", out("run"), "--overwrite"}).exit_code, 0);
  EXPECT_NE(text_of(out("run") / "trajectory.tum"), first);
  EXPECT_EQ(text_of(kept), "mine");
}

TEST_F(RunFolder, ThatIsAFileIsRefused) {
  const fs::path file = folder_.write("run", "");
  const Outcome outcome = run({"simulate", "circuit", "--out", file});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.err.find("expected a folder"), std::string::npos) << outcome.err;
}

TEST_F(RunFolder, IsRefusedBeforeTheLogIsRead) {
  folder_.write("run/notes.txt", "mine");
  const Outcome outcome = run({"replay", folder_.path() / "nowhere", "--out", out("run")});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.err.find("not empty"), std::string::npos) << outcome.err;
}

/// Reads no further than that: the file grows while it is read.
bool has_lines(const fs::path& file, int count) {
  std::ifstream in(file);
  std::string line;
  while (count > 0 && std::getline(in, line) && !in.eof()) --count;
  return count == 0;
}

/// A run of some tenths of a second that the tests below terminate once its first steps are on disk.
class CutRun : public RunFolder {
 protected:
  Outcome cut_by(int signal) {
    const fs::path log = folder_.write("circle.txt", circle_graph(steps_));
    Program program({"replay", log, "--association", "known", "--out", out("run")});
    constexpr int patience_ms = 30'000;
    for (int ms = 0; ms < patience_ms && !has_lines(out("run") / "health.csv", 20); ++ms) ::usleep(1000);
    program.send(signal);
    Outcome outcome = program.wait();
    written_ = complete_lines(out("run") / "health.csv") - 1;
    return outcome;
  }
  void expect_readable_up_to_the_last_step() const {
    const Outcome evaluation = run({"evaluate", out("run"), "--json"});
    ASSERT_EQ(evaluation.exit_code, 0) << evaluation.err;
    EXPECT_EQ(nlohmann::json::parse(evaluation.out).at("steps"), written_);
    EXPECT_GE(written_, 19u);
    EXPECT_LT(written_, static_cast<std::size_t>(steps_)) << "the run came to its end before the signal";
  }

  int steps_ = 20'000;
  std::size_t written_ = 0;
};

TEST_F(CutRun, ByAnInterruptEndsAfterItsStepAndIsClosedProperly) {
  const Outcome outcome = cut_by(SIGINT);
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_NE(outcome.err.find("interrupted after " + std::to_string(written_) + " steps"), std::string::npos)
      << outcome.err;
  EXPECT_TRUE(fs::exists(out("run") / "summary.json"));
  EXPECT_TRUE(fs::exists(out("run") / "report.html"));
  expect_readable_up_to_the_last_step();
}

TEST_F(CutRun, ByItsLimitOfMemoryIsClosedProperly) {
  const fs::path log = folder_.write("circle.txt", circle_graph(300));
  const auto with = [&](const std::string& memory_mb) {
    return run({"replay", log, "--association", "known", "--map.memory_mb", memory_mb, "--out", out(memory_mb)});
  };
  const Outcome enough = with("100000");
  EXPECT_EQ(enough.exit_code, 0) << enough.err;
  const Outcome outcome = with("1");  // less than any process has: after the first step
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.err.find("more than the 1 of --map.memory_mb"), std::string::npos) << outcome.err;
  EXPECT_TRUE(fs::exists(out("1") / "report.html"));
  EXPECT_TRUE(fs::exists(out("1") / "map.csv"));
  const Outcome evaluation = run({"evaluate", out("1"), "--json"});
  ASSERT_EQ(evaluation.exit_code, 0) << evaluation.err;
  EXPECT_EQ(nlohmann::json::parse(evaluation.out).at("steps"), 1);
}

TEST_F(CutRun, ByALimitOfMemoryIsForReplayAndSimulateOnly) {
  const fs::path log = folder_.write("circle.txt", circle_graph(30));
  using Words = std::vector<std::string>;
  for (const Words& words :
       {Words{"stream", "--vehicle", "generic"}, Words{"montecarlo", "circuit", "--out", out("campaign")},
        Words{"associate", log}, Words{"calibrate", log}}) {
    Words limited = words;
    limited.insert(limited.end(), {"--map.memory_mb", "100"});
    const Outcome outcome = run(limited);
    EXPECT_EQ(outcome.exit_code, 2) << words.front();
    EXPECT_NE(outcome.err.find("--map.memory_mb: is for replay and simulate"), std::string::npos) << outcome.err;
  }
}

TEST_F(CutRun, ByAKillIsReadUpToItsLastCompleteStep) {
  const Outcome outcome = cut_by(SIGKILL);
  EXPECT_EQ(outcome.signal, SIGKILL);
  EXPECT_FALSE(fs::exists(out("run") / "summary.json"));
  expect_readable_up_to_the_last_step();
}

}  // namespace
}  // namespace helixnav::apps
