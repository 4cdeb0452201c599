// SPDX-License-Identifier: BSD-3-Clause
// Logs that no vehicle would write: extreme numbers, scans without a field of view, many objects in one place.
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/core/decision_row.hpp"
#include "helixnav/runs/run_folder.hpp"
#include "program.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;

const std::string step_line = "STEP s 0 -0.2 0 1e-4 0 1e-4 0 0 1e-5\n";

/// `scans` scans of `count` circles, `spacing_m` apart on lines of 100.
std::string circles(int scans, int count, double spacing_m) {
  std::ostringstream text;
  for (int scan = 0; scan < scans; ++scan) {
    text << step_line;
    for (int i = 0; i < count; ++i) {
      text << "LANDMARK_C " << 3.0 + spacing_m * (i % 100) << ' ' << 4.0 + spacing_m * static_cast<double>(i / 100)
           << " 1 0.01 0 0.01 -1\n";
    }
  }
  return text.str();
}

class HostileLog : public ::testing::Test {
 protected:
  void expect_refused(const std::string& name, const std::string& text, const std::string& words) const {
    const Outcome outcome = run({"replay", logs_.write(name, text), "--out", results_.path() / "run"});
    EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << "no '" << words << "' in: " << outcome.err;
  }

  void expect_replayed(const std::string& name, const std::string& text, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"replay", logs_.write(name, text), "--out", results_.path() / name};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  }

  testing::TemporaryFolder logs_;
  testing::TemporaryFolder results_;
};

TEST_F(HostileLog, StepsBeyondAllMeasureAreNamedByLine) {
  expect_refused("far.circles", step_line + "STEP s 0 1e308 0 1e-4 0 1e-4 0 0 1e-5\n",
                 "far.circles:2: expected dY [m]");
  expect_refused("far.circles", "STEP s 1e6 0 0 1e-4 0 1e-4 0 0 1e-5\n", "far.circles:1: expected dX [m]");
  expect_refused("far.isam", "ODOMETRY 0 1 1e6 0 0 100 0 0 100 0 100\n", "far.isam:1: expected dx [m]");
}

TEST_F(HostileLog, CovariancesBeyondAllMeasureAreNamedByLine) {
  for (const char* variance : {"1e-300", "1e-310", "1e300"}) {
    const std::string v = variance;
    expect_refused("c.circles", "STEP s 0 -0.2 0 " + v + " 0 " + v + " 0 0 1e-5\n", "c.circles:1: the covariance");
    expect_refused("c.circles", step_line + "LANDMARK_C 1 1 1 " + v + " 0 " + v + " 5\n",
                   "c.circles:2: the covariance");
  }
}

TEST_F(HostileLog, InformationAndDistancesBeyondAllMeasureAreNamedByLine) {
  const std::string vertices = "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nVERTEX_XY 2 1 1\n";
  const std::string good = "EDGE_SE2 0 1 1 0 0 100 0 0 100 0 100\n";
  expect_refused("i.g2o", vertices + "EDGE_SE2 0 1 1 0 0 1e308 0 0 1e308 0 1e308\n", "i.g2o:4: the inverse of the inf");
  expect_refused("i.g2o", vertices + good + "EDGE_SE2_XY 0 2 1e300 1 100 0 100\n", "i.g2o:5: expected x [m]");
  expect_refused("i.g2o", vertices + good + "EDGE_SE2_XY 0 2 1 1 1e308 0 1e308\n", "i.g2o:5: the inverse of the inf");
  expect_refused("i.g2o", "VERTEX_SE2 9223372036854775807 0 0 0\n", "i.g2o:1: expected a vertex number of at most 15");
  expect_refused("n.isam", "ODOMETRY 0 9223372036854775807 1 0 0 100 0 0 100 0 100\n", "n.isam:1: expected the number");
}

TEST_F(HostileLog, MoreObservationsThanAnySensorMakesAreNamedByLine) {
  expect_refused("crowd.circles", circles(1, 100'000, 0.0), "crowd.circles:50002: more than 50000 observations");
}

TEST_F(HostileLog, GraphsWhoseScansHaveNoViewAreDrivenWithDefaultOptions) {
  std::string graph = "VERTEX_SE2 0 0 0 0\nVERTEX_XY 100 3 2\nVERTEX_XY 101 4 -2\n";
  std::string edges;
  for (int k = 0; k < 10; ++k) {
    const std::string from = std::to_string(k);
    const std::string to = std::to_string(k + 1);
    graph += "VERTEX_SE2 " + to + " " + to + " 0 0\n";
    edges += "EDGE_SE2 " + from + " " + to + " 1 0 0 100 0 0 100 0 1000\n";
    for (int m = 0; m < 2; ++m) {
      edges += "EDGE_SE2_XY " + to + " " + std::to_string(100 + m) + " " + std::to_string(3 + m - k - 1) + " " +
               std::to_string(2 - 4 * m) + " 100 0 100\n";
    }
  }
  expect_replayed("small.g2o", graph + edges);
  expect_replayed("localised.g2o", graph + edges, {"--localize", "--map", results_.path() / "small.g2o"});
  const Outcome shown = run({"associate", logs_.path() / "small.g2o", "--scan", "5"});
  EXPECT_EQ(shown.exit_code, 0) << shown.err;
}

TEST_F(HostileLog, ObservationsAllInOnePlaceAreDriven) { expect_replayed("one.circles", circles(5, 50, 0.0)); }

/// 10 000 observations a scan; the figures for time and memory are in docs/fuzzing.md.
class CrowdedScan : public HostileLog, public ::testing::WithParamInterface<double> {};

TEST_P(CrowdedScan, IsThinnedAndTheReportSaysSo) {
  expect_replayed("crowd", circles(3, 10'000, GetParam()));
  const runs::Run run = runs::read_run((results_.path() / "crowd").string());
  ASSERT_EQ(run.steps.size(), 3u);
  for (const core::StepReport& step : run.steps) {
    EXPECT_EQ(step.associations.size(), 10'000u);
    EXPECT_LE(step.mapped_landmarks, 3 * 256);
    std::vector<std::string> decided;  // beside which noise is learnt, and nothing else
    for (const core::Decision& decision : step.decisions) {
      const core::DecisionRow row = core::row_of(decision);
      if (row.kind != "noise") decided.push_back(row.kind + ' ' + row.verdict);
    }
    EXPECT_EQ(decided, std::vector<std::string>{"scan thinned"});
  }
  EXPECT_LE(run.steps[2].mapped_landmarks, GetParam() < 0.01 ? 3 : 3 * 256);
}

INSTANTIATE_TEST_SUITE_P(Spacings, CrowdedScan, ::testing::Values(0.0, 1e-8, 1.0));

}  // namespace
}  // namespace helixnav::apps
