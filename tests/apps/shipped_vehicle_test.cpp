// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "program.hpp"
#include "real_data.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;

/// Runs of an unmodified published log, by name of its vehicle and by that vehicle's file.
class ShippedVehicleProgram : public testing::RealDataTest {
 protected:
  void expect_same_runs(const fs::path& log, const std::string& name, const std::vector<std::string>& more = {}) {
    find_real_data(log);
    if (IsSkipped()) return;
    const fs::path written = folder_.path() / "written";
    ASSERT_EQ(run({"new-vehicle", written, "--like", name}).exit_code, 0);
    replay("plain", more);
    for (const std::string& vehicle : {name, (written / "vehicle.toml").string()}) {
      std::vector<std::string> words{"--vehicle", vehicle};
      words.insert(words.end(), more.begin(), more.end());
      const std::string folder = vehicle == name ? "by_name" : "by_file";
      replay(folder, words);
      for (const char* file : {"trajectory.tum", "map.csv", "associations.csv", "decisions.csv"}) {
        EXPECT_TRUE(text_of(folder_.path() / "plain" / file) == text_of(folder_.path() / folder / file))
            << folder << ' ' << file;
      }
    }
  }
  void replay(const std::string& folder, const std::vector<std::string>& more) {
    std::vector<std::string> words{"replay", path_, "--out", folder_.path() / folder};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run(words);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }

  testing::TemporaryFolder folder_;
};

TEST_F(ShippedVehicleProgram, OfVictoriaParkNavigatesAsTheFormat) {
  expect_same_runs("victoria_park/raw/victoria_park_ascii.zip", "victoria_park");
}

TEST_F(ShippedVehicleProgram, OfTheCarParkNavigatesAsTheFormat) {
  expect_same_runs("carpark/raw/data_set.mat", "car_park");
}

TEST_F(ShippedVehicleProgram, OfPlazaNavigatesAsTheFormat) {
  expect_same_runs("plaza", "plaza", {"--association", "known"});
}

TEST_F(ShippedVehicleProgram, OfDlrNavigatesAsTheFormat) {
  expect_same_runs("dlr/raw/map.circles", "dlr", {"--association", "known"});
}

TEST_F(ShippedVehicleProgram, ScalesTheNoiseThatALogStates) {
  find_real_data("dlr/raw/map.circles");
  if (IsSkipped()) return;
  const fs::path twice =
      folder_.write("twice.toml", "[odometry]\nnoise_scale = 2\n[[sensor]]\nname = \"camera\"\nnoise_scale = 2\n");
  replay("by_file", {"--association", "known", "--vehicle", twice});
  replay("by_option", {"--association", "known", "--log.covariance_scale", "4"});
  EXPECT_TRUE(text_of(folder_.path() / "by_file/trajectory.tum") ==
              text_of(folder_.path() / "by_option/trajectory.tum"));
}

TEST_F(ShippedVehicleProgram, WrongNameIsToldTheNearest) {
  const fs::path log = folder_.write("log.circles", "STEP a 0 -1 0 1e-4 0 1e-4 0 0 1e-5\n");
  const Outcome replayed = run({"replay", log, "--vehicle", "plazza", "--out", folder_.path() / "run"});
  EXPECT_EQ(replayed.exit_code, 3);
  EXPECT_NE(replayed.err.find("did you mean 'plaza'?"), std::string::npos) << replayed.err;
  const Outcome written = run({"new-vehicle", folder_.path() / "new", "--like", "dlrr"});
  EXPECT_EQ(written.exit_code, 2);
  EXPECT_NE(written.err.find("did you mean 'dlr'?"), std::string::npos) << written.err;
}

}  // namespace
}  // namespace helixnav::apps
