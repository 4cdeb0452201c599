// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "program.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;

/// A file that smooth must refuse, with the message it must give.
struct Bad {
  const char* claim;
  const char* file;
  std::string text;
  int exit_code;
  std::vector<std::string> words;
};

const std::string step = "STEP a 0 -1 0 1e-4 0 1e-4 0 0 1e-5\n";
const std::string circle = "LANDMARK_C 0 -2 1 1e-2 0 1e-2 7\n";
const std::string two_poses = "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n";

std::vector<Bad> bad_files() {
  return {
      {"UnknownKeyword",
       "log.circles",
       step + circle + "LANDMRK_C 0 -2 1 1e-2 0 1e-2 7\n",
       3,
       {"log.circles:3", "unknown keyword 'LANDMRK_C'", "LANDMARK_C"}},
      {"FieldTooFew", "log.circles", step + circle + "LANDMARK_C 0 -2 1 1e-2 0 7\n", 3, {"log.circles:3", "expected"}},
      {"FieldTooMany", "log.circles", "STEP a 0 -1 0 1e-4 0 1e-4 0 0 1e-5 9\n", 3, {"log.circles:1", "more columns"}},
      {"IdMissing", "log.circles", step + "LANDMARK_C 0 -2 1 1e-2 0 1e-2\n", 3, {"log.circles:2", "identifier"}},
      {"LineIdMissing", "log.lines", step + "LANDMARK_L 0 0 0 0 0.1 0 0.9 0.01\n", 3, {"log.lines:2", "identifier"}},
      {"CircleNotPositiveDefinite",
       "log.circles",
       step + "LANDMARK_C 0 -2 1 1e-2 1 1e-2 7\n",
       3,
       {"log.circles:2", "not positive definite"}},
      {"StepNotPositiveDefinite",
       "log.circles",
       "STEP a 0 -1 0 1e-4 0 -1e-4 0 0 1e-5\n",
       3,
       {"log.circles:1", "not positive definite"}},
      {"GraphUnknownTag", "graph.g2o", two_poses + "EDGE_SE3 1 42 2 1 1 0 1\n", 3, {"graph.g2o:4", "EDGE_SE3"}},
      {"GraphNotPositiveDefinite",
       "graph.g2o",
       two_poses + "EDGE_SE2 1 0 1 0 0 1 2 0 1 0 1\n",
       3,
       {"graph.g2o:4", "not positive definite"}},
      {"GraphVertexMissing",
       "graph.g2o",
       two_poses + "EDGE_SE2_XY 1 42 2 1 1 0 1\n",
       3,
       {"graph.g2o:4", "VERTEX_XY 42"}},
      {"GraphUnobserved", "graph.g2o", two_poses + "VERTEX_XY 42 3 1\n", 3, {"landmark 42 is not observed"}},
      {"GraphWithoutGauge",
       "graph.g2o",
       two_poses + "VERTEX_SE2 7 2 0 0\nVERTEX_SE2 8 2 0 0\nEDGE_SE2 7 8 1 0 0 1 0 0 1 0 1\n",
       3,
       {"no gauge", "pose 7"}},
      {"GraphSingular",
       "graph.g2o",
       two_poses + "VERTEX_XY 42 3 0\nEDGE_BEARING_SE2_XY 0 42 0 100\nEDGE_BEARING_SE2_XY 1 42 0 100\n",
       4,
       {"do not determine landmark 42"}},
      {"TextFieldTooFew",
       "graph.txt",
       "ODOMETRY 0 1 1 0 0 1 0 0 1 0 1\nLANDMARK 0 2 1 1 1 0\n",
       3,
       {"graph.txt:2", "expected"}},
      {"TextNotPositiveDefinite",
       "graph.txt",
       "ODOMETRY 0 1 1 0 0 1 0 0 1 0 0\nLANDMARK 0 2 1 1 1 0 1\n",
       3,
       {"graph.txt:1", "positive definite"}},
  };
}

class BadGraph : public ::testing::TestWithParam<Bad> {};

TEST_P(BadGraph, IsRefusedByItsOwnNameAndLeavesNothing) {
  const testing::TemporaryFolder folder;
  const fs::path out = folder.path() / "run";
  const Outcome outcome = run({"smooth", folder.write(GetParam().file, GetParam().text), "--out", out});
  EXPECT_EQ(outcome.exit_code, GetParam().exit_code) << outcome.err;
  for (const std::string& word : GetParam().words) {
    EXPECT_NE(outcome.err.find(word), std::string::npos) << "no '" << word << "' in: " << outcome.err;
  }
  EXPECT_EQ(outcome.out, "");
  EXPECT_FALSE(fs::exists(out)) << "half a run folder";
}

INSTANTIATE_TEST_SUITE_P(Smooth, BadGraph, ::testing::ValuesIn(bad_files()),
                         [](const auto& test) { return std::string(test.param.claim); });

}  // namespace
}  // namespace helixnav::apps
