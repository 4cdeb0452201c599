// SPDX-License-Identifier: BSD-3-Clause
// Output that cannot be written, signals in mid-operation, threads that cannot start.
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/interrupt.hpp"
#include "program.hpp"
#include "small_logs.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;

void print_to_full_disk() { ::dup2(::open("/dev/full", O_WRONLY), STDOUT_FILENO); }
void print_nowhere() { ::close(STDOUT_FILENO); }

class LostOutput : public ::testing::Test {
 protected:
  void SetUp() override {
    log_ = folder_.write("map.isam", circle_graph(20));
    ASSERT_EQ(run({"replay", log_, "--out", run_}).exit_code, 0);
  }

  testing::TemporaryFolder folder_;
  fs::path log_;
  fs::path run_ = folder_.path() / "run";
};

TEST_F(LostOutput, EndsInAnErrorWhoeverPrints) {
  const std::vector<std::vector<std::string>> commands{
      {"evaluate", run_},   {"evaluate", run_, "--json"},       {"explain", run_},
      {"config", "--dump"}, {"associate", log_, "--scan", "3"}, {"--help"},
      {"--version"}};
  for (const std::vector<std::string>& command : commands) {
    ASSERT_EQ(run(command).exit_code, 0) << command.front();
    for (const auto& prepare : {&print_to_full_disk, &print_nowhere}) {
      const Outcome outcome = run(command, prepare);
      EXPECT_EQ(outcome.exit_code, 3) << command.front();
      EXPECT_NE(outcome.err.find("standard output"), std::string::npos) << command.front() << ": " << outcome.err;
    }
  }
}

/// No file can grow beyond this, as on a full disk. The signal is ignored, as it would end the program.
void allow_small_files() {
  const rlimit small{3000, 3000};
  ::signal(SIGXFSZ, SIG_IGN);
  if (::setrlimit(RLIMIT_FSIZE, &small) != 0) ::_exit(125);
}

TEST(FullDisk, CalibrateSaysSoBeforeItBeginsAndLeavesNothing) {
  const testing::TemporaryFolder folder;
  ASSERT_EQ(run({"new-vehicle", folder.path() / "robot"}).exit_code, 0);
  const auto calibrate = [&](const fs::path& out, const std::function<void()>& prepare) {
    const Outcome outcome = run({"calibrate", folder.path() / "robot", "--out", out}, prepare);
    EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
    EXPECT_EQ(outcome.out, "") << "the log was calibrated first";
    return outcome.err;
  };
  const std::string full = calibrate(folder.path() / "cart.toml", allow_small_files);
  EXPECT_NE(full.find("cart.toml: cannot write: File too large"), std::string::npos) << full;
  const std::string nowhere = calibrate(folder.path() / "nowhere" / "cart.toml", {});
  EXPECT_NE(nowhere.find("cart.toml: cannot write: No such file or directory"), std::string::npos) << nowhere;
  EXPECT_EQ(names_in(folder.path()), std::set<std::string>{"robot"});
}

