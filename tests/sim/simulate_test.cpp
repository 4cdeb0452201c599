// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/sim/simulate.hpp"

#include <gtest/gtest.h>

namespace helixnav::sim {
namespace {

TEST(Simulate, GivesOneTruePoseAndOneListOfLabelsForEachScan) {
  for (const std::string& name : scenario_names()) {
    SCOPED_TRACE(name);
    const core::Recording run = simulate(named_scenario(name), 1);
    std::size_t scans = 0;
    for (const core::Event& event : run.events) {
      const auto* scan = std::get_if<core::Scan>(&event);
      if (scan == nullptr) continue;
      ASSERT_LT(scans, run.labels.size());
      EXPECT_EQ(run.labels[scans].size(), scan->observations.size());
      EXPECT_EQ(run.true_poses[scans].t_ns, scan->t_ns);
      ++scans;
    }
    EXPECT_EQ(run.labels.size(), scans);
    EXPECT_EQ(run.true_poses.size(), scans);
    EXPECT_GT(scans, 100U);
  }
}

}  // namespace
}  // namespace helixnav::sim
