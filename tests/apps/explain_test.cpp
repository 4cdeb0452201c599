// SPDX-License-Identifier: BSD-3-Clause
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/core/decision_row.hpp"
#include "helixnav/core/recording.hpp"
#include "helixnav/runs/run_writer.hpp"
#include "program.hpp"

namespace helixnav::apps {
namespace {

using core::Decision;

/// A run folder with known numbers: the trigger in step 1, then a failed test and two closings.
class Explain : public ::testing::Test {
 protected:
  Explain() {
    runs::RunWriter writer(path(), {}, {});
    for (std::int64_t k = 0; k < 6; ++k) {
      core::StepReport step;
      step.step = k;
      step.t_ns = k * 500'000'000;
      step.mode = k >= 1 && k < 5 ? core::Mode::searching : core::Mode::mapping;
      step.pose.mean = {10.0, -2.5, 0.0};
      fill(step);
      writer.write(step, 1.0);
    }
    writer.finish({}, "", "");
  }

  static void fill(core::StepReport& step) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    constexpr double alone = std::numeric_limits<double>::infinity();
    if (step.step == 1) {
      step.decisions.push_back(core::decision_of({"trigger",
                                                  "started",
                                                  {{"landmark", 7},
                                                   {"foreign_objects", 2.345},
                                                   {"neighbours", 1},
                                                   {"pose_sigma_m", 9.5},
                                                   {"heading_sigma_deg", 3.25}}}));
      step.associations = {{0, core::Outcome::matched, 3, 1.5, 2, 4.25},
                           {1, core::Outcome::augmented, 12, none, 0, alone},
                           {2, core::Outcome::rejected, 5, 8.0, 2, 1.0},
                           {3, core::Outcome::ambiguous, 6, 30.0, 2, alone},
                           {4, core::Outcome::ambiguous, core::no_landmark, none, 0, alone}};
    }
    if (step.step == 0) {
      step.decisions.push_back(core::decision_of(
          {"trigger", "rolled-back", {{"missing", 5}, {"seen", 0}, {"spawned", 2}, {"nats", 5.5}, {"scans", 31}}}));
    }
    if (step.step == 2)
      step.decisions.push_back(core::decision_of({"search", "started", {{"attempt", 1}, {"helix_pairs", 15}}}));
    if (step.step == 3) step.decisions.push_back(constellation("rival-too-good"));
    if (step.step == 4) {
      step.decisions.push_back(core::decision_of({"closure",
                                                  "refused",
                                                  {{"pairs", 6},
                                                   {"dropped", 1},
                                                   {"cost", 45.5},
                                                   {"dof", 12},
                                                   {"limit", 32.9},
                                                   {"driven_m", 20},
                                                   {"moved_m", 0}}}));
      step.decisions.push_back(core::decision_of(
          {"smoothing", "refused", {{"chi2", 4000.0}, {"limit", 3170.25}, {"poses", 1}, {"iterations", 200}}}));
    }
    if (step.step == 5) {
      step.decisions.push_back(constellation("accepted"));
      step.decisions.push_back(core::decision_of({"closure",
                                                  "accepted",
                                                  {{"pairs", 6},
                                                   {"dropped", 0},
                                                   {"cost", 11.5},
                                                   {"dof", 12},
                                                   {"limit", 32.9},
                                                   {"driven_m", 27},
                                                   {"moved_m", 8.25}}}));
      step.decisions.push_back(core::decision_of(
          {"smoothing",
           "accepted",
           {{"chi2", 3145.75}, {"limit", 3170.25}, {"poses", 350}, {"iterations", 4}, {"moved_m", 0.25}}}));
      step.merged = {{7, 12}, {8, 13}};
    }
  }

  static Decision constellation(const std::string& verdict) {
    return core::decision_of({"constellation",
                              verdict,
                              {{"matched", 8},
                               {"unmatched_branch", 2},
                               {"unmatched_old", 1},
                               {"ratio", 0.84},
                               {"rival_matched", 7},
                               {"rival_ratio", 0.8},
                               {"rival_share", 0.952},
                               {"rivals_tried", 25},
                               {"x_m", 1.0},
                               {"y_m", 2.0},
                               {"heading_rad", 0.5},
                               {"rival_x_m", 4.0},
                               {"rival_y_m", 6.0},
                               {"rival_heading_rad", 0.5}}});
  }

