// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

/// The example that new-vehicle writes.
class OwnLogProgram : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(run({"new-vehicle", log_}).exit_code, 0); }

  void expect(const Words& arguments, int exit_code, const Words& said) const {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.out << outcome.err;
    for (const std::string& word : said) {
      EXPECT_NE((outcome.out + outcome.err).find(word), std::string::npos)
          << "no \"" << word << "\" in: " << outcome.out << outcome.err;
    }
  }

  testing::TemporaryFolder folder_;
  const fs::path log_ = folder_.path() / "robot";
  const fs::path out_ = folder_.path() / "run";
};

TEST_F(OwnLogProgram, NavigatesItsExampleFromNewVehicleToAJudgedMap) {
  expect({"check", log_}, 0,
         {"format own", "vehicle.toml", "rows of increments", "reach 30 m", "settings", "nothing is doubtful"});
  expect({"replay", log_, "--out", out_, "--quiet"}, 0, {"run folder"});
  const auto summary = nlohmann::json::parse(std::ifstream(out_ / "summary.json"));
  EXPECT_LT(summary["error"]["rmse_m"].get<double>(), 6.0);
  EXPECT_GT(summary["landmarks"]["mature"].get<int>(), 20);
  const std::string manifest = text_of(out_ / "manifest.json");
  EXPECT_NE(manifest.find("vehicle.toml"), std::string::npos);
  EXPECT_NE(manifest.find("reach 30 m"), std::string::npos);
}

TEST_F(OwnLogProgram, TellsTheViewOfEachOfTwoSensors) {
  const fs::path log = folder_.path() / "two";
  folder_.write("two/vehicle.toml",
                "[odometry]\nsigma_along_m_per_sqrt_m = 0.02\n"
                "[[sensor]]\nname = \"front\"\nx_m = 0.5\nreach_m = 25\nview_deg = [-60, 60]\nsigma_point_m = 0.1\n"
                "[[sensor]]\nname = \"rear\"\nx_m = -0.5\nheading_deg = 180\nreach_m = 15\nview_deg = [-80, 80]\n"
                "sigma_point_m = 0.1\n");
  folder_.write("two/odometry.csv", "t,v,omega\n0,1,0\n1,1,0\n2,1,0\n");
  folder_.write("two/detections.csv", "t,x,y,sensor\n0.5,20,1,front\n0.6,12,2,rear\n1.5,18,-3,front\n1.6,11,2,rear\n");
  expect({"check", log}, 0,
         {"view used   front: reach 25 m", "bearings from -60 to 60 deg", "view used   rear: reach 15 m",
          "bearings from -80 to 80 deg", "view seen   front: reach 20.02 m", "view seen   rear: reach 12.17 m"});
}

TEST_F(OwnLogProgram, RefusesAFolderThatIsTaken) {
  expect({"new-vehicle", log_}, 3, {"expected a folder that is empty or not there"});
}

TEST_F(OwnLogProgram, LetsTheCommandLineOverrideTheVehicle) {
  expect({"check", log_}, 0, {"detection probability 0.9 (existence 0.9)"});
  expect({"check", log_, "--landmarks.detection_probability", "0.6"}, 0, {"detection probability 0.9 (existence 0.6)"});
}

TEST_F(OwnLogProgram, TakesTheVehicleThatIsNamedAndDoubtsAnotherRobots) {
  const fs::path other = folder_.write("other.toml",
                                       "[odometry]\nsigma_along_m_per_sqrt_m = 0.1\nsigma_heading_deg_per_sqrt_m = 1\n"
                                       "[[sensor]]\nreach_m = 3\nsigma_range_m = 0.1\nsigma_bearing_deg = 1\n");
  expect({"check", log_, "--vehicle", other}, 0,
         {"lie outside the reach and view that", "is it the vehicle of this log?"});
}

