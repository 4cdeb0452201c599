// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include <gtest/gtest.h>

#include "program.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;

TEST(Config, DumpReadsBackAsTheSameDump) {
  const testing::TemporaryFolder folder;
  const Outcome dump = run({"config", "--dump", "--filter.cell_side_m", "31.25", "--association", "jcbb",
                            "--filter.retraction", "standard", "--victoria_park.steering_offset_rad", "-0.0125"});
  ASSERT_EQ(dump.exit_code, 0) << dump.err;
  EXPECT_NE(dump.out.find("cell_side_m = 31.25\n"), std::string::npos) << dump.out;
  const fs::path file = folder.write("mine.toml", dump.out);
  const Outcome again = run({"config", "--dump", "--check", file});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(again.out, dump.out);
  EXPECT_EQ(run({"config", "--check", file}).exit_code, 0);
}

TEST(Config, DumpOfTheDefaultsChangesNothingInARun) {
  const testing::TemporaryFolder folder;
  const fs::path file = folder.write("defaults.toml", run({"config", "--dump"}).out);
  ASSERT_EQ(run({"simulate", "circuit", "--out", folder.path() / "plain"}).exit_code, 0);
  ASSERT_EQ(run({"simulate", "circuit", "--config", file, "--out", folder.path() / "configured"}).exit_code, 0);
  EXPECT_EQ(text_of(folder.path() / "plain" / "trajectory.tum"),
            text_of(folder.path() / "configured" / "trajectory.tum"));
}

TEST(Config, FileChangesARunAndTheCommandLineWins) {
  const testing::TemporaryFolder folder;
  const fs::path file = folder.write("mine.ini", "[filter]\nretraction = standard\ncell_side_m = 40\n");
  const Outcome dump = run({"config", "--dump", "--check", file, "--filter.cell_side_m", "50"});
  ASSERT_EQ(dump.exit_code, 0) << dump.err;
  EXPECT_NE(dump.out.find("cell_side_m = 50\n"), std::string::npos) << dump.out;
  EXPECT_NE(dump.out.find("retraction = \"standard\"\n"), std::string::npos) << dump.out;
  ASSERT_EQ(run({"simulate", "circuit", "--config", file, "--out", folder.path() / "mine"}).exit_code, 0);
  ASSERT_EQ(run({"simulate", "circuit", "--out", folder.path() / "plain"}).exit_code, 0);
  EXPECT_NE(text_of(folder.path() / "plain" / "trajectory.tum"), text_of(folder.path() / "mine" / "trajectory.tum"));
}

}  // namespace
}  // namespace helixnav::apps
