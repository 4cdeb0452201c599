// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/sim/part_of.hpp"

#include <gtest/gtest.h>

#include "helixnav/sim/simulate.hpp"

namespace helixnav::sim {
namespace {

TEST(PartOf, BeginsWithAScanAndKeepsTruthBesideIt) {
  const core::Recording whole = simulate(named_scenario("circuit"), 1);
  const core::Nanoseconds from_ns = core::nanoseconds_from_seconds(10.0);
  const core::Nanoseconds until_ns = core::nanoseconds_from_seconds(20.0);
  const core::Recording part = part_of(whole, from_ns, until_ns);
  ASSERT_FALSE(part.events.empty());
  EXPECT_TRUE(std::holds_alternative<core::Scan>(part.events.front()));
  std::size_t scans = 0;
  for (const core::Event& event : part.events) {
    EXPECT_GE(core::time_of(event), from_ns);
    EXPECT_LE(core::time_of(event), until_ns);
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    EXPECT_EQ(part.true_poses.at(scans).t_ns, scan->t_ns);
    EXPECT_EQ(part.labels.at(scans).size(), scan->observations.size());
    ++scans;
  }
  EXPECT_EQ(part.labels.size(), scans);
  EXPECT_EQ(part.true_poses.size(), scans);
  EXPECT_EQ(part.true_landmarks.size(), whole.true_landmarks.size());
}

TEST(PartOf, TheWholeIsAPart) {
  const core::Recording whole = simulate(named_scenario("circuit"), 2);
  const core::Recording part = part_of(whole, 0, core::nanoseconds_from_seconds(1e6));
  EXPECT_EQ(part.events.size(), whole.events.size());
  EXPECT_EQ(part.labels, whole.labels);
}

}  // namespace
}  // namespace helixnav::sim
