// SPDX-License-Identifier: BSD-3-Clause
// Every write and rename of a run folder, failing once each with ENOSPC, with EIO, after half of its bytes, and once each
// as the last act of the process: what is there afterwards is refused by name, or is the run up to a whole step.
#include <fcntl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/files/file.hpp"
#include "helixnav/runs/run_folder.hpp"
#include "run_example.hpp"
#include "temporary_folder.hpp"

namespace {

enum class Fault { none, no_space, input_output, half, killed, killed_at_half };

constexpr Fault faults[] = {Fault::no_space, Fault::input_output, Fault::half, Fault::killed, Fault::killed_at_half};
const char* const names[] = {"none", "ENOSPC", "EIO", "half, then ENOSPC", "SIGKILL", "SIGKILL at half"};

int calls = 0;    ///< calls of write and rename since watching began
int failing = 0;  ///< number of the call that fails, 1 is the next; 0: none
bool after_half = false;
Fault fault = Fault::none;

bool fails_now() { return failing > 0 && ++calls == failing; }

ssize_t system_write(int file, const void* bytes, std::size_t count) {
  return ::syscall(SYS_write, file, bytes, count);
}

int failure_number() { return fault == Fault::input_output ? EIO : ENOSPC; }

}  // namespace

// The program's own versions take precedence over those of the C library.
extern "C" ssize_t write(int file, const void* bytes, std::size_t count) {
  const bool now = fails_now();
  if (now && fault == Fault::killed) ::raise(SIGKILL);
  if (now && (fault == Fault::half || fault == Fault::killed_at_half)) {
    const ssize_t written = system_write(file, bytes, (count + 1) / 2);
    if (fault == Fault::killed_at_half) ::raise(SIGKILL);
    after_half = true;
    return written;
  }
  if (now || (failing > 0 && after_half)) {
    errno = failure_number();
    return -1;
  }
  return system_write(file, bytes, count);
}

extern "C" int rename(const char* from, const char* to) {
  if (fails_now() || (failing > 0 && after_half)) {
    if (fault == Fault::killed || fault == Fault::killed_at_half) ::raise(SIGKILL);
    errno = failure_number();
    return -1;
  }
  return static_cast<int>(::syscall(SYS_renameat, AT_FDCWD, from, AT_FDCWD, to));
}

namespace helixnav::runs {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t steps = 12;

/// Writes the example with the call of that number failing. True if all was written, false if it was refused with a
/// message that names the folder.
bool write_run(const std::string& folder, int call, Fault how) {
  core::Recording recording;
  recording.labels = {{1, 2}, {3}};
  recording.true_poses = {{0, {}}};
  calls = 0;
  after_half = false;
  fault = how;
  failing = call;
  bool whole = true;
  bool named = true;
  try {
    RunWriter writer(folder, example_manifest(), recording);
    for (std::int64_t k = 0; k < steps; ++k) writer.write(example_step(k), 1.0);
    writer.finish({}, "page", "{}");
  } catch (const core::InputError& error) {
    whole = false;
    named = std::string(error.what()).find(folder) != std::string::npos;
  }
  failing = 0;
  EXPECT_TRUE(named);
  return whole;
}

/// Number of calls that a run makes.
int calls_of_a_run(const std::string& folder) {
  constexpr int never = 1 << 30;
  EXPECT_TRUE(write_run(folder, never, Fault::none));
  return calls;
}

void expect_prefix(const std::string& folder, const std::string& what) {
  if (!fs::exists(folder + "/manifest.json")) {
    EXPECT_THROW(read_run(folder), core::InputError) << what;
    return;
  }
  const Run run = read_run(folder);
  ASSERT_LE(run.steps.size(), static_cast<std::size_t>(steps)) << what;
  for (std::size_t k = 0; k < run.steps.size(); ++k) {
    const core::StepReport expected = example_step(static_cast<std::int64_t>(k));
    EXPECT_EQ(run.steps[k].step, expected.step) << what;
    EXPECT_EQ(run.steps[k].pose.mean.x_m, expected.pose.mean.x_m) << what;
    EXPECT_EQ(run.steps[k].associations.size(), expected.associations.size()) << what;
    EXPECT_EQ(run.steps[k].decisions.size(), expected.decisions.size()) << what;
  }
  EXPECT_TRUE(!run.finished || run.steps.size() == steps) << what;
}

TEST(RunFolderFaults, AtEveryWriteAndRenameLoseNoWholeStep) {
  const testing::TemporaryFolder folders;
  const int all = calls_of_a_run((folders.path() / "whole").string());
  ASSERT_GT(all, 6 + 3 + static_cast<int>(steps) * 3);
  int injected = 0;
  for (const Fault how : faults) {
    const bool kills = how == Fault::killed || how == Fault::killed_at_half;
    for (int call = 1; call <= all; ++call) {
      const std::string folder = (folders.path() / std::to_string(++injected)).string();
      const std::string what = std::string(names[static_cast<int>(how)]) + " at call " + std::to_string(call);
      if (!kills) {
        EXPECT_FALSE(write_run(folder, call, how)) << what;
        for (const auto& entry : fs::directory_iterator(folder)) {
          EXPECT_NE(entry.path().extension(), ".part") << what << " left " << entry.path();
        }
      } else if (const pid_t child = ::fork(); child == 0) {
        write_run(folder, call, how);
        ::_exit(0);
      } else {
        int status = 0;
        ASSERT_EQ(::waitpid(child, &status, 0), child);
        EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) << what << " did not happen";
      }
      expect_prefix(folder, what);
      fs::remove_all(folder);
    }
  }
  RecordProperty("faults_injected", injected);
}

}  // namespace
}  // namespace helixnav::runs