TEST_F(OwnLogProgram, ExitsWithThreeAndThePlaceForBadInput) {
  folder_.write("robot/odometry.csv", "t_s,v_msp,omega_radps\n0,1,0\n");
  for (const char* command : {"check", "replay"}) {
    Words words{command, log_};
    if (words[0] == "replay") words.insert(words.end(), {"--out", out_});
    expect(words, 3, {"odometry.csv:1:5: unknown column 'v_msp'; did you mean 'v_mps'?"});
  }
  EXPECT_FALSE(fs::exists(out_));
  expect({"check", folder_.path() / "nowhere"}, 3, {"expected a file or folder, found nothing there"});
  expect({"check", log_, "--vehicle", "no.toml"}, 3, {"no.toml: expected a file that can be read"});
}

TEST_F(OwnLogProgram, SaysWhatIsMissingWithoutAVehicle) {
  fs::remove(log_ / "vehicle.toml");
  expect({"check", log_}, 3,
         {"no vehicle.toml beside the log", "noise of a detection is given", "helixnav new-vehicle"});
}

TEST_F(OwnLogProgram, NavigatesTheSameAsJsonLines) {
  std::ifstream odometry(log_ / "odometry.csv"), detections(log_ / "detections.csv");
  std::ofstream lines(log_ / "log.jsonl");
  const auto copy = [&](std::ifstream& table, const std::string& name) {
    std::string header, row;
    std::getline(table, header);
    const auto cells = [](std::string text) {
      Words words;
      for (std::size_t at; (at = text.find(',')) != std::string::npos; text.erase(0, at + 1))
        words.push_back(text.substr(0, at));
      words.push_back(text);
      return words;
    };
    const Words keys = cells(header);
    while (std::getline(table, row)) {
      const Words values = cells(row);
      lines << "{\"" << name << "\": {";
      bool first = true;
      for (std::size_t i = 0; i < keys.size(); ++i) {
        if (values[i].empty()) continue;
        lines << (first ? "" : ", ") << '"' << keys[i] << "\": " << values[i];
        first = false;
      }
      lines << "}}\n";
    }
  };
  copy(odometry, "odometry");
  copy(detections, "detections");
  lines.close();
  expect({"replay", log_, "--out", out_, "--quiet"}, 0, {});
  expect({"replay", log_ / "log.jsonl", "--out", folder_.path() / "of_lines", "--quiet"}, 0, {});
  for (const char* name : {"trajectory.tum", "map.csv", "associations.csv"}) {
    EXPECT_EQ(text_of(out_ / name), text_of(folder_.path() / "of_lines" / name)) << name;
  }
}

TEST(HelpPages, OfReplayFitOnAScreenAndShowAllOnDemand) {
  const Outcome brief = run({"replay", "--help"}), all = run({"replay", "--help-all"});
  EXPECT_LE(std::count(brief.out.begin(), brief.out.end(), '\n'), 50);
  EXPECT_EQ(brief.out.find("--search.particles"), std::string::npos);
  EXPECT_NE(brief.out.find("shown by --help-all"), std::string::npos);
  EXPECT_NE(all.out.find("--search.particles"), std::string::npos);
  EXPECT_EQ(run({"help", "replay"}).out, brief.out);
  EXPECT_EQ(run({"help"}).out, run({"--help"}).out);
}

TEST(HelpPages, OfACommandThatIsNotThereNameTheNearest) {
  const Outcome help = run({"help", "repaly"});
  EXPECT_EQ(help.exit_code, 2);
  EXPECT_NE(help.err.find("unknown command 'repaly'; did you mean 'replay'?"), std::string::npos) << help.err;
}

TEST(HelpPages, ProposeNoOptionThatIsFarFromWhatWasWritten) {
  const Outcome seed = run({"replay", "x", "--out", "y", "--seed"});
  EXPECT_EQ(seed.exit_code, 2);
  EXPECT_NE(seed.err.find("unknown option '--seed'"), std::string::npos) << seed.err;
  EXPECT_EQ(seed.err.find("did you mean"), std::string::npos) << seed.err;
}

}  // namespace
}  // namespace helixnav::apps