TEST(FullDisk, NewVehicleTakesBackWhatItWrote) {
  const testing::TemporaryFolder folder;
  fs::create_directory(folder.path() / "empty");
  for (const char* name : {"robot", "empty"}) {
    const Outcome outcome = run({"new-vehicle", folder.path() / name}, allow_small_files);
    EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
    EXPECT_NE(outcome.err.find("File too large"), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(names_in(folder.path()), std::set<std::string>{"empty"});
  EXPECT_TRUE(fs::is_empty(folder.path() / "empty"));
}

TEST(Interrupt, EndsAProgramThatDoesNotAskInTime) {
  EXPECT_EXIT(
      {
        catch_interrupts();
        ::raise(SIGTERM);
        for (;;) ::pause();
      },
      ::testing::ExitedWithCode(130), "interrupted in the middle");
}

TEST(Interrupt, LeavesAProgramThatAskedTheTimeToComeToItsEnd) {
  EXPECT_EXIT(
      {
        catch_interrupts();
        ::raise(SIGTERM);
        if (!interrupted()) ::_exit(1);
        std::this_thread::sleep_for(std::chrono::milliseconds(1500));
        ::_exit(7);
      },
      ::testing::ExitedWithCode(7), "");
}

TEST(Interrupt, EndsACampaignWithinItsRunAndTheRunIsDrivenAgain) {
  const testing::TemporaryFolder folder;
  const fs::path out = folder.path() / "campaign";
  Program program({"montecarlo", "large-loop", "--runs", "1", "--jobs", "1", "--out", out});
  while (!program.catches(SIGTERM)) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  program.send(SIGTERM);
  EXPECT_EQ(program.wait().exit_code, 130);
  EXPECT_EQ(complete_lines(out / "runs.jsonl"), 0u);
}

/// A stack larger than any machine has: a thread that asks for it does not start.
void allow_no_threads() {
  const rlimit huge{rlim_t{1} << 47, RLIM_INFINITY};
  if (::setrlimit(RLIMIT_STACK, &huge) != 0) ::_exit(125);
}

TEST(NoThreads, CampaignIsDrivenByThoseThatThereAre) {
  const testing::TemporaryFolder folder;
  const fs::path out = folder.path() / "campaign";
  const Outcome outcome =
      run({"montecarlo", "sparse", "--runs", "2", "--jobs", "2", "--search.enabled", "false", "--out", out},
          allow_no_threads);
  if (outcome.exit_code == 125) GTEST_SKIP() << "the limit of the stack cannot be raised here";
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(complete_lines(out / "runs.jsonl"), 2u);
}

/// The rows of a resumed campaign.
TEST(HostileCampaign, RowsOfWrongTypesAreNamedByLine) {
  const testing::TemporaryFolder folder;
  const fs::path out = folder.path() / "campaign";
  const std::vector<std::string> command{"montecarlo",       "sparse", "--runs", "1",
                                         "--search.enabled", "false",  "--out",  out};
  ASSERT_EQ(run(command).exit_code, 0);
  const std::string row = text_of(out / "runs.jsonl");
  const auto with = [&](const char* key, nlohmann::ordered_json value) {
    nlohmann::ordered_json changed = nlohmann::ordered_json::parse(row);
    changed[key] = std::move(value);
    return changed.dump() + '\n';
  };
  for (const std::string& bad :
       {with("seed", "one"), with("seed", -1), with("seed", 1.5), with("verdict", 3), with("closures", 5),
        with("returns", "none"), with("end", 1), with("wall", nullptr), with("closed_by_association", "yes"),
        std::string("[1, 2]\n"), std::string(100'000, '[') + '\n'}) {
    folder.write("campaign/runs.jsonl", row + bad);
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.exit_code, 3) << bad.substr(0, 200);
    EXPECT_NE(outcome.err.find("runs.jsonl:2: "), std::string::npos) << outcome.err;
  }
}

TEST(HostileConfig, SaysAThingOnce) {
  const testing::TemporaryFolder folder;
  const fs::path twice = folder.write("twice.ini",
                                      "[filter]\ncell_side_m = 50\n[landmarks]\nmature_looks = 3\n"
                                      "[filter]\ncell_side_m = 60\n");
  const Outcome outcome = run({"config", "--check", twice});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("'filter.cell_side_m' is given a second time"), std::string::npos) << outcome.err;
  const fs::path parted = folder.write("parted.ini",
                                       "[filter]\ncell_side_m = 50\n[landmarks]\nmature_looks = 3\n"
                                       "[filter]\nhysteresis_m = 60\n");
  EXPECT_EQ(run({"config", "--check", parted}).exit_code, 0) << "another key of a section begun before";
}

TEST(HostileConfig, KeysBeyondAllMeasureAreShownInPart) {
  const testing::TemporaryFolder folder;
  const Outcome outcome = run({"config", "--check", folder.write("long.ini", std::string(100'000, 'k') + " = 1\n")});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_LT(outcome.err.size(), 1000u);
}

TEST(HostileMap, NumbersThatAreNoneAreNamedByLine) {
  const testing::TemporaryFolder folder;
  const fs::path log = folder.write("map.isam", circle_graph(20));
  const std::string header = "id,x,y,sxx,sxy,syy,observations,state\n";
  for (const char* row : {"0,nan,1,0.1,0,0.1,5,mature\n", "0,1,inf,0.1,0,0.1,5,mature\n", "0,1,1,nan,0,0.1,5,mature\n",
                          "0,1,1,0.1,0,inf,5,mature\n"}) {
    const fs::path map = folder.write("map.csv", header + row);
    const Outcome outcome = run({"replay", log, "--localize", "--map", map, "--out", folder.path() / "out"});
    EXPECT_EQ(outcome.exit_code, 3) << row;
    EXPECT_NE(outcome.err.find("map.csv:2: "), std::string::npos) << outcome.err;
  }
}

}  // namespace
}  // namespace helixnav::apps