  std::string path() const { return folder_.path() / "run"; }

  void expect_said(std::vector<std::string> options, const std::vector<std::string>& said) const {
    options.insert(options.begin(), {"explain", path()});
    const Outcome outcome = run(options);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    std::size_t from = 0;
    for (const std::string& words : said) {
      const std::size_t at = outcome.out.find(words, from);
      EXPECT_NE(at, std::string::npos) << "no \"" << words << "\" in its place in: " << outcome.out;
      if (at != std::string::npos) from = at;
    }
  }

  void expect_refused(std::vector<std::string> options, int exit_code, const std::string& said) const {
    options.insert(options.begin(), "explain");
    const Outcome outcome = run(options);
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.err;
    EXPECT_NE(outcome.err.find(said), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }

  testing::TemporaryFolder folder_;
};

TEST_F(Explain, TellsEveryClosureOfARunInASentence) {
  expect_said({}, {"6 steps; closings: 1 accepted, 1 refused, 0 on new ground, 0 left undecided",
                   "Closure 1, step 4 (2 s). Refused", "cost 45.5 of 6 pairs exceeds 32.9", "1 pair dropped",
                   "Closure 2, step 5 (2.5 s). Accepted", "cost 11.5 of 6 pairs is within 32.9",
                   "moved by 8.25 m, 27 m after the trigger"});
}

TEST_F(Explain, TellsOfAClosureAllSinceItsTrigger) {
  expect_said({"--closure", "2"}, {"Closure 2 of this run: accepted",
                                   "step 1 (0.5 s)  A search began",
                                   "landmark 7",
                                   "2.35 other expected objects",
                                   "1 old landmark among",
                                   "9.5 m and 3.25°",
                                   "old landmarks are excluded",
                                   "step 2",
                                   "Attempt 1",
                                   "15 pairs",
                                   "step 3",
                                   "test failed, a rival pose explains nearly as much",
                                   "8 new landmarks matched to old ones",
                                   "2 new and 1 old",
                                   "ratio 0.84",
                                   "best rival is 5 m and 0° away",
                                   "matches 7 with a ratio of 0.8, 0.952 of the winner's",
                                   "Refused",
                                   "test was passed",
                                   "Accepted",
                                   "12 into 7, 13 into 8.",
                                   "step 5 (2.5 s)  Then the drive was solved as a whole",
                                   "ended at 3146 (350 poses, 4 fronts), within 3170",
                                   "another 0.25 m"});
}

TEST_F(Explain, TellsTheFateOfEveryObservationOfAStep) {
  expect_said({"--step", "1"}, {"Step 1 (0.5 s), searching", "(10, -2.5) m",
                                "Observation 0 updated landmark 3: NIS 1.5 with 2", "costs 4.25 nats more",
                                "Observation 1 began landmark 12", "Observation 2 was dropped from landmark 5 (NIS 8",
                                "joint test", "Observation 3 was dropped: landmark 6 is the nearest (NIS 30",
                                "Observation 4 was dropped: too far from every landmark", "A search began"});
  expect_said({"--step", "4"}, {"drive was not solved as a whole", "ended at 4000 (1 pose, 200 fronts)", "within 3170",
                                "stays as the closing left it"});
  expect_said({"--step", "0"}, {"Step 0 (0 s), mapping", "Nothing was observed.", "5 landmarks mapped earlier",
                                "0 were seen, and 2 new ones", "5.5 nats", "rolls back by 31 scans"});
}

TEST_F(Explain, RefusesWhatTheRunDoesNotHave) {
  expect_refused({path(), "--closure", "3"}, 3, "no closure 3; this run has 2");
  expect_refused({path(), "--step", "6"}, 3, "no step 6; this run has 0 to 5");
  expect_refused({folder_.path() / "none"}, 3, "not a run folder");
  expect_refused({path(), "--closure", "0"}, 2, "--closure");
  expect_refused({path(), "--step", "1", "--closure", "1"}, 2, "--step");
  expect_refused({}, 2, "DIR is required");
}

}  // namespace
}  // namespace helixnav::apps
