// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "program.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

/// Settings of the search on the drive of ./dev demo, which returns after a bare stretch and closes the loop.
class SearchSettings : public ::testing::Test {
 protected:
  /// decisions.csv of that drive.
  std::string decisions(const Words& options) const {
    Words words{"simulate", "large-loop", "--seed", "1", "--quiet", "--overwrite", "--out", folder_.path() / "run"};
    words.insert(words.end(), options.begin(), options.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return text_of(folder_.path() / "run" / "decisions.csv");
  }
  static bool has(const std::string& decisions, const std::string& kind_and_verdict) {
    return decisions.find(',' + kind_and_verdict + ',') != std::string::npos;
  }

  testing::TemporaryFolder folder_;
};

TEST_F(SearchSettings, EachReachTheSearchButThreadsAndTheDumpOfTheDefaultsChangeNothing) {
  const std::string plain = decisions({});
  for (const Words& options : {Words{"--search.seed", "2"},
                               {"--search.particles", "100"},
                               {"--search.init", "gaussian"},
                               {"--search.decorrelation", "whitened-bound"},
                               {"--search.closing", "merge"},
                               {"--search.closing", "restart"},
                               {"--search.acceptance", "paper"},
                               {"--search.passes", "4"},
                               {"--search.rival_ratio", "0.01"}}) {
    EXPECT_NE(decisions(options), plain) << options.front() << ' ' << options.back();
  }
  const std::string defaults = folder_.write("defaults.toml", run({"config", "--dump"}).out);
  EXPECT_EQ(decisions({"--config", defaults, "--search.threads", "3"}), plain);
}

TEST_F(SearchSettings, CanForbidTheSearchOrItsClosing) {
  EXPECT_FALSE(has(decisions({"--search.enabled", "false"}), "trigger,started"));
  EXPECT_TRUE(has(decisions({"--search.old_after_m", "1e6"}), "trigger,started")) << "by the width of their gates";
  EXPECT_FALSE(has(decisions({"--search.expected_confusers", "1000"}), "trigger,started"));
  const std::string strict = decisions({"--search.least_matches", "1000"});
  EXPECT_TRUE(has(strict, "trigger,started"));
  EXPECT_FALSE(has(strict, "closure,accepted"));
  EXPECT_TRUE(has(decisions({"--search.undecided_m", "20"}), "closure,undecided"));
}

TEST_F(SearchSettings, CanLeaveADriveUnsolved) {
  EXPECT_TRUE(has(decisions({}), "smoothing,accepted"));
  EXPECT_FALSE(has(decisions({"--search.smooth_up_to_scans", "0"}), "smoothing,accepted"));
  EXPECT_TRUE(
      has(decisions({"--search.smooth_up_to_scans", "100"}), "smoothing,accepted"));  // the atlas has it by then
}

TEST_F(SearchSettings, OfThePaperCloseWithoutAConstellationAndAreExplained) {
  const std::string paper = decisions({"--search.acceptance", "paper"});
  EXPECT_TRUE(has(paper, "closure,accepted"));
  EXPECT_FALSE(has(paper, "constellation,accepted"));
  const Outcome outcome = run({"explain", folder_.path() / "run"});
  EXPECT_NE(outcome.out.find("the pose is that of the particles"), std::string::npos) << outcome.out;
}

TEST_F(SearchSettings, OutOfRangeAreMisuse) {
  for (const Words& options : {Words{"--search.particles", "99"},
                               {"--search.init", "gausian"},
                               {"--search.decorrelation", "scalar"},
                               {"--search.closing", "merg"},
                               {"--search.acceptance", "papers"},
                               {"--search.threads", "0"},
                               {"--search.least_matches", "2"},
                               {"--search.smooth_up_to_scans", "-1"},
                               {"--search.rival_ratio", "1.5"},
                               {"--search.expected_confusers", "nan"}}) {
    Words words{"config", "--dump"};
    words.insert(words.end(), options.begin(), options.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, 2) << options.front();
    EXPECT_NE(outcome.err.find(options.front()), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find('\'' + options.back() + '\''), std::string::npos) << outcome.err;
  }
}

}  // namespace
}  // namespace helixnav::apps
