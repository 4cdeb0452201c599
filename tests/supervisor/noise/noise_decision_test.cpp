// SPDX-License-Identifier: BSD-3-Clause
// That a drive says which noise it has learnt.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "circuits.hpp"
#include "helixnav/supervisor/navigator.hpp"

namespace helixnav::supervisor {
namespace {

std::vector<core::NoiseDecision> noise_learnt_in(const std::string& scenario) {
  const core::Recording run = sim::simulate(sim::named_scenario(scenario), 1);
  NavigatorOptions options;
  options.search.relocalizer.threads = 1;
  Navigator navigator(run.start, options);
  std::vector<core::NoiseDecision> learnt;
  drive(run, navigator, [&](const core::Scan& scan, std::size_t) {
    for (const core::Decision& decision : navigator.observe(scan).decisions) {
      if (const auto* noise = std::get_if<core::NoiseDecision>(&decision)) learnt.push_back(*noise);
    }
  });
  return learnt;
}

TEST(NoiseDecision, SaysThatHalfOfTheNoiseWasStated) {
  const std::vector<core::NoiseDecision> learnt = noise_learnt_in("assumed-noise-half");
  ASSERT_FALSE(learnt.empty());
  EXPECT_NEAR(learnt.back().detections, 2.0, 0.5);
  EXPECT_GT(learnt.back().odometry, 1.3);
  EXPECT_EQ(learnt.back().fixes, 1.0) << "there are none";
  EXPECT_EQ(learnt.back().solved_again, 1);
}

TEST(NoiseDecision, IsNotMadeWhereTheNoiseIsAsStated) { EXPECT_TRUE(noise_learnt_in("two-laps").empty()); }

}  // namespace
}  // namespace helixnav::supervisor
