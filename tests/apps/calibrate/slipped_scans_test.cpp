// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/slipped_scans.hpp"

#include <cstddef>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/core/odometry.hpp"

namespace helixnav::apps {
namespace {

TEST(SlippedScans, AreThoseOfWhichTheRunDecidedSo) {
  std::vector<core::StepReport> steps(10);
  steps[3].decisions = {core::SlipDecision{}};
  steps[4].decisions = {core::MovingDecision{}};
  steps[7].decisions = {core::SlipDecision{}};
  EXPECT_EQ(slipped_scans(steps), (std::vector<std::size_t>{3, 7}));
}

TEST(SlippedScans, OneAfterTheOtherAreOneSlip) {
  EXPECT_EQ(count_slips({}), 0U);
  EXPECT_EQ(count_slips({3, 4, 7}), 1U);
  EXPECT_EQ(count_slips({3, 4, 8}), 2U);
}

TEST(SlippedScans, LeaveOnlyTheOdometryBeforeThemLoose) {
  core::Recording recording;
  recording.events.emplace_back(core::Scan{});
  for (int k = 1; k <= 4; ++k) {
    for (int part = 0; part < 2; ++part) recording.events.emplace_back(core::no_motion(10 * k + part));
    recording.events.emplace_back(core::Scan{10 * k + 1, {}, {}, {}});
  }
  loosen_odometry({2, 4}, recording);
  for (const core::Event& event : recording.events) {
    const auto* odometry = std::get_if<core::Odometry>(&event);
    if (odometry == nullptr) continue;
    const bool is_loose = odometry->t_ns / 10 == 2 || odometry->t_ns / 10 == 4;
    EXPECT_EQ(odometry->covariance(0, 0) > 1000.0, is_loose) << odometry->t_ns;
  }
}

}  // namespace
}  // namespace helixnav::apps
