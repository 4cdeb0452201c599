// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/logs/dlr.hpp"
#include "helixnav/sim/simulate.hpp"
#include "program.hpp"

namespace helixnav::apps {
namespace {

using Words = std::vector<std::string>;

/// A simulated drive in the text format of the DLR logs, which says nothing about its sensor.
class Lengths : public ::testing::Test {
 protected:
  void SetUp() override {
    core::Recording run = sim::simulate(sim::named_scenario("large-loop"), 1);
    core::Odometry still;  // the format begins with a step
    still.covariance = 1e-10 * Eigen::Matrix3d::Identity();
    run.events.insert(run.events.begin(), still);
    logs::write_dlr(run, folder_.path() / "loop.circles");
  }

  Outcome replay(const Words& options) const {
    Words words{"replay", folder_.path() / "loop.circles", "--quiet", "--overwrite", "--out", folder_.path() / "run"};
    words.insert(words.end(), options.begin(), options.end());
    return run(words);
  }
  std::string file(const char* name) const { return text_of(folder_.path() / "run" / name); }

  testing::TemporaryFolder folder_;
};

TEST_F(Lengths, OfALogInDlrTextAreThoseOfItsOwnSensor) {
  ASSERT_EQ(replay({}).exit_code, 0);
  EXPECT_NE(file("decisions.csv").find(",closure,accepted,"), std::string::npos) << file("decisions.csv");
  EXPECT_NE(file("manifest.json").find("Field of view: "), std::string::npos) << file("manifest.json");
  EXPECT_NE(file("manifest.json").find("search.rivals.distinct_m = 1.0"), std::string::npos) << file("manifest.json");
}

TEST_F(Lengths, FollowTheReachThatIsToldAndNotWhatIsGiven) {
  ASSERT_EQ(replay({"--log.max_range_m", "30", "--log.view_deg", "180", "--search.old_after_m", "70"}).exit_code, 0);
  EXPECT_NE(file("decisions.csv").find(",closure,accepted,"), std::string::npos);
  for (const char* line : {"-90 to 90 deg; reach 30 m", "search.old_after_m = 70", "filter.cell_side_m = 20",
                           "search.extraneous_per_scan = learnt"}) {
    EXPECT_NE(file("manifest.json").find(line), std::string::npos) << line << " not in " << file("manifest.json");
  }
}

}  // namespace
}  // namespace helixnav::apps
