// SPDX-License-Identifier: BSD-3-Clause
// The two landmarks that carry the frame of an attempt may die while it lasts.
#include <gtest/gtest.h>

#include "circuits.hpp"

namespace helixnav::supervisor {
namespace {

/// Wheels that leave the heading open by tens of degrees per scan. "landmark 17 has been removed" ended the drive at scan 36.
TEST(BaseLost, EndsTheAttemptAndNotTheDrive) {
  sim::Scenario town = sim::named_scenario("town");
  town.world.tour_m = 1500.0;
  town.true_noise.odometry = town.assumed_noise.odometry = {0.1, 0.6};
  const core::Recording run = sim::simulate(town, 7);
  NavigatorOptions options;
  options.search.relocalizer.threads = 1;
  Navigator navigator(run.start, options);
  constexpr std::size_t scans = 60;
  int abandoned = 0;
  drive(run, navigator, [&](const core::Scan& scan, std::size_t k) {
    if (k >= scans) return;
    for (const core::Decision& decision : navigator.observe(scan).decisions) {
      const auto* ended = std::get_if<core::AttemptEnded>(&decision);
      abandoned += ended != nullptr && ended->reason == core::AttemptEnded::Reason::abandoned;
    }
  });
  EXPECT_GE(abandoned, 1) << "or it shows nothing";
}

}  // namespace
}  // namespace helixnav::supervisor
